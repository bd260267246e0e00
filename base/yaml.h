// YAML with places: every key and value knows file:line:column, duplicate keys are errors, and a map is read
// through a reader that refuses what it was not asked for. yaml-cpp parses; no other header shows it.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/range.h"

namespace nephele::yaml {

class Node;
/// Aliases share the node of their anchor, so a parsed document is never larger than its text. Compare
/// pointers to recognise what was seen before: walking all paths of a hostile document is exponential.
using NodePtr = std::shared_ptr<const Node>;

enum class Kind { null, scalar, sequence, map };

struct Entry {
  std::string key;
  SourceLocation where;  // of the key
  NodePtr value;
};

class Node {
 public:
  Kind kind = Kind::null;
  SourceLocation where;
  std::string scalar;          // kind == scalar
  bool quoted = false;         // a quoted scalar is text even where it looks like a number
  std::vector<NodePtr> items;  // kind == sequence
  std::vector<Entry> entries;  // kind == map, in file order, keys unique
};

/// "a number", "text", "a list", "a map" or "nothing": for sentences.
std::string describe(const Node& node);

/// Parses one document. `fileName` appears in messages as given. Throws InputError on a syntax error, on
/// duplicate keys (all of them), on a second document, on nesting deeper than 200 and on text above 64 MiB.
NodePtr parse(std::string_view text, const std::string& fileName);

/// Reads and parses a file. A file that is missing or cannot be read is an InputError that names it.
NodePtr load(const std::string& path);

/// "greater than 0", "0 to 1", "at least 0": for sentences and docs; empty for any number.
std::string describe(const Range& range);
bool contains(const Range& range, double value);

/// Typed readings of one node. Each adds a complaint and returns nullopt where the node is of another type,
/// is not finite, or lies outside the range; `what` names the value in sentences ("'fov' (degrees)").
std::optional<double> readNumber(const Node& node, const std::string& what, const Range& range,
                                 Diagnostics& out);
std::optional<long long> readInteger(const Node& node, const std::string& what, const Range& range,
                                     Diagnostics& out);
std::optional<bool> readBoolean(const Node& node, const std::string& what, Diagnostics& out);
std::optional<std::string> readText(const Node& node, const std::string& what, Diagnostics& out);
std::optional<std::vector<double>> readNumbers(const Node& node, const std::string& what, size_t count,
                                               const Range& range, Diagnostics& out);

/// Reads the keys of one map. Ask for every legal key, then call finish(): it refuses the rest, with "did you
/// mean". A null node is an empty map. Not thread-safe; keeps references to its arguments.
class MapReader {
 public:
  /// `what` names the map in sentences: "the scene", "'sphere'".
  MapReader(const Node& node, std::string what, Diagnostics& out);

  bool has(std::string_view key) const;
  /// The value's node, or nullptr where the key is not given. Marks the key as known, as all readings do.
  NodePtr find(std::string_view key);
  /// Place of the key where it is given, of the map otherwise.
  SourceLocation where(std::string_view key) const;

  double number(std::string_view key, double fallback, const Range& range = kAny);
  long long integer(std::string_view key, long long fallback, const Range& range = kAny);
  bool boolean(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::string fallback);
  /// One of `choices`; anything else is refused with the list.
  std::string choice(std::string_view key, std::string fallback, const std::vector<std::string>& choices);
  std::array<double, 3> vector3(std::string_view key, std::array<double, 3> fallback,
                                const Range& range = kAny);
  /// Three numbers, or one number that stands for all three.
  std::array<double, 3> numberOrRgb(std::string_view key, std::array<double, 3> fallback,
                                    const Range& range = kAny);

  /// Refuses keys that nobody asked for. Call once, last.
  void finish();

 private:
  const Node& node_;
  std::string what_;
  Diagnostics& out_;
  std::vector<std::string> known_;
  bool isMap_;
  const Entry* lookUp(std::string_view key) const;
};

}  // namespace nephele::yaml
