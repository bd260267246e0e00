// Reading lat-long pictures and building alias tables. Depends on base alone.
#include "scene/environment_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/picture.h"

namespace nephele {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kCellSolidAngle = 4.0 * kPi / kEnvironmentCells;

double luminanceOf(const glm::vec3& c) {
  return 0.2126 * double{c.x} + 0.7152 * double{c.y} + 0.0722 * double{c.z};  // Rec.709
}

/// Power of each cell: texels are cut so finely that each piece lies in one cell, but for its rim.
std::vector<double> powersOf(const EnvironmentMap& map) {
  std::vector<double> powers(kEnvironmentCells);
  constexpr int kPiecesPerCell = 2;
  const int across = std::max(1, kPiecesPerCell * kEnvironmentCellsAround / map.width);
  const int down = std::max(1, kPiecesPerCell * kEnvironmentCellsUp / map.height);
  for (int y = 0; y < map.height * down; ++y) {
    const double top = std::cos(kPi * y / (map.height * down));
    const double bottom = std::cos(kPi * (y + 1) / (map.height * down));
    const int row = std::clamp(static_cast<int>(0.25 * (2.0 - top - bottom) * kEnvironmentCellsUp), 0,
                               kEnvironmentCellsUp - 1);
    const double solidAngle = (top - bottom) * 2.0 * kPi / (map.width * across);
    for (int x = 0; x < map.width * across; ++x) {
      const int column = static_cast<int>((x + 0.5) / (map.width * across) * kEnvironmentCellsAround);
      const size_t texel =
          static_cast<size_t>(y / down) * static_cast<size_t>(map.width) + static_cast<size_t>(x / across);
      powers[static_cast<size_t>(row * kEnvironmentCellsAround + column)] +=
          solidAngle * luminanceOf(map.texels[texel]);
    }
  }
  return powers;
}

/// Walker's table by Vose's method: cells below the mean are filled up by one above it.
std::vector<glm::vec4> aliasTable(std::vector<double> powers) {
  double total = 0.0;
  for (const double power : powers) total += power;
  const double scale = total > 0.0 ? kEnvironmentCells / total : 0.0;
  std::vector<glm::vec4> cells(powers.size());
  std::vector<size_t> low, high;
  for (size_t i = 0; i < powers.size(); ++i) {
    powers[i] = total > 0.0 ? powers[i] * scale : 1.0;
    const double density = powers[i] / (kEnvironmentCells * kCellSolidAngle);
    cells[i] = glm::vec4(1.0f, static_cast<float>(i), static_cast<float>(density), 0.0f);
    (powers[i] < 1.0 ? low : high).push_back(i);
  }
  while (!low.empty() && !high.empty()) {
    const size_t small = low.back(), large = high.back();
    low.pop_back();
    cells[small].x = static_cast<float>(powers[small]);
    cells[small].y = static_cast<float>(large);
    powers[large] -= 1.0 - powers[small];
    if (powers[large] < 1.0) {
      high.pop_back();
      low.push_back(large);
    }
  }
  return cells;  // what is left is 1 to rounding
}

/// The plane of a channel, or nullptr.
const std::vector<float>* planeOf(const Picture& picture, const std::string& name) {
  const int index = picture.find(name);
  return index < 0 ? nullptr : &picture.planes[static_cast<size_t>(index)];
}

}  // namespace

glm::dvec3 EnvironmentMap::radiance(double u, double v) const {
  const double x = u * width - 0.5, y = v * height - 0.5;
  const double left = std::floor(x), above = std::floor(y);
  const double fx = x - left, fy = y - above;
  const auto texel = [&](double column, double row) {
    const int wrapped = (static_cast<int>(column) % width + width) % width;
    const int held = std::clamp(static_cast<int>(row), 0, height - 1);
    return glm::dvec3(
        texels[static_cast<size_t>(held) * static_cast<size_t>(width) + static_cast<size_t>(wrapped)]);
  };
  return (1.0 - fy) * ((1.0 - fx) * texel(left, above) + fx * texel(left + 1.0, above)) +
         fy * ((1.0 - fx) * texel(left, above + 1.0) + fx * texel(left + 1.0, above + 1.0));
}

EnvironmentMap makeEnvironmentMap(std::string path, int width, int height, std::vector<glm::vec3> texels) {
  NEPHELE_CHECK_GT(width, 0);
  NEPHELE_CHECK_GT(height, 0);
  NEPHELE_CHECK_EQ(texels.size(), static_cast<size_t>(width) * static_cast<size_t>(height));
  EnvironmentMap map{std::move(path), width, height, std::move(texels), {}};
  map.cells = aliasTable(powersOf(map));
  return map;
}

std::shared_ptr<const EnvironmentMap> loadEnvironmentMap(const std::string& path) {
  const Picture picture = readExr(path);
  constexpr int64_t kMostTexels = int64_t{1} << 26;  // 1 GiB on the GPU
  if (int64_t{picture.width} * picture.height > kMostTexels)
    throw InputError({path}, "an environment holds at most 2^26 texels, and this has " +
                                 std::to_string(picture.width) + "x" + std::to_string(picture.height));
  const std::vector<float>* grey = planeOf(picture, "Y");
  const std::vector<float>* planes[3] = {planeOf(picture, "R"), planeOf(picture, "G"), planeOf(picture, "B")};
  for (const std::vector<float>*& plane : planes) {
    if (plane == nullptr) plane = grey;
    if (plane == nullptr) throw InputError({path}, "an environment needs the channels R, G and B, or Y");
  }
  std::vector<glm::vec3> texels(planes[0]->size());
  for (size_t i = 0; i < texels.size(); ++i) {
    texels[i] = glm::vec3((*planes[0])[i], (*planes[1])[i], (*planes[2])[i]);
    for (int c = 0; c < 3; ++c)
      if (!(texels[i][c] >= 0.0f) || !std::isfinite(texels[i][c]))
        throw InputError({path}, "holds a radiance that is negative or not finite, at column " +
                                     std::to_string(i % static_cast<size_t>(picture.width)) + ", row " +
                                     std::to_string(i / static_cast<size_t>(picture.width)));
  }
  return std::make_shared<const EnvironmentMap>(
      makeEnvironmentMap(path, picture.width, picture.height, std::move(texels)));
}

}  // namespace nephele
