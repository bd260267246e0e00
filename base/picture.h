// Pictures in memory and in files: float EXR with named channels, 8-bit PNG through one tone curve.
// Depends on base alone; OpenEXR and stb stay behind the .cpp.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace nephele {

/// Channels in planes: planes[c][y * width + x], row 0 at the top. Linear Rec.709, scene-referred. The first
/// four of a render are R, G, B, A, premultiplied; further ones are named as in the EXR.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::string> names;
  std::vector<std::vector<float>> planes;

  /// Adds a plane of zeros under `name` and returns its index. Width and height are set before.
  size_t add(const std::string& name);
  /// Index of the plane, or -1.
  int find(const std::string& name) const;
};

/// Writes all planes as float32 channels, ZIP compressed, whole or not at all. Throws WorldError.
void writeExr(const std::string& path, const Picture& picture);

/// Reads every channel as float32, in alphabetical order of names. A missing file or one that is no EXR is an
/// InputError.
Picture readExr(const std::string& path);

/// Colours behind a picture for people to look at (never light): linear Rec.709 at the lower and upper edge.
struct Backdrop {
  std::array<float, 3> bottom{0.0f, 0.0f, 0.0f};
  std::array<float, 3> top{0.0f, 0.0f, 0.0f};
};

/// The project's one tone curve: y = 1 − e^(−x · 2^ev) per channel, then the sRGB transfer function; result
/// in 0…255, rounded to nearest. x below 0 or NaN is a WorldError of the caller's making and is checked.
std::array<unsigned char, 3> toneMap(const std::array<float, 3>& linear, float exposureEv);

/// Writes R, G, B over the backdrop (weight 1 − A, mixed linearly by row) through the tone curve, opaque,
/// whole or not at all. Throws WorldError.
void writePng(const std::string& path, const Picture& picture, float exposureEv, const Backdrop& backdrop);

/// Writes 8-bit pixels as they are, R, G, B by rows from the top, whole or not at all. Throws WorldError.
void writePngBytes(const std::string& path, int width, int height, const std::vector<unsigned char>& rgb);

}  // namespace nephele
