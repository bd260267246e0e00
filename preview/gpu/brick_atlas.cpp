// Laying bricks out in an atlas and uploading them. Depends on volume/bricks.h and gpu/gl.h.
#include "preview/gpu/brick_atlas.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace nephele {
namespace {

constexpr int kPlaceBits = 8;            // of a brick's place along one axis of the atlas
constexpr uint32_t kPresent = 1u << 24;  // set where there is a brick, since the place (0, 0, 0) is none

int64_t divideUp(int64_t a, int64_t b) { return (a + b - 1) / b; }

/// Bricks along each axis of the atlas: nearly a cube, so that little is left unused.
glm::ivec3 placesFor(size_t slots, int limitTexels) {
  const int64_t most = std::min(limitTexels / kBrickSamples, (1 << kPlaceBits) - 1);
  const int64_t count = std::max<int64_t>(static_cast<int64_t>(slots), 1);
  const int64_t edge =
      std::min<int64_t>(most, std::llround(std::ceil(std::cbrt(static_cast<double>(count)))));
  const int64_t x = std::min(edge, count);
  const int64_t y = std::min(edge, divideUp(count, x));
  const int64_t z = divideUp(count, x * y);
  if (z > most)
    throw InputError({}, "the grid needs " + std::to_string(count) +
                             " bricks, more than the driver's 3-D textures hold (" +
                             std::to_string(most * most * most) + ")");
  return glm::ivec3(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
}

void setFilter(GLuint texture, GLint filter) {
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, filter);
  for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(texture, axis, GL_CLAMP_TO_EDGE);
}

}  // namespace

BrickAtlas::BrickAtlas(const BrickVolume& bricks, Filter filter)
    : atlas_(makeTexture(GL_TEXTURE_3D)), index_(makeTexture(GL_TEXTURE_3D)) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limit);
  const glm::ivec3 count = bricks.brickCount;
  if (std::max({count.x, count.y, count.z}) > limit)
    throw InputError({bricks.path}, "the grid is " + std::to_string(std::max({count.x, count.y, count.z})) +
                                        " bricks long, and the driver's 3-D textures end at " +
                                        std::to_string(limit));
  const glm::ivec3 places = placesFor(bricks.slotCount(), limit);
  setFilter(atlas_.name(), filter == Filter::hardware ? GL_LINEAR : GL_NEAREST);
  setFilter(index_.name(), GL_NEAREST);
  uploadAtlas(bricks, places);
  uploadIndex(bricks, places);
}

void BrickAtlas::uploadAtlas(const BrickVolume& bricks, const glm::ivec3& places) {
  sizeTexels_ = places * kBrickSamples;
  glTextureStorage3D(atlas_.name(), 1, GL_R32F, sizeTexels_.x, sizeTexels_.y, sizeTexels_.z);
  checkGl("making an atlas of " + std::to_string(bricks.slotCount()) + " bricks");
  gpuBytes_ += sizeof(float) * static_cast<uint64_t>(sizeTexels_.x) * static_cast<uint64_t>(sizeTexels_.y) *
               static_cast<uint64_t>(sizeTexels_.z);
  // One row of bricks at a time: few calls, and little memory beside the texture.
  const size_t rowTexels = static_cast<size_t>(sizeTexels_.x);
  std::vector<float> row(rowTexels * kBrickSamples * kBrickSamples);
  const size_t perRow = static_cast<size_t>(places.x);
  for (size_t first = 0; first < bricks.slotCount(); first += perRow) {
    const size_t last = std::min(first + perRow, bricks.slotCount());
    for (size_t slot = first; slot < last; ++slot) {
      const float* from = bricks.samples.data() + slot * kBrickVolume;
      float* to = row.data() + (slot - first) * kBrickSamples;
      for (int line = 0; line < kBrickSamples * kBrickSamples; ++line)
        std::copy_n(from + line * kBrickSamples, kBrickSamples, to + static_cast<size_t>(line) * rowTexels);
    }
    const int number = static_cast<int>(first / perRow);
    glTextureSubImage3D(atlas_.name(), 0, 0, number % places.y * kBrickSamples,
                        number / places.y * kBrickSamples, sizeTexels_.x, kBrickSamples, kBrickSamples,
                        GL_RED, GL_FLOAT, row.data());
  }
  checkGl("uploading " + std::to_string(bricks.slotCount()) + " bricks");
}

void BrickAtlas::uploadIndex(const BrickVolume& bricks, const glm::ivec3& places) {
  const glm::ivec3 size = glm::max(bricks.brickCount, glm::ivec3(1));
  std::vector<uint32_t> packed(static_cast<size_t>(size.x) * static_cast<size_t>(size.y) *
                               static_cast<size_t>(size.z));
  const uint32_t nx = static_cast<uint32_t>(places.x), ny = static_cast<uint32_t>(places.y);
  for (size_t i = 0; i < bricks.index.size(); ++i) {
    if (bricks.index[i] == 0) continue;
    const uint32_t slot = bricks.index[i] - 1;
    packed[i] =
        kPresent | slot % nx | (slot / nx % ny) << kPlaceBits | (slot / (nx * ny)) << (2 * kPlaceBits);
  }
  glTextureStorage3D(index_.name(), 1, GL_R32UI, size.x, size.y, size.z);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage3D(index_.name(), 0, 0, 0, 0, size.x, size.y, size.z, GL_RED_INTEGER, GL_UNSIGNED_INT,
                      packed.data());
  checkGl("uploading the index of bricks");
  gpuBytes_ += sizeof(uint32_t) * packed.size();
}

void BrickAtlas::bind() const {
  glBindTextureUnit(0, atlas_.name());
  glBindTextureUnit(1, index_.name());
}

}  // namespace nephele
