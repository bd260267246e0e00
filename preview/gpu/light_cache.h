// The light cache on the GPU: columns of density towards each light and what the sky scatters, on a coarse
// lattice. Depends on shaders/shared, gpu/brick_atlas.h and gpu/shader.h.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "preview/gpu/brick_atlas.h"
#include "preview/gpu/shader.h"
#include "shaders/shared/leaves.h"

namespace nephele {

/// What `march: { check_skips: true }` counted.
struct SkipCheck {
  double checked = 0.0;  // densities read in what was skipped, and held against the bounds of their bricks
  double wrong = 0.0;    // of those, above 0, or above the bound
};
/// Reads and clears two counts that lie `offset` bytes into a buffer.
SkipCheck takeSkipCheck(const GlBuffer& counts, GLintptr offset);

/// Textures that hold the samples of shaders/shared/light_cache_fill.glsl and say where each block lies.
/// Columns are kept as 1/(1 + κ column), κ being MarchParameters::cache.y; the sky's samples depend on the
/// medium and its phase function as well. What rests keeps columns in halves. Where pictures at rest are
/// marched and moving ones alone ask for columns, they are kept in bytes.
class LightCache {
 public:
  /// Read by the exact filter its texels are floats.
  explicit LightCache(Filter filter, const std::vector<TextChange>& changes = {});

  /// Makes it right for an atlas and parameters, which are bound to uniform block 0, by filling what differs
  /// from the last time: each light's columns when the light or the volume changes, the sky when the medium
  /// does as well. Fills for about `seconds` (at least one piece) and returns whether all is right; what is
  /// not yet keeps what it held.
  bool update(const BrickAtlas& atlas, const shared::MarchParameters& parameters, double seconds);

  /// As update, but for one block alone: so that the driver has compiled what fills it.
  void begin(const BrickAtlas& atlas, const shared::MarchParameters& parameters);

  /// What a block takes under these parameters.
  static uint64_t blockBytes(Filter filter, const shared::MarchParameters& parameters);
  /// Binds to texture units 2, 3 and 5.
  void bind() const;
  uint64_t gpuBytes() const { return gpuBytes_; }
  /// Densities read for what was filled since the last call.
  double takeDensitiesRead();
  /// Likewise of those that were read to check what was skipped.
  SkipCheck takeSkipCheck();

 private:
  struct Task {
    int light;          // −1: the sky
    uint32_t left = 0;  // blocks yet to fill; it goes round, so that what changes all the time is all reached
    uint32_t nextBlock = 0;
  };

  void shape(const BrickAtlas& atlas, const shared::MarchParameters& parameters);
  /// Finds what differs from the last time; true where all it held is forgotten.
  bool plan(const BrickAtlas& atlas, const shared::MarchParameters& parameters);
  void findTasks(const shared::MarchParameters& parameters);
  void fill(const BrickAtlas& atlas, Task& task, uint32_t blocks);
  /// The first of what these parameters ask for. What a moving picture left waits while resting ones do not
  /// ask for it: these know no κ to fill columns by.
  std::vector<Task>::iterator nextTask(const shared::MarchParameters& parameters);

  const GlProgram& programFor(const shared::MarchParameters& parameters);

  bool floats_;
  std::vector<TextChange> changes_;
  std::map<std::vector<std::string>, GlProgram>
      programs_;  // by what each leaves out; built when first needed
  GlTexture blockIndex_, columns_, sky_;
  GlBuffer blocks_, cost_;
  uint32_t blockTotal_ = 0;
  float columnKind_ = 0.0f;  // as MarchParameters::cache.x; 0: columns_ is bound and never read
  bool bare_ = false;        // it holds nothing yet that could be shown
  uint64_t gpuBytes_ = 0;
  uint64_t atlasSerial_ = 0, atlasContents_ = 0;
  std::optional<shared::MarchParameters> known_;  // of the last picture; its shape is what is held
  std::optional<shared::MarchParameters> columnsOf_, skyOf_;  // what each is filled for, or will be
  std::vector<Task> tasks_;
  double blocksPerSecond_ = 0.0;
};

}  // namespace nephele
