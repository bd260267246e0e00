// Uploading lat-long environments. Depends on what its header names.
#include "preview/gpu/sky_textures.h"

#include <algorithm>
#include <string>

#include "base/error.h"

namespace nephele {
namespace {

constexpr GLuint kTexelUnit = 8, kCellUnit = 9;  // as shaders/sky.glsl declares them

GlTexture fetchTexture(GLenum format, int width, int height) {
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, format, width, height);
  for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(texture.name(), filter, GL_NEAREST);
  return texture;
}

}  // namespace

void SkyTextures::set(const std::shared_ptr<const EnvironmentMap>& map) {
  if (map == map_) return;
  map_ = nullptr;
  texels_ = GlTexture();
  cells_ = GlTexture();
  gpuBytes_ = 0;
  if (!map) return;
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (std::max(map->width, map->height) > limit)
    throw InputError({map->path}, "the environment is " + std::to_string(map->width) + "x" +
                                      std::to_string(map->height) + ", and the driver's textures end at " +
                                      std::to_string(limit) + " a side");
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  texels_ = fetchTexture(GL_RGB32F, map->width, map->height);
  glTextureSubImage2D(texels_.name(), 0, 0, 0, map->width, map->height, GL_RGB, GL_FLOAT, map->texels.data());
  cells_ = fetchTexture(GL_RGBA32F, kEnvironmentCellsAround, kEnvironmentCellsUp);
  glTextureSubImage2D(cells_.name(), 0, 0, 0, kEnvironmentCellsAround, kEnvironmentCellsUp, GL_RGBA, GL_FLOAT,
                      map->cells.data());
  checkGl("uploading the environment '" + map->path + "'");
  gpuBytes_ = sizeof(glm::vec3) * map->texels.size() + sizeof(glm::vec4) * map->cells.size();
  map_ = map;
}

void SkyTextures::bind() const {
  if (!map_) return;
  glBindTextureUnit(kTexelUnit, texels_.name());
  glBindTextureUnit(kCellUnit, cells_.name());
}

}  // namespace nephele
