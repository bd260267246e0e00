// Uploading bricks and their index. Depends on volume's brick headers and gpu/gl.h.
#include "preview/gpu/brick_atlas.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <string>
#include <vector>

namespace nephele {
namespace {

constexpr int kWordChannels = 2;
constexpr GLuint kHeatUnit = 10;  // and the next, as shaders/heat.glsl declares them

struct Format {
  GLenum sized, type;
};

Format formatOf(Texel texel) {
  switch (texel) {
    case Texel::r8:
      return {GL_R8, GL_UNSIGNED_BYTE};
    case Texel::r16f:
      return {GL_R16F, GL_HALF_FLOAT};
    case Texel::r32f:
      break;
  }
  return {GL_R32F, GL_FLOAT};
}

std::span<const uint32_t> wordsOf(const std::vector<glm::uvec2>& words) {
  static_assert(sizeof(glm::uvec2) == kWordChannels * sizeof(uint32_t));
  return {words.empty() ? nullptr : &words[0].x, words.size() * kWordChannels};
}

uint64_t nextSerial() {
  static std::atomic<uint64_t> last{0};
  return ++last;
}

}  // namespace

int volumeTextureLimit() {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limit);
  return limit;
}

void setVolumeFilter(GLuint texture, Filter filter) {
  const GLint mode = filter == Filter::hardware ? GL_LINEAR : GL_NEAREST;
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, mode);
  glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, mode);
  for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(texture, axis, GL_CLAMP_TO_EDGE);
}

GlTexture makeIndexTexture(std::span<const uint32_t> words, int channels, uint64_t& gpuBytes) {
  const size_t perTexel = static_cast<size_t>(channels), texels = words.size() / perTexel;
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  const size_t most = std::bit_floor(static_cast<size_t>(limit));
  // Near a square, so that neither side meets the limit before it must.
  size_t width = 1;
  while (width < most && width * width < texels) width *= 2;
  const size_t height = std::max<size_t>(1, (texels + width - 1) / width);
  if (height > static_cast<size_t>(limit))
    throw InputError(
        {}, "an index of " + std::to_string(texels) + " bricks is more than the driver's textures hold");
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, channels == 1 ? GL_R32UI : GL_RG32UI, static_cast<GLsizei>(width),
                     static_cast<GLsizei>(height));
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  const size_t whole = texels / width, rest = texels % width;
  const auto upload = [&](size_t y, size_t w, size_t h) {
    if (w * h > 0)
      glTextureSubImage2D(texture.name(), 0, 0, static_cast<GLint>(y), static_cast<GLsizei>(w),
                          static_cast<GLsizei>(h), channels == 1 ? GL_RED_INTEGER : GL_RG_INTEGER,
                          GL_UNSIGNED_INT, words.data() + y * width * perTexel);
  };
  upload(0, width, whole);
  upload(whole, rest, 1);
  checkGl("uploading the index of bricks");
  gpuBytes += sizeof(uint32_t) * perTexel * width * height;
  return texture;
}

std::shared_ptr<const BrickAtlas> atlasOfTemperatures(const BrickVolume& bricks, Filter filter) {
  if (!bricks.temperature) return nullptr;
  return std::make_shared<const BrickAtlas>(*bricks.temperature, filter, Texel::r32f);
}

BrickAtlas::BrickAtlas(const BrickVolume& bricks, Filter filter, Texel texel)
    : BrickAtlas(layOut(bricks, {texel, volumeTextureLimit(), {}, 0, 0}), atlasOfTemperatures(bricks, filter),
                 filter) {}

BrickAtlas::BrickAtlas(BrickLayout layout, std::shared_ptr<const BrickAtlas> heat, Filter filter)
    : filter_(filter),
      layout_(std::move(layout)),
      atlas_(makeTexture(GL_TEXTURE_3D)),
      heat_(std::move(heat)),
      serial_(nextSerial()) {
  setVolumeFilter(atlas_.name(), filter);
  uploadAtlas();
  index_ = makeIndexTexture(wordsOf(layout_.words), kWordChannels, gpuBytes_);
  if (heat_) gpuBytes_ += heat_->gpuBytes();
}

void BrickAtlas::uploadAtlas() {
  const glm::ivec3 size = layout_.size;
  const Format format = formatOf(layout_.texel);
  glTextureStorage3D(atlas_.name(), 1, format.sized, size.x, size.y, size.z);
  checkGl("making an atlas of " + std::to_string(layout_.slots.size()) + " bricks");
  gpuBytes_ += bytesOf(layout_.texel) * static_cast<uint64_t>(size.x) * static_cast<uint64_t>(size.y) *
               static_cast<uint64_t>(size.z);
  // One slab of bricks at a time: few calls, and little memory beside the texture.
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  std::vector<std::byte> texels;
  for (const AtlasSlab& slab : layout_.slabs) {
    writeSlab(layout_, slab, texels);
    glTextureSubImage3D(atlas_.name(), 0, 0, 0, slab.z, size.x, size.y, slab.thickness, GL_RED, format.type,
                        texels.data());
  }
  constexpr GLint kUsualAlignment = 4;
  glPixelStorei(GL_UNPACK_ALIGNMENT, kUsualAlignment);
  checkGl("uploading " + std::to_string(layout_.slots.size()) + " bricks");
}

void BrickAtlas::bind() const {
  glBindTextureUnit(0, atlas_.name());
  glBindTextureUnit(1, index_.name());
  if (!heat_) return;
  glBindTextureUnit(kHeatUnit, heat_->atlas_.name());
  glBindTextureUnit(kHeatUnit + 1, heat_->index_.name());
}

void BrickAtlas::bindStored() const {
  constexpr GLuint kStoredUnit = 12;
  if (stored_.name() == 0) stored_ = makeIndexTexture(wordsOf(layout_.stored), kWordChannels, storedBytes_);
  glBindTextureUnit(kStoredUnit, stored_.name());
}

}  // namespace nephele
