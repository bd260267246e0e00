// Uploading bricks and their index. Depends on volume's brick headers and gpu/gl.h.
#include "preview/gpu/brick_atlas.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <string>
#include <vector>

namespace nephele {
namespace {

constexpr GLuint kHeatUnit = 10;  // and the next, as shaders/heat.glsl declares them

int volumeLimit() {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limit);
  return limit;
}

uint64_t nextSerial() {
  static std::atomic<uint64_t> last{0};
  return ++last;
}

}  // namespace

void setVolumeFilter(GLuint texture, Filter filter) {
  const GLint mode = filter == Filter::hardware ? GL_LINEAR : GL_NEAREST;
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, mode);
  glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, mode);
  for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(texture, axis, GL_CLAMP_TO_EDGE);
}

GlTexture makeIndexTexture(std::span<const uint32_t> words, uint64_t& gpuBytes) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  const size_t most = std::bit_floor(static_cast<size_t>(limit));
  // Near a square, so that neither side meets the limit before it must.
  size_t width = 1;
  while (width < most && width * width < words.size()) width *= 2;
  const size_t height = std::max<size_t>(1, (words.size() + width - 1) / width);
  if (height > static_cast<size_t>(limit))
    throw InputError({}, "an index of " + std::to_string(words.size()) +
                             " bricks is more than the driver's textures hold");
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, GL_R32UI, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  const size_t whole = words.size() / width, rest = words.size() % width;
  const auto upload = [&](size_t y, size_t w, size_t h) {
    if (w * h > 0)
      glTextureSubImage2D(texture.name(), 0, 0, static_cast<GLint>(y), static_cast<GLsizei>(w),
                          static_cast<GLsizei>(h), GL_RED_INTEGER, GL_UNSIGNED_INT, words.data() + y * width);
  };
  upload(0, width, whole);
  upload(whole, rest, 1);
  checkGl("uploading the index of bricks");
  gpuBytes += sizeof(uint32_t) * width * height;
  return texture;
}

BrickAtlas::BrickAtlas(const BrickVolume& bricks, Filter filter)
    : filter_(filter),
      layout_(layOut(bricks, volumeLimit())),
      atlas_(makeTexture(GL_TEXTURE_3D)),
      serial_(nextSerial()) {
  setVolumeFilter(atlas_.name(), filter);
  uploadAtlas();
  index_ = makeIndexTexture(layout_.words, gpuBytes_);
  if (bricks.temperature) {
    heat_ = std::make_unique<BrickAtlas>(*bricks.temperature, filter);
    gpuBytes_ += heat_->gpuBytes();
  }
}

void BrickAtlas::uploadAtlas() {
  const glm::ivec3 places = layout_.places, size = places * kBrickSamples;
  glTextureStorage3D(atlas_.name(), 1, GL_R32F, size.x, size.y, size.z);
  checkGl("making an atlas of " + std::to_string(layout_.bricks.size()) + " bricks");
  gpuBytes_ += sizeof(float) * static_cast<uint64_t>(size.x) * static_cast<uint64_t>(size.y) *
               static_cast<uint64_t>(size.z);
  // One row of bricks at a time: few calls, and little memory beside the texture.
  const size_t rowTexels = static_cast<size_t>(size.x);
  std::vector<float> row(rowTexels * kBrickSamples * kBrickSamples);
  const size_t perRow = static_cast<size_t>(places.x);
  for (size_t first = 0; first < layout_.bricks.size(); first += perRow) {
    const size_t last = std::min(first + perRow, layout_.bricks.size());
    for (size_t place = first; place < last; ++place) {
      const float* from = layout_.bricks[place];
      float* to = row.data() + (place - first) * kBrickSamples;
      for (int line = 0; line < kBrickSamples * kBrickSamples; ++line)
        std::copy_n(from + line * kBrickSamples, kBrickSamples, to + static_cast<size_t>(line) * rowTexels);
    }
    const int number = static_cast<int>(first / perRow);
    glTextureSubImage3D(atlas_.name(), 0, 0, number % places.y * kBrickSamples,
                        number / places.y * kBrickSamples, size.x, kBrickSamples, kBrickSamples, GL_RED,
                        GL_FLOAT, row.data());
  }
  checkGl("uploading " + std::to_string(layout_.bricks.size()) + " bricks");
}

void BrickAtlas::bind() const {
  glBindTextureUnit(0, atlas_.name());
  glBindTextureUnit(1, index_.name());
  if (!heat_) return;
  glBindTextureUnit(kHeatUnit, heat_->atlas_.name());
  glBindTextureUnit(kHeatUnit + 1, heat_->index_.name());
}

}  // namespace nephele
