// Float targets with additive blending. Depends on base/picture.h and gpu/gl.h.
#include "preview/gpu/film.h"

#include <algorithm>
#include <string>

namespace nephele {
namespace {

constexpr size_t kChannels = 4;

std::vector<float> texelsOf(const GlTexture& texture, int width, int height) {
  std::vector<float> texels(static_cast<size_t>(width) * static_cast<size_t>(height) * kChannels);
  const size_t sizeBytes = texels.size() * sizeof(float);
  // Drivers take the size as an int.
  constexpr size_t kMostBytes = size_t{1} << 30;
  NEPHELE_CHECK_LE(sizeBytes, kMostBytes);
  glGetTextureImage(texture.name(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(sizeBytes), texels.data());
  checkGl("reading the picture back");
  return texels;
}

}  // namespace

Film::Film(int width, int height) : width_(width), height_(height), framebuffer_(makeFramebuffer()) {
  NEPHELE_CHECK_GT(width, 0);
  NEPHELE_CHECK_GT(height, 0);
  constexpr int64_t kMostPixels = int64_t{1} << 26;  // 1 GiB a target
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (std::max(width, height) > limit || int64_t{width} * height > kMostPixels)
    throw InputError({}, "a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                             " pixels is too large; the limit is " + std::to_string(limit) + " a side and " +
                             std::to_string(kMostPixels) + " in all");
  std::array<GLenum, kTargets> buffers{};
  for (int i = 0; i < kTargets; ++i) {
    const size_t target = static_cast<size_t>(i);
    textures_[target] = makeTexture(GL_TEXTURE_2D);
    const GLuint name = textures_[target].name();
    glTextureStorage2D(name, 1, GL_RGBA32F, width, height);
    for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
      glTextureParameteri(name, axis, GL_CLAMP_TO_EDGE);
    for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      glTextureParameteri(name, filter, GL_LINEAR);
    buffers[target] = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
    glNamedFramebufferTexture(framebuffer_.name(), buffers[target], name, 0);
  }
  glNamedFramebufferDrawBuffers(framebuffer_.name(), kTargets, buffers.data());
  checkGl("making a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
  if (glCheckNamedFramebufferStatus(framebuffer_.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw WorldError("the driver cannot draw to float targets");
  clear();
}

void Film::clear() {
  const float zero[kChannels] = {};
  for (int i = 0; i < kTargets; ++i) glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, i, zero);
}

void Film::bindAsTarget() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
}

void Film::bindForDisplay() const {
  for (GLuint unit = 0; unit < kTargets; ++unit) glBindTextureUnit(unit, textures_[unit].name());
}

std::vector<float> Film::radianceSums() const { return texelsOf(textures_[0], width_, height_); }
std::vector<float> Film::depthSums() const { return texelsOf(textures_[2], width_, height_); }

double Film::depthAt(int x, int y) const {
  NEPHELE_CHECK_LE(0, std::min(x, y));
  NEPHELE_CHECK_LT(x, width_);
  NEPHELE_CHECK_LT(y, height_);
  float texel[kChannels] = {};
  glGetTextureSubImage(textures_[2].name(), 0, x, y, 0, 1, 1, 1, GL_RGBA, GL_FLOAT, sizeof texel, texel);
  checkGl("reading a depth back");
  return texel[1] > 0.0f ? double{texel[0]} / double{texel[1]} : 0.0;
}

FilmPicture Film::read() const {
  FilmPicture result;
  Picture& picture = result.picture;
  picture.width = width_;
  picture.height = height_;
  for (const char* name :
       {"R", "G", "B", "A", "transmittance.R", "transmittance.G", "transmittance.B", "depth"})
    picture.add(name);
  const size_t pixels = static_cast<size_t>(width_) * static_cast<size_t>(height_);
  std::vector<float> scale(pixels);  // 1 / samples
  {
    const auto texels = texelsOf(textures_[1], width_, height_);
    for (size_t i = 0; i < pixels; ++i) {
      const float count = texels[i * kChannels + 3];
      scale[i] = count > 0.0f ? 1.0f / count : 0.0f;
      for (size_t c = 0; c < 3; ++c) picture.planes[kChannels + c][i] = texels[i * kChannels + c] * scale[i];
    }
  }
  {
    const auto texels = texelsOf(textures_[0], width_, height_);
    for (size_t i = 0; i < pixels; ++i)
      for (size_t c = 0; c < kChannels; ++c) picture.planes[c][i] = texels[i * kChannels + c] * scale[i];
  }
  const auto texels = texelsOf(textures_[2], width_, height_);
  for (size_t i = 0; i < pixels; ++i) {
    const float* texel = texels.data() + i * kChannels;
    picture.planes.back()[i] = texel[1] > 0.0f ? texel[0] / texel[1] : 0.0f;
    result.densitySamples += double{texel[2]};
    result.raysCutShort += double{texel[3]};
  }
  requireKeptContext("reading the picture");
  return result;
}

uint64_t Film::bytesFor(int width, int height) {
  return uint64_t{kTargets} * kChannels * sizeof(float) * static_cast<uint64_t>(width) *
         static_cast<uint64_t>(height);
}

}  // namespace nephele
