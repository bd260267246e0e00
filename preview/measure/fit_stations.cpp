// Stations of a fit. Depends on what its header names.
#include "preview/measure/fit_stations.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/sun_factors.h"

namespace nephele {
namespace {

using glm::dvec3;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kIrradiance = 3.0;

constexpr double kLow = kFittedElevations[0], kMiddle = kFittedElevations[1], kHigh = kFittedElevations[2];

/// At each height of the sun it stands behind the camera, to one side, and behind the cloud.
constexpr FitStation kStations[] = {
    {0, -8, 15, kLow, true},      {80, 15, 160, kLow, true},    {170, 0, 35, kLow, true},
    {250, 5, 70, kLow, true},     {45, 10, 65, kMiddle, true},  {120, -5, 210, kMiddle, true},
    {200, 20, 75, kMiddle, true}, {310, 0, 140, kMiddle, true}, {60, 0, 90, kHigh, true},
    {155, 25, 75, kHigh, true},   {230, -8, 5, kHigh, true},    {340, 8, 165, kHigh, true},
    {30, 5, 10, 30, false},       {150, 20, 270, 55, false},    {210, -10, 50, 20, false},
    {270, 0, 330, 5, false},      {100, 12, 55, 75, false},     {330, 25, 180, 12, false},
    {10, -6, 110, 40, false},     {75, 30, 235, 3, false}};

/// Unit; azimuth 0 looks from where the view's camera stands, at elevation 0.
dvec3 directionAt(const ViewedScene& view, double azimuth, double elevation) {
  const dvec3 up = glm::normalize(view.up);
  dvec3 towards = view.camera.position - view.camera.target;
  towards = glm::normalize(towards - glm::dot(towards, up) * up);
  const dvec3 side = glm::cross(up, towards);
  const dvec3 flat = std::cos(azimuth * kDegree) * towards + std::sin(azimuth * kDegree) * side;
  return std::cos(elevation * kDegree) * flat + std::sin(elevation * kDegree) * up;
}

}  // namespace

std::span<const FitStation> fitStations() { return kStations; }

ViewedScene viewFrom(const ViewedScene& given, const FitStation& station) {
  ViewedScene view = given;
  const double distance = glm::length(given.camera.position - given.camera.target);
  view.camera.position =
      given.camera.target + distance * directionAt(given, station.camera, station.cameraUp);
  view.camera.up = given.up;
  Scene& scene = view.scene;
  scene.lights = {
      Sun{directionAt(given, station.sun, station.sunUp), {kIrradiance, kIrradiance, kIrradiance}}};
  scene.environment = Environment{};
  scene.look = Look::physical;
  scene.powder.on = false;
  scene.lightTransmittance = LightTransmittance::marched;
  scene.march.lightCache = false;  // each view has another sun
  scene.march.levelPixels = scene.march.stepPixels =
      0.0;  // the small pictures stand for large ones, which resolve every voxel
  return view;
}

}  // namespace nephele
