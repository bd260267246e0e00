// A lat-long environment on the GPU: its texels and its table of directions. Depends on
// scene/environment_map.h and gpu/gl.h.
#pragma once

#include <memory>

#include "preview/gpu/gl.h"
#include "scene/environment_map.h"

namespace nephele {

/// Two textures as shaders/sky.glsl reads them: RGB32F texels and RGBA32F cells. Without a map, none.
class SkyTextures {
 public:
  /// Uploads a map that is not the one before; nullptr frees both. Throws InputError where the driver's
  /// textures are smaller, WorldError where memory is short.
  void set(const std::shared_ptr<const EnvironmentMap>& map);

  /// Binds to texture units 8 and 9; nothing without a map.
  void bind() const;
  uint64_t gpuBytes() const { return gpuBytes_; }

 private:
  std::shared_ptr<const EnvironmentMap> map_;
  GlTexture texels_, cells_;
  uint64_t gpuBytes_ = 0;
};

}  // namespace nephele
