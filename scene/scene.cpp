// Scenes from YAML and back. Depends on base alone. Keys, defaults and units: DESIGN.md, section 1.
#include "scene/scene.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "base/error.h"

namespace nephele {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
// Products of two such numbers stay finite in the renderer's single precision (3.4e38).
constexpr double kLargest = 1e15;
constexpr Range kCoordinate{-kLargest, kLargest};
constexpr Range kAmount{0.0, kLargest};
constexpr Range kOpenHalfTurn{0.0, 180.0, true, true};
constexpr Range kAsymmetry{-1.0, 1.0, true, true};
// Below, a ray takes more than a hundred steps a voxel; above, it leaps over whole bricks.
constexpr Range kStepVoxels{0.01, 100.0};
constexpr double kMostOctaves = 16.0;
constexpr Range kOctaveCount{0.0, kMostOctaves};
// kMaxLights of shaders/shared/parameters.glsl: the renderer's parameters hold so many.

std::array<double, 3> arrayOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
glm::dvec3 vectorOf(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

double largestComponent(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Unit vector along `v`, which is not 0. What has length 1 to rounding stays as it is, so that a scene that
/// was written and read again has the same bits.
glm::dvec3 normalized(const glm::dvec3& v) {
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
  if (std::abs(glm::dot(v, v) - 1.0) <= kRounding) return v;
  const glm::dvec3 scaled = v / largestComponent(v);  // squares of very small or large numbers would be lost
  return scaled / glm::length(scaled);
}

bool isZero(const glm::dvec3& v) { return largestComponent(v) == 0.0; }

Camera readCamera(const yaml::Node& node, bool& upGiven, Diagnostics& out) {
  yaml::MapReader reader(node, "'camera'", out);
  Camera camera;
  camera.position = vectorOf(reader.vector3("position", arrayOf(camera.position), kCoordinate));
  camera.target = vectorOf(reader.vector3("target", arrayOf(camera.target), kCoordinate));
  upGiven = reader.has("up");
  camera.up = vectorOf(reader.vector3("up", arrayOf(camera.up), kCoordinate));
  constexpr double kDefaultFovDegrees = 35.0;
  camera.fov = reader.number("fov", kDefaultFovDegrees, kOpenHalfTurn) * kRadiansPerDegree;
  reader.finish();

  const glm::dvec3 view = camera.target - camera.position;
  constexpr double kSmallestSine =
      1e-6;  // up and view nearer than this leave no side to turn to in single precision
  if (isZero(view)) {
    out.add(reader.where("position"), "the camera stands on its target",
            "give 'position' and 'target' apart");
  } else if (upGiven && isZero(camera.up)) {
    out.add(reader.where("up"), "'up' has no length");
  } else if (upGiven && glm::length(glm::cross(normalized(view), normalized(camera.up))) < kSmallestSine) {
    out.add(reader.where("up"), "'up' points along the view",
            "give another axis, such as [0, 1, 0] or [1, 0, 0]");
  }
  return camera;
}

Medium readMedium(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'medium'", out);
  Medium medium;
  medium.sigmaS = reader.numberOrRgb("sigma_s", medium.sigmaS, kAmount);
  medium.sigmaA = reader.numberOrRgb("sigma_a", medium.sigmaA, kAmount);
  medium.g = reader.number("g", medium.g, kAsymmetry);
  reader.finish();
  return medium;
}

Octaves readOctaves(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'octaves'", out);
  Octaves octaves;
  octaves.count = static_cast<int>(reader.integer("count", octaves.count, kOctaveCount));
  octaves.a = reader.number("a", octaves.a, kUnit);
  octaves.b = reader.number("b", octaves.b, kUnit);
  octaves.c = reader.number("c", octaves.c, kUnit);
  reader.finish();
  return octaves;
}

Sun readSun(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'sun'", out);
  Sun sun;
  const glm::dvec3 toLight = vectorOf(reader.vector3("to_light", arrayOf(sun.toLight), kCoordinate));
  if (isZero(toLight))
    out.add(reader.where("to_light"), "'to_light' has no length", "it points from the cloud to the sun");
  else
    sun.toLight = normalized(toLight);
  sun.irradiance = reader.numberOrRgb("irradiance", sun.irradiance, kAmount);
  reader.finish();
  return sun;
}

PointLight readPoint(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'point'", out);
  PointLight point;
  point.position = vectorOf(reader.vector3("position", arrayOf(point.position), kCoordinate));
  point.intensity = reader.numberOrRgb("intensity", point.intensity, kAmount);
  reader.finish();
  return point;
}

void readLight(const yaml::Node& node, std::vector<Light>& lights, Diagnostics& out) {
  if (node.kind != yaml::Kind::map || node.entries.size() != 1) {
    out.add(node.where, "a light must be a map of one key, 'sun' or 'point'",
            "such as: - sun: { to_light: [0, 0, 1] }");
    return;
  }
  yaml::MapReader reader(node, "'lights'", out);
  if (const yaml::NodePtr sun = reader.find("sun")) lights.emplace_back(readSun(*sun, out));
  if (const yaml::NodePtr point = reader.find("point")) lights.emplace_back(readPoint(*point, out));
  reader.finish();
}

std::vector<Light> readLights(const yaml::Node& node, Diagnostics& out) {
  std::vector<Light> lights;
  if (node.kind != yaml::Kind::sequence) {
    out.add(node.where, "'lights' must be a list, found " + yaml::describe(node), "write [] for no light");
    return lights;
  }
  if (node.items.size() > kMostLights)
    out.add(node.items[kMostLights]->where, "at most " + std::to_string(kMostLights) +
                                                " lights are rendered, found " +
                                                std::to_string(node.items.size()));
  for (const yaml::NodePtr& item : node.items) readLight(*item, lights, out);
  return lights;
}

Environment readEnvironment(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'environment'", out);
  Environment environment;
  environment.constant = reader.numberOrRgb("constant", environment.constant, kAmount);
  environment.show = reader.boolean("show", environment.show);
  for (const char* later : {"ramp", "exr"})
    if (reader.find(later))
      out.add(reader.where(later), "an environment by '" + std::string(later) + "' is not built yet",
              "use 'constant'");
  reader.finish();
  return environment;
}

BackdropColours readBackdrop(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'background'", out);
  BackdropColours colours;
  colours.bottom = reader.numberOrRgb("bottom", colours.bottom, kAmount);
  colours.top = reader.numberOrRgb("top", colours.top, kAmount);
  reader.finish();
  return colours;
}

MarchSettings readMarch(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'march'", out);
  MarchSettings march;
  march.stepVoxels = reader.number("step", march.stepVoxels, kStepVoxels);
  march.shadowStepVoxels = reader.number("shadow_step", march.shadowStepVoxels, kStepVoxels);
  march.shadowGrowth = reader.number("shadow_growth", march.shadowGrowth, {1.0, 2.0, false, false});
  reader.finish();
  return march;
}

/// The shortest text that reads back to the same number.
std::string shortest(double value) {
  char text[32];  // the longest double takes 24 characters
  const auto result = std::to_chars(text, text + sizeof text, value);
  return std::string(text, result.ptr);
}

std::string listOf(const std::array<double, 3>& values) {
  return std::string("[") + shortest(values[0]) + ", " + shortest(values[1]) + ", " + shortest(values[2]) +
         "]";
}

std::string listOf(const glm::dvec3& v) { return listOf(arrayOf(v)); }

/// Degrees that readCamera turns into `radians` to the last bit, where such exist; else the nearest.
double degreesOf(double radians) {
  double nearest = radians / kRadiansPerDegree;
  const double low = std::nextafter(nearest, 0.0), high = std::nextafter(nearest, 2.0 * nearest);
  for (const double candidate : {low, high})
    if (candidate * kRadiansPerDegree == radians) nearest = candidate;
  // Of all degrees that give these bits, the one that a person would have typed.
  constexpr double kTypedDigits = 1e10;
  const double typed = std::round(nearest * kTypedDigits) / kTypedDigits;
  return typed * kRadiansPerDegree == radians ? typed : nearest;
}

std::string textOf(const Light& light) {
  if (const Sun* sun = std::get_if<Sun>(&light))
    return "  - sun: { to_light: " + listOf(sun->toLight) + ", irradiance: " + listOf(sun->irradiance) +
           " }\n";
  const PointLight& point = std::get<PointLight>(light);
  return "  - point: { position: " + listOf(point.position) + ", intensity: " + listOf(point.intensity) +
         " }\n";
}

std::string textOf(const std::vector<Light>& lights) {
  if (lights.empty()) return "lights: []\n";
  std::string text =
      "# Sun: irradiance on a plane that faces it, to_light from the cloud to it. Point: intensity per "
      "steradian.\n"
      "lights:\n";
  for (const Light& light : lights) text += textOf(light);
  return text;
}

std::string textOf(const Camera& camera, bool upGiven) {
  return "# Lengths in world units; fov: full vertical angle in degrees.\ncamera: { position: " +
         listOf(camera.position) + ", target: " + listOf(camera.target) +
         (upGiven ? ", up: " + listOf(camera.up) : std::string()) +
         ", fov: " + shortest(degreesOf(camera.fov)) + " }\n";
}

}  // namespace

Scene readScene(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "the scene", out);
  Scene scene;
  if (const auto camera = reader.find("camera")) scene.camera = readCamera(*camera, scene.cameraUpGiven, out);
  if (const auto medium = reader.find("medium")) scene.medium = readMedium(*medium, out);
  if (const auto octaves = reader.find("octaves")) scene.octaves = readOctaves(*octaves, out);
  if (const auto lights = reader.find("lights")) scene.lights = readLights(*lights, out);
  if (const auto environment = reader.find("environment"))
    scene.environment = readEnvironment(*environment, out);
  if (const auto backdrop = reader.find("background")) scene.backdrop = readBackdrop(*backdrop, out);
  const std::string look =
      reader.choice("look", nameOf(scene.look), {nameOf(Look::physical), nameOf(Look::report)});
  scene.look = look == nameOf(Look::report) ? Look::report : Look::physical;
  if (const auto march = reader.find("march")) scene.march = readMarch(*march, out);
  reader.finish();
  return scene;
}

Scene loadScene(const std::string& path) {
  yaml::NodePtr node = yaml::load(path);
  for (const yaml::Entry& entry : node->entries) {
    if (entry.key != "scene") continue;
    const yaml::NodePtr inner = entry.value;
    node = inner;
    break;
  }
  Diagnostics out;
  const Scene scene = readScene(*node, out);
  out.throwIfAny();
  return scene;
}

std::string writeScene(const Scene& scene) {
  std::string text;
  if (scene.camera) text += textOf(*scene.camera, scene.cameraUpGiven);
  if (scene.medium)
    text += "# Per unit density per world unit; g: Henyey-Greenstein asymmetry.\nmedium: { sigma_s: " +
            listOf(scene.medium->sigmaS) + ", sigma_a: " + listOf(scene.medium->sigmaA) +
            ", g: " + shortest(scene.medium->g) + " }\n";
  text += "# Orders of scattering beyond the first, and their factors.\noctaves: { count: " +
          std::to_string(scene.octaves.count) + ", a: " + shortest(scene.octaves.a) +
          ", b: " + shortest(scene.octaves.b) + ", c: " + shortest(scene.octaves.c) + " }\n";
  text += textOf(scene.lights);
  text +=
      "# Uniform radiance from all around.\nenvironment: { constant: " + listOf(scene.environment.constant) +
      ", show: " + (scene.environment.show ? "true" : "false") + " }\n";
  text += "# Behind window and PNG only, linear Rec.709: no light.\nbackground: { bottom: " +
          listOf(scene.backdrop.bottom) + ", top: " + listOf(scene.backdrop.top) + " }\n";
  text += "look: " + nameOf(scene.look) + "\n";
  text +=
      "# Steps in voxels; each step towards a light is shadow_growth times the one before.\nmarch: { step: " +
      shortest(scene.march.stepVoxels) + ", shadow_step: " + shortest(scene.march.shadowStepVoxels) +
      ", shadow_growth: " + shortest(scene.march.shadowGrowth) + " }\n";
  return text;
}

std::string nameOf(Look look) { return look == Look::report ? "report" : "physical"; }

}  // namespace nephele
