// The tone curve, and 8-bit PNG for people to look at. Depends on base and stb.
#include <stb/stb_image_write.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "base/error.h"
#include "base/files.h"
#include "base/picture.h"

namespace nephele {
namespace {

constexpr int kRgb = 3;

/// Linear 0…1 to the sRGB transfer function 0…1 (IEC 61966-2-1).
double encodeSrgb(double linear) {
  constexpr double kToeEnd = 0.0031308, kToeSlope = 12.92, kScale = 1.055, kOffset = 0.055,
                   kPower = 1.0 / 2.4;
  return linear <= kToeEnd ? kToeSlope * linear : kScale * std::pow(linear, kPower) - kOffset;
}

void appendBytes(void* context, void* data, int sizeBytes) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(sizeBytes));
}

void writeBytes(const std::string& path, const std::string& temporary, const std::string& bytes) {
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) throw WorldError("cannot write '" + path + "'");
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const bool closed = std::fclose(file) == 0;
  if (!written || !closed) throw WorldError("cannot write '" + path + "': is the disk full?");
}

const std::vector<float>& planeOf(const Picture& picture, const std::string& name) {
  const int index = picture.find(name);
  NEPHELE_CHECK_GT(index, -1);
  return picture.planes[static_cast<size_t>(index)];
}

}  // namespace

std::array<unsigned char, 3> toneMap(const std::array<float, 3>& linear, float exposureEv) {
  constexpr double kWhite = 255.0;
  std::array<unsigned char, 3> result{};
  for (size_t c = 0; c < result.size(); ++c) {
    if (!(linear[c] >= 0.0f))
      throw WorldError("a pixel is " + std::to_string(linear[c]) + ", which no tone curve takes");
    // +infinity is white. expm1 keeps what 1 − e^(−x) would lose for a dark pixel.
    const double shown = -std::expm1(-double{linear[c]} * std::exp2(double{exposureEv}));
    result[c] = static_cast<unsigned char>(std::lround(kWhite * encodeSrgb(shown)));
  }
  return result;
}

void writePng(const std::string& path, const Picture& picture, float exposureEv, const Backdrop& backdrop) {
  NEPHELE_CHECK_GT(picture.width, 0);
  NEPHELE_CHECK_GT(picture.height, 0);
  const std::array<const std::vector<float>*, 3> colour{&planeOf(picture, "R"), &planeOf(picture, "G"),
                                                        &planeOf(picture, "B")};
  const std::vector<float>& alpha = planeOf(picture, "A");
  const size_t width = static_cast<size_t>(picture.width), height = static_cast<size_t>(picture.height);
  std::vector<unsigned char> pixels;
  pixels.reserve(width * height * kRgb);
  for (size_t y = 0; y < height; ++y) {
    const float fromTop = (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
    for (size_t x = 0; x < width; ++x) {
      const size_t i = y * width + x;
      std::array<float, 3> linear{};
      for (size_t c = 0; c < linear.size(); ++c) {
        const float behind = backdrop.top[c] + (backdrop.bottom[c] - backdrop.top[c]) * fromTop;
        linear[c] = (*colour[c])[i] + (1.0f - alpha[i]) * behind;
      }
      const auto shown = toneMap(linear, exposureEv);
      pixels.insert(pixels.end(), shown.begin(), shown.end());
    }
  }
  writePngBytes(path, picture.width, picture.height, pixels);
}

void writePngBytes(const std::string& path, int width, int height, const std::vector<unsigned char>& rgb) {
  NEPHELE_CHECK_EQ(rgb.size(), static_cast<size_t>(width) * static_cast<size_t>(height) * kRgb);
  std::string bytes;
  if (stbi_write_png_to_func(appendBytes, &bytes, width, height, kRgb, rgb.data(), width * kRgb) == 0)
    throw WorldError("cannot encode '" + path + "' as PNG");
  writeWhole(path, [&](const std::string& temporary) { writeBytes(path, temporary, bytes); });
}

}  // namespace nephele
