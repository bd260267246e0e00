// Black bodies by a table. Depends on what its header names.
#include "preview/truth/emitter.h"

#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <vector>

#include "scene/blackbody.h"

namespace nephele::truth {
namespace {

using glm::dvec3;

constexpr double kHottestKelvin = 1e5;  // of the table
constexpr size_t kNodes = 2048;

dvec3 planck(double kelvin) {
  const std::array<double, 3> radiance = blackbodyRadiance(kelvin);
  return {radiance[0], radiance[1], radiance[2]};
}

/// Radiances at temperatures evenly spaced by their logarithms.
const std::vector<dvec3>& nodes() {
  static const std::vector<dvec3> made = [] {
    std::vector<dvec3> table;
    for (size_t i = 0; i < kNodes; ++i)
      table.push_back(planck(
          kColdestKelvin * std::pow(kHottestKelvin / kColdestKelvin, static_cast<double>(i) / (kNodes - 1))));
    return table;
  }();
  return made;
}

dvec3 radianceAt(double kelvin) {
  if (!(kelvin > kColdestKelvin)) return dvec3(0.0);
  if (kelvin >= kHottestKelvin) return planck(kelvin);
  const double place =
      (kNodes - 1) * std::log(kelvin / kColdestKelvin) / std::log(kHottestKelvin / kColdestKelvin);
  const size_t node = std::min(static_cast<size_t>(place), kNodes - 2);
  const double share = place - static_cast<double>(node);
  return (1.0 - share) * nodes()[node] + share * nodes()[node + 1];
}

}  // namespace

bool Emitter::isOn(const ViewedScene& view, const BrickVolume& bricks) {
  return view.scene.emission.on.value_or(true) && bricks.temperature && !bricks.temperature->empty() &&
         view.medium.sigmaA != Rgb{};
}

Emitter::Emitter(const ViewedScene& view, const BrickVolume& bricks)
    : temperature_(bricks.temperature),
      scale_(view.scene.emission.scale),
      temperatureScale_(view.scene.emission.temperatureScale) {
  glm::dmat4 indexFromPosition(1.0);
  indexFromPosition[3] = glm::dvec4(dvec3(bricks.brickMin * kBrickCells), 1.0);
  heatFromPosition_ = glm::inverse(temperature_->worldFromIndex) * bricks.worldFromIndex * indexFromPosition;
}

glm::vec3 Emitter::radiance(const glm::vec3& position) const {
  const dvec3 place(heatFromPosition_ * glm::dvec4(dvec3(position), 1.0));
  return glm::vec3(scale_ * radianceAt(temperatureScale_ * densityAt(*temperature_, place)));
}

}  // namespace nephele::truth
