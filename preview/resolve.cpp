// Framing and auto-exposure. Depends on scene, volume/bricks.h and preview/stage_places.h.
#include "preview/resolve.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/matrix.hpp>
#include <iomanip>
#include <iterator>
#include <sstream>

#include "preview/stage_places.h"
#include "scene/light_model.h"
#include "scene/sun_factors.h"

namespace nephele {
namespace {

using glm::dvec3;

constexpr double kFrameMargin = 1.05;
constexpr double kExposureDepth = 8.0;  // dense enough to show a form, thin enough to show what is inside
constexpr double kExposureG = 0.6;

/// "8", "8 8 8", "[8, 8, 8]" → numbers; nothing where there is anything else in the text.
std::vector<double> numbersIn(std::string text) {
  for (char& c : text)
    if (c == '[' || c == ']' || c == ',' || c == '(' || c == ')') c = ' ';
  std::istringstream in(text);
  std::vector<double> numbers;
  for (std::string word; in >> word;) {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0' || !std::isfinite(numbers.back())) return {};
  }
  return numbers;
}

Rgb rgbFrom(const BrickVolume& bricks, const std::string& key) {
  const auto found = bricks.metadata.find(key);
  if (found == bricks.metadata.end()) return {0.0, 0.0, 0.0};
  const std::vector<double> numbers = numbersIn(found->second);
  const bool negative = std::any_of(numbers.begin(), numbers.end(), [](double v) { return v < 0.0; });
  if ((numbers.size() != 1 && numbers.size() != 3) || negative)
    throw InputError({bricks.path}, "the metadata '" + key + "' is '" + found->second +
                                        "', and should be one or three numbers, at least 0");
  return numbers.size() == 1 ? Rgb{numbers[0], numbers[0], numbers[0]}
                             : Rgb{numbers[0], numbers[1], numbers[2]};
}

double gFrom(const BrickVolume& bricks) {
  const auto found = bricks.metadata.find("g");
  if (found == bricks.metadata.end()) return 0.0;
  const std::vector<double> numbers = numbersIn(found->second);
  if (numbers.size() != 1 || !(std::abs(numbers[0]) < 1.0))
    throw InputError({bricks.path},
                     "the metadata 'g' is '" + found->second + "', and should lie between -1 and 1");
  return numbers[0];
}

std::string textOf(const Rgb& rgb) {
  std::ostringstream out;
  out << rgb[0];
  if (rgb[1] != rgb[0] || rgb[2] != rgb[0]) out << ' ' << rgb[1] << ' ' << rgb[2];
  return out.str();
}

std::string describe(const std::string& source, const Medium& medium) {
  std::ostringstream out;
  out << "medium: " << source << ": sigma_s " << textOf(medium.sigmaS) << ", sigma_a "
      << textOf(medium.sigmaA) << ", g " << medium.g;
  return out.str();
}

Medium exposedMedium(const BrickVolume& bricks) {
  const double voxel = std::abs(glm::determinant(glm::dmat3(bricks.worldFromIndex)));
  const double edge = std::cbrt(static_cast<double>(bricks.activeVoxels) * voxel);
  const double column = bricks.meanActive * edge;
  Medium medium;
  const double sigma = column > 0.0 ? kExposureDepth / column : 1.0;
  medium.sigmaS = {sigma, sigma, sigma};
  medium.g = kExposureG;
  return medium;
}

std::vector<dvec3> cornersOfBox(const BrickVolume& bricks) {
  std::vector<dvec3> corners;
  for (int i = 0; i < 8; ++i) {
    dvec3 index;
    for (int axis = 0; axis < 3; ++axis)
      index[axis] = (i >> axis & 1) != 0 ? bricks.activeMax[axis] : bricks.activeMin[axis] - 1;
    corners.emplace_back(bricks.worldFromIndex * glm::dvec4(index, 1.0));
  }
  return corners;
}

/// Of the cubes around the stage's things.
void addStageCorners(const Stage& stage, const dvec3& up, const BrickVolume& bricks,
                     std::vector<dvec3>& corners) {
  const StagePlaces places = placesOf(stage, up, bricks);
  const auto add = [&](const StageThing& thing, const StagePlace& at) {
    if (!thing.on) return;
    for (int i = 0; i < 8; ++i) {
      const auto side = [&](int axis) { return (i >> axis & 1) != 0 ? at.half : -at.half; };
      corners.push_back(at.centre + side(0) * places.axes.right + side(1) * places.axes.forward +
                        side(2) * places.axes.up);
    }
  };
  add(stage.chrome, places.chrome);
  add(stage.grey, places.grey);
  add(stage.cube, places.cube);
}

}  // namespace

dvec3 upOf(const BrickVolume& bricks) {
  const auto creator = bricks.metadata.find("creator");
  const bool houdini = creator != bricks.metadata.end() && creator->second.starts_with("Houdini");
  if (houdini && !bricks.metadata.contains("up_axis")) return dvec3(0.0, 1.0, 0.0);
  return bricks.upAxis == 'y' ? dvec3(0.0, 1.0, 0.0) : dvec3(0.0, 0.0, 1.0);
}

Camera frameCamera(const BrickVolume& bricks, const dvec3& up, double fov, double aspect,
                   const Stage& stage) {
  std::vector<dvec3> corners = cornersOfBox(bricks);
  if (stage.on) addStageCorners(stage, up, bricks, corners);
  dvec3 low = corners.front(), high = corners.front();
  for (const dvec3& corner : corners) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  const dvec3 centre = 0.5 * (low + high);
  // From the side, so that a light over either shoulder models the form, 20 degrees round; and from 13
  // degrees below, as clouds are seen: sky stands behind them. A stage is seen from above its floor.
  constexpr double kAside = 1.5, kBack = 4.0, kBelow = -0.95, kAboveFloor = 0.75;
  const dvec3 right(1.0, 0.0, 0.0);
  const dvec3 front = glm::cross(right, up);  // −Y where Z is up, +Z where Y is up
  const dvec3 from = glm::normalize(kAside * right + kBack * front + (stage.on ? kAboveFloor : kBelow) * up);
  const double tanY = std::tan(0.5 * fov), tanX = tanY * aspect;
  const dvec3 rightAxis = glm::normalize(glm::cross(up, from)), upAxis = glm::cross(from, rightAxis);
  // A corner is in the picture where its offset across the view is at most its distance along it times the
  // tangent.
  double distance = 0.0;
  for (const dvec3& corner : corners) {
    const dvec3 offset = kFrameMargin * (corner - centre);
    const double towards = glm::dot(offset, from);
    distance = std::max({distance, towards + std::abs(glm::dot(offset, rightAxis)) / tanX,
                         towards + std::abs(glm::dot(offset, upAxis)) / tanY});
  }
  Camera camera;
  camera.target = centre;
  camera.position = centre + distance * from;
  camera.up = up;
  camera.fov = fov;
  return camera;
}

bool seesFloorFromBelow(const Camera& camera, const Stage& stage, const dvec3& up,
                        const BrickVolume& bricks) {
  return stage.on && stage.floor && glm::dot(camera.position - placesOf(stage, up, bricks).ground, up) < 0.0;
}

ChosenMedium chooseMedium(const Scene& scene, const BrickVolume& bricks) {
  if (scene.medium) return {*scene.medium, MediumSource::scene, describe("the scene's", *scene.medium)};
  if (bricks.metadata.contains("sigma_s") || bricks.metadata.contains("sigma_a")) {
    const Medium medium{rgbFrom(bricks, "sigma_s"), rgbFrom(bricks, "sigma_a"), gFrom(bricks)};
    return {medium, MediumSource::file, describe("the file's metadata", medium)};
  }
  const Medium medium = exposedMedium(bricks);
  return {medium, MediumSource::exposure,
          describe("auto-exposure (mean density 8 optical depths thick)", medium)};
}

dvec3 turnedTo(const dvec3& up, const dvec3& direction) {
  return std::abs(up.y) > std::abs(up.z) ? dvec3(direction.x, direction.z, -direction.y) : direction;
}

void turnLights(Scene& scene, const dvec3& up) {
  if (!scene.lightsFollowUp) return;
  for (Light& light : scene.lights) {
    if (Sun* sun = std::get_if<Sun>(&light)) sun->toLight = turnedTo(up, sun->toLight);
    if (PointLight* point = std::get_if<PointLight>(&light)) point->position = turnedTo(up, point->position);
  }
  scene.lightsFollowUp = false;
}

std::optional<int> fittedCount(const BrickVolume& bricks) {
  const auto found = bricks.metadata.find(kFittedCount);
  if (found == bricks.metadata.end()) return std::nullopt;
  const std::vector<double> numbers = numbersIn(found->second);
  if (numbers.size() != 1 || !(numbers[0] >= 0.0 && numbers[0] <= kMostOctaveCount) ||
      numbers[0] != std::floor(numbers[0]))
    throw InputError({bricks.path}, std::string("the metadata '") + kFittedCount +
                                        "' should be a whole number from 0 to " +
                                        std::to_string(kMostOctaveCount));
  return static_cast<int>(numbers[0]);
}

bool hasFittedFactors(const BrickVolume& bricks) { return bricks.metadata.contains(kFittedFactors[0]); }

bool takeFittedFactors(Octaves& octaves, const BrickVolume& bricks, double elevation) {
  if (octaves.factorsGiven || !hasFittedFactors(bricks)) return false;
  SunFactors fitted{};
  for (size_t i = 0; i < std::size(kFittedFactors); ++i) {
    const auto found = bricks.metadata.find(kFittedFactors[i]);
    if (found == bricks.metadata.end() && i == kOpenness) continue;  // 0, as in files that know nothing of it
    std::vector<double> numbers =
        found == bricks.metadata.end() ? std::vector<double>{} : numbersIn(found->second);
    if (numbers.size() == 1) numbers.resize(fitted.size(), numbers.front());
    const bool factors =
        std::all_of(numbers.begin(), numbers.end(), [](double v) { return v >= 0.0 && v <= 1.0; });
    if (numbers.size() != fitted.size() || !factors)
      throw InputError({bricks.path}, std::string("the metadata '") + kFittedFactors[i] +
                                          "' should be one or three numbers from 0 to 1");
    for (size_t node = 0; node < fitted.size(); ++node) fitted[node][i] = numbers[node];
  }
  const OctaveFactors taken = factorsAt(fitted, elevation);
  octaves.a = taken[0];
  octaves.b = taken[1];
  octaves.c = taken[2];
  octaves.d = taken[kOpenness];
  if (const std::optional<int> count = fittedCount(bricks); count && !octaves.count) octaves.count = count;
  return true;
}

void followSun(Scene& scene, const Medium& medium, const BrickVolume& bricks, const glm::dvec3& up) {
  if (lightModelOf(scene, medium).octaveCount == 0) return;
  const std::optional<int> count = scene.octaves.count;
  takeFittedFactors(scene.octaves, bricks, sunElevation(scene, up));
  scene.octaves.count = count;
}

ViewedScene resolveScene(const Scene& scene, const BrickVolume& bricks, double aspect,
                         std::string& mediumSentence) {
  ChosenMedium chosen = chooseMedium(scene, bricks);
  mediumSentence = std::move(chosen.sentence);
  ViewedScene view{scene, Camera{}, chosen.medium, upOf(bricks), nullptr};
  turnLights(view.scene, view.up);
  const bool scatters = lightModelOf(scene, view.medium).octaveCount > 0;
  const double elevation = sunElevation(view.scene, view.up);
  if (scatters && takeFittedFactors(view.scene.octaves, bricks, elevation)) {
    std::ostringstream fitted;
    const double used = std::clamp(elevation, kFittedElevations.front(), kFittedElevations.back());
    const bool hasSun = std::any_of(view.scene.lights.begin(), view.scene.lights.end(),
                                    [](const Light& l) { return std::holds_alternative<Sun>(l); });
    fitted << "\noctaves: as fitted to the file for a sun at " << std::round(used) << " degrees";
    if (!hasSun) fitted << " (the scene has none)";
    if (used != elevation) fitted << " (the scene's is at " << std::round(elevation) << ')';
    fitted << ": a " << view.scene.octaves.a << ", b " << view.scene.octaves.b << ", c "
           << view.scene.octaves.c << ", d " << view.scene.octaves.d;
    const std::optional<int> count = fittedCount(bricks);
    if (count && count != view.scene.octaves.count)
      fitted << " (fitted for " << *count << " orders beyond the first, the scene asks for "
             << *view.scene.octaves.count << ')';
    mediumSentence += fitted.str();
  }
  if (scene.environment.kind == Environment::Kind::exr)
    view.environmentMap = loadEnvironmentMap(scene.environment.exr.path);
  if (scene.camera) {
    view.camera = *scene.camera;
    if (!scene.cameraUpGiven) view.camera.up = view.up;
  } else {
    view.camera = frameCamera(bricks, view.up, Camera{}.fov, aspect, scene.stage);
  }
  return view;
}

std::string describeLight(const ViewedScene& view) {
  const LightModel model = lightModelOf(view.scene, view.medium);
  std::ostringstream out;
  out << "look: " << nameOf(model.look);
  std::string unphysical;
  for (const LightTerm& term : termsOf(model)) {
    if (!term.on) continue;
    out << ", " << term.name;
    if (!term.physical) unphysical += (unphysical.empty() ? "" : ", ") + std::string(term.name);
  }
  if (model.octaveCount > 0) {
    const double furnace = furnaceValue(model.octaveCount, model.a, model.b, model.d);
    constexpr int kDigits = 3;
    out << " (" << model.octaveCount << " beyond the first; white furnace " << std::setprecision(kDigits)
        << furnace << (furnace > 1.0 ? ", ABOVE 1: they make light" : "") << ')';
  }
  if (!unphysical.empty()) out << "; not physical: " << unphysical;
  return out.str();
}

}  // namespace nephele
