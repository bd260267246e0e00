// A recipe, read: YAML → plain structs, every value checked against the field table and knowing
// file:line:column. Depends on fields, particles, scene, base; no OpenVDB.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/fields/table.h"
#include "base/error.h"
#include "particles/particles.h"
#include "scene/scene.h"

namespace nephele {

/// One field of a recipe with every parameter settled. Shared where the recipe names or aliases it.
struct FieldSpec {
  const FieldRow* row = nullptr;
  SourceLocation where;
  std::map<std::string, Value, std::less<>> values;  // all but child fields
  std::map<std::string, std::vector<std::shared_ptr<const FieldSpec>>, std::less<>>
      children;       // field and fields
  int height = 1;     // fields above each other, this one included
  double uses = 1.0;  // fields evaluated for one value: each use of one counts
  std::map<std::string, SourceLocation, std::less<>> places;  // of the parameters that the recipe gives
};
using FieldSpecPtr = std::shared_ptr<const FieldSpec>;

enum class Precision { half, single };

/// Frames A to B, both ends included.
struct FrameRange {
  int first = 0;
  int last = 0;
};

struct Asset {
  std::string name;
  SourceLocation where;
  double voxelSize = 0.0;  // world units; 0 where a tolerance stands in its place
  std::optional<double> tolerance;
  bool precisionGiven = false;
  int mostOctaves = kAllOctaves;  // of a fractal sum
  Precision precision = Precision::half;
  double densityStep = 0.0;  // stored densities are multiples of this power of two; 0: as precise as can be
  bool densityStepGiven = false;
  double cutoff = 0.001;  // voxels at or below are inactive and 0
  std::optional<FrameRange> frames;
  double fps = 24.0;
  std::optional<int64_t> loopFrames;  // frames after which all motion comes round
  FieldSpecPtr density;               // null where particles make it
  std::optional<ParticleSystem> particles;
  std::vector<InputFile> particleFiles;      // of each emitter; empty where it names none
  FieldSpecPtr erosion;                      // of the particles; null for none
  bool velocityFromMotion = false;           // `velocity: true`
  std::vector<FieldSpecPtr> velocityFields;  // or three fields, x, y and z; else empty
};

struct Pipeline {
  std::string path;
  char upAxis = 'z';
  int64_t seed = 0;
  std::optional<Scene> scene;
  std::vector<Asset> assets;  // in file order
};

/// Reads a recipe. Throws InputError with all of its errors.
Pipeline loadPipeline(const std::string& path);

/// Reads a recipe that is a text already; `name` stands for its file in sentences.
Pipeline readPipeline(const std::string& text, const std::string& name);

/// Frames have at most six digits.
inline constexpr int kLastFrame = 999999;

/// A, B or A-B with A ≤ B, each from 0 to kLastFrame. nullopt where the text is something else.
std::optional<FrameRange> parseFrames(const std::string& text);

/// Builds the asset's density. Fields that the recipe shares are built once. `context` gives what a bake
/// decides.
FieldPtr buildField(const FieldSpec& spec, const BuildContext& context);

/// What the asset's fields are built with at a frame; without one at time 0.
BuildContext contextOf(const Pipeline& pipeline, const Asset& asset, std::optional<int> frame = {});

/// What the asset's loop makes of its motion's parameters; empty without a loop.
std::vector<LoopNote> loopNotesOf(const Asset& asset);

/// 32 hex digits of everything that the asset's content depends on: its fields with all parameters, voxel
/// size, contents of the files they name, cutoff, precision, density step, up axis, seed, medium, time (in a
/// loop the frame's place in it), and the program's version and sources (pipeline_identity.h). Equal recipes
/// written differently give equal hashes.
std::string recipeHash(const Pipeline& pipeline, const Asset& asset, std::optional<int> frame = {});

/// The same of all that the motion of an asset's particles depends on, and nothing else: its checkpoints go
/// by this.
std::string simulationHash(const Pipeline& pipeline, const Asset& asset);

}  // namespace nephele
