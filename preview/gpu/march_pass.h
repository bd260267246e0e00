// The march as a pass over a screen-filling triangle: one sample of each pixel of a rectangle, added to a
// film. Depends on shaders/shared, gpu/brick_atlas.h, gpu/film.h and gpu/shader.h.
#pragma once

#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "preview/gpu/brick_atlas.h"
#include "preview/gpu/film.h"
#include "preview/gpu/light_cache.h"
#include "preview/gpu/shader.h"
#include "preview/gpu/sky_textures.h"
#include "shaders/shared/leaves.h"

namespace nephele {

/// Half-open rectangle of pixels, rows counted from the top.
struct PixelRectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

/// What a pass writes: the lit picture, or one of the looks inside of shaders/view.glsl.
enum class MarchWrites { radiance, slice, skipped };

/// How a pass finds radiance: the methods of MODEL.md that share the march's light.
enum class MarchKind { march, cube, dda };

/// The compiled march with its parameters and, where they ask for it, its light cache.
class MarchPass {
 public:
  /// For one filter; `changes` are for tests. Programs are built when first drawn with.
  explicit MarchPass(Filter filter, const std::vector<TextChange>& changes = {},
                     MarchWrites writes = MarchWrites::radiance, MarchKind kind = MarchKind::march);

  /// For MarchWrites::slice: the plane across `axis` (0, 1, 2) at `place` voxels from the brick grid's
  /// corner.
  void setSlice(int axis, float place);

  void setParameters(const shared::MarchParameters& parameters);
  /// The lat-long picture that the parameters speak of; nullptr where they speak of none. Uploads only what
  /// is new.
  void setEnvironment(const std::shared_ptr<const EnvironmentMap>& map) { sky_.set(map); }
  void bindEnvironment() const { sky_.bind(); }
  /// Fills what the light cache lacks for these parameters and this volume, for about `seconds`; returns
  /// whether it lacks nothing more. Until then draws take what the cache held before.
  bool prepare(const BrickAtlas& atlas, double seconds);
  /// Builds all programs that draws with these parameters need, those that the driver leaves until they run
  /// among them; returns the seconds that took. Draws do it themselves where this was not called. Throws
  /// WorldError where the driver refuses.
  double compile(const BrickAtlas& atlas);
  /// Which of the light caches is meant from now on: pictures under two settings, drawn by turns, need one
  /// each.
  void useCache(size_t which);
  /// Adds one sample of each pixel in `where` to the film, seen through picture position (x, y) + subPixel;
  /// `number` is the sample's number. Prepares wholly where prepare was not called for this volume. Does not
  /// wait for the GPU.
  void draw(const BrickAtlas& atlas, const Film& film, glm::vec2 subPixel, unsigned number,
            const PixelRectangle& where);

  Filter filter() const { return filter_; }
  uint64_t gpuBytes() const;
  /// Densities read to fill the light cache since the last call.
  double takeCacheDensities();
  /// What was counted of skips since the last call, where the parameters ask for it; waits for the GPU.
  SkipCheck takeSkipCheck();

 private:
  const GlProgram& program(int method);
  /// Parameters to the GPU, and the light cache where they ask for one.
  LightCache* uploadParameters(const BrickAtlas& atlas);

  Filter filter_;
  MarchWrites writes_;
  MarchKind kind_;
  glm::vec2 slice_{0.0f};
  std::vector<TextChange> changes_;
  std::map<std::vector<std::string>, GlProgram>
      programs_;  // by what each leaves out; built when first needed
  GlBuffer buffer_;
  GlBuffer skips_;
  GlTexture jitter_;
  SkyTextures sky_;
  GlVertexArray noVertices_;
  shared::MarchParameters parameters_{};
  static constexpr size_t kCaches = 2;
  std::optional<LightCache> caches_[kCaches];
  size_t which_ = 0;          // of them
  uint64_t preparedFor_ = 0;  // the atlas's serial
};

}  // namespace nephele
