// An example of every row: its defaults, with shapes and noise for child fields and small files (a cube as
// OBJ, a weather map as EXR) where it needs one. For the docs page, benchmarks and tests. Depends on the
// table and base.
#pragma once

#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "bake/fields/table.h"
#include "base/picture.h"

namespace nephele::examples {

/// A folder that goes when the program ends.
class SampleFolder {
 public:
  SampleFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "nephele_sample_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for samples");
    path_ = name;
  }
  ~SampleFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  SampleFolder(const SampleFolder&) = delete;
  SampleFolder& operator=(const SampleFolder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// An axis-aligned cube about the origin with faces of four corners, edges of 2 · `half`.
inline std::string cubeAsObj(double half) {
  std::string text = "# a cube\no cube\n";
  for (int corner = 0; corner < 8; ++corner) {
    text += "v";
    for (int axis = 0; axis < 3; ++axis)
      text += " " + std::to_string((corner >> axis & 1) != 0 ? half : -half);
    text += "\n";
  }
  // Corners are numbered from 1 by their bits, x lowest; faces turn left as seen from outside.
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

/// 16 × 12 texels of smooth coverage, all types from left to right, tops that grow downwards.
inline Picture weatherPicture() {
  Picture picture;
  picture.width = 16;
  picture.height = 12;
  const size_t red = picture.add("R"), green = picture.add("G"), blue = picture.add("B");
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const size_t n = size_t(y * picture.width + x);
      const float u = float(x) / 15.0f, v = float(y) / 11.0f;
      picture.planes[red][n] = 1.0f - 0.8f * std::abs(u + v - 1.0f);
      picture.planes[green][n] = u;
      picture.planes[blue][n] = 0.4f + 0.6f * v;
    }
  return picture;
}

/// The path of a sample for the row's file, written when first asked for. From any thread.
inline std::string sampleFile(std::string_view row) {
  struct Samples : SampleFolder {
    Samples() {
      writeExr(file("weather.exr"), weatherPicture());
      std::ofstream(file("cube.obj")) << cubeAsObj(0.6);
    }
  };
  static const Samples samples;
  return samples.file(row == "weather_map" ? "weather.exr" : "cube.obj");
}

/// The row at its defaults. Child fields are two balls side by side for lists; for single ones fBm where the
/// parameter is called b or t, and a soft ball elsewhere. A transform makes streaks of fBm.
inline FieldPtr exampleField(const std::string& name, const BuildContext& context) {
  const auto ball = [&](double x) {
    const FieldRow* const sphere = findField("sphere");
    return sphere->build(
        Arguments({{"center", std::array<double, 3>{x, 0, 0}}, {"radius", 0.7}, {"falloff", 0.35}}), context);
  };
  const FieldRow* const row = findField(name);
  NEPHELE_CHECK_EQ(row != nullptr ? name : std::string("no such field"), name);
  std::map<std::string, Value, std::less<>> values;
  for (const Parameter& parameter : row->parameters) {
    if (parameter.fallback)
      values.emplace(parameter.name, *parameter.fallback);
    else if (parameter.type == ParameterType::file)
      values.emplace(parameter.name, InputFile{sampleFile(name), {}});
    else if (parameter.type == ParameterType::fields)
      values.emplace(parameter.name, std::vector<FieldPtr>{ball(-0.4), ball(0.4)});
    else
      values.emplace(parameter.name, parameter.name == "b" || parameter.name == "t"
                                         ? exampleField("fbm", context)
                                         : ball(0.0));
  }
  if (name == "transform") {  // its defaults change nothing
    values["input"] = exampleField("fbm", context);
    values["scale"] = std::array<double, 3>{3, 1, 0.5};
    values["rotate"] = std::array<double, 3>{0, 25, 0};
  }
  return row->build(Arguments(std::move(values)), context);
}

}  // namespace nephele::examples
