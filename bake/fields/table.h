// The one table of fields: name, sentence, parameters with type, default, range and unit, and how to build
// it. It drives parsing, defaults, errors, `nodes`, docs, property tests and benchmarks. A new field is one
// row and one file. Depends on base alone.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bake/fields/field.h"
#include "base/error.h"
#include "base/range.h"

namespace nephele {

enum class ParameterType { number, integer, choice, pair, vector, curve, file, field, fields };

/// A piecewise linear function: points (x, y) with x growing, constant beyond its ends.
using Curve = std::vector<std::array<double, 2>>;

/// A file that a recipe names: where it lies, and a hash of what it holds. The hash stands for the file in
/// the recipe's own.
struct InputFile {
  std::string path;
  std::string contentHash;
};

/// What a parameter may hold once read. Which one follows from its type: number double, integer int64, choice
/// string, pair array of 2, vector array of 3, curve Curve, file InputFile, field FieldPtr, fields vector of
/// FieldPtr.
using Value = std::variant<double, int64_t, std::string, std::array<double, 2>, std::array<double, 3>, Curve,
                           InputFile, FieldPtr, std::vector<FieldPtr>>;

struct Parameter {
  std::string_view name;
  ParameterType type;
  std::string_view sentence;
  std::optional<Value> fallback;       // none: the recipe must give it
  Range range{};                       // of each number in it
  std::string_view unit{};             // empty: none
  std::vector<std::string> choices{};  // type == choice
};

/// Something that the grid cannot hold: an octave or a whole noise that was left out or weakened for it, a
/// warp that makes its input finer, a shape that is thin.
struct BandLimitNote {
  std::string field;
  int octave = 0;           // from 0
  double cellVoxels = 0.0;  // voxels per noise cell
  double weight = 0.0;      // 0: left out
  double squeeze = 0.0;     // above 0: a warp, and how many times finer (rms) it makes what it displaces
  double thickness = 0.0;   // above 0: a shape, and how many voxels it is thick
};

/// More octaves than any field has.
inline constexpr int kAllOctaves = 1 << 20;

/// A motion that comes round after `frames` frames, and how far it is.
struct Loop {
  int64_t frames = 1;  // at least 1
  int64_t frame = 0;
  double fps = 24.0;
};

/// What a loop makes of a parameter that did not fit it.
struct LoopNote {
  std::string field, parameter;
  std::string asked, used;
};

struct Motion;

/// What a field may know of the bake it is built for. Nothing else: a field is a pure function of recipe,
/// inputs and version.
struct BuildContext {
  double voxelSize = 1.0;  // world units; cells finer than two voxels are left out
  int upAxis = 2;          // 1: y, 2: z
  uint32_t seed = 0;       // the recipe's; mixed with each field's own
  std::vector<BandLimitNote>* notes = nullptr;
  double time = 0.0;              // seconds since frame 0
  std::optional<Loop> loop{};     // then motion follows this in place of the time
  int mostOctaves = kAllOctaves;  // of a fractal sum; the rest is left out as if the grid could not hold it
};

/// Parameters by name, all in range; all present, but for `some` where a recipe's errors are being collected.
class Arguments {
 public:
  enum class Given { all, some };
  /// Thrown where only some are given, and one is asked for that is not. Of all it is our fault.
  struct Missing {};

  explicit Arguments(std::map<std::string, Value, std::less<>> values, Given given = Given::all)
      : values_(std::move(values)), given_(given) {}
  double number(std::string_view name) const { return std::get<double>(at(name)); }
  int64_t integer(std::string_view name) const { return std::get<int64_t>(at(name)); }
  const std::string& choice(std::string_view name) const { return std::get<std::string>(at(name)); }
  const std::array<double, 2>& pair(std::string_view name) const {
    return std::get<std::array<double, 2>>(at(name));
  }
  glm::dvec3 vector(std::string_view name) const;
  const Curve& curve(std::string_view name) const { return std::get<Curve>(at(name)); }
  const std::string& file(std::string_view name) const { return std::get<InputFile>(at(name)).path; }
  const FieldPtr& field(std::string_view name) const { return std::get<FieldPtr>(at(name)); }
  const std::vector<FieldPtr>& fields(std::string_view name) const {
    return std::get<std::vector<FieldPtr>>(at(name));
  }

 private:
  const Value& at(std::string_view name) const;
  std::map<std::string, Value, std::less<>> values_;
  Given given_;
};

/// The parameter at fault and a sentence, or nothing where all is well.
using Complaint = std::optional<std::pair<std::string_view, std::string>>;

struct FieldRow {
  std::string_view name;
  std::string_view sentence;
  std::vector<Parameter> parameters;
  FieldPtr (*build)(const Arguments&, const BuildContext&);
  /// A complaint about values that are each in range but do not go together: the parameter at fault and a
  /// sentence. nullopt, or a null function, where all is well. Child fields are not looked at. Throws
  /// InputError on what is wrong inside a file.
  Complaint (*validate)(const Arguments&) = nullptr;
  /// How the row's own noise moves (motion.h); a null function where it has none.
  Motion (*motion)(const Arguments&) = nullptr;
  /// What the row's child fields are built with, where it is not what the row is built with. Child fields are
  /// not among the arguments yet.
  BuildContext (*inner)(const Arguments&, const BuildContext&) = nullptr;
};

/// All rows, in the order of the docs. A field whose last-named list is all that a recipe gives may be
/// written as a list.
std::span<const FieldRow> fieldTable();

/// The row of that name, or nullptr.
const FieldRow* findField(std::string_view name);

/// The parameter that a bare list stands for: the only one of type fields; nullptr where there is none.
const Parameter* listParameter(const FieldRow& row);

}  // namespace nephele
