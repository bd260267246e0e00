// Scenes from YAML. Depends on base alone. Keys, defaults and units: scene/scene.h and DESIGN.md, section 1.
#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>

#include "base/error.h"
#include "scene/degrees.h"

namespace nephele {
namespace {

// Products of two such numbers stay finite in the renderer's single precision (3.4e38).
constexpr double kLargest = 1e15;
constexpr Range kCoordinate{-kLargest, kLargest};
constexpr Range kAmount{0.0, kLargest};
constexpr Range kOpenHalfTurn{0.0, 180.0, true, true};
constexpr Range kAsymmetry{-1.0, 1.0, true, true};
// Below, a ray takes more than a hundred steps a voxel; above, it leaps over whole bricks.
constexpr Range kStepVoxels{0.01, 100.0};
constexpr Range kOctaveCount{0.0, kMostOctaveCount};
constexpr Range kLobe{0.0, 1.0, false, true};
constexpr Range kPowderStrength{0.0,
                                100.0};  // beyond it, a hundredth of the densest voxel's density is dense
constexpr Range kTurn{-360.0, 360.0};

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

/// Reads `on: true | false | auto` of a term's map; a map without it switches the term on.
Switch readSwitch(yaml::MapReader& reader, Diagnostics& out) {
  const yaml::NodePtr node = reader.find("on");
  if (!node) return true;
  if (node->kind == yaml::Kind::scalar && node->scalar == "auto") return std::nullopt;
  if (node->kind == yaml::Kind::scalar && (node->scalar == "true" || node->scalar == "false"))
    return node->scalar == "true";
  out.add(node->where, "'on' must be true, false or auto, found " + yaml::describe(*node),
          "auto leaves it to the look");
  return std::nullopt;
}

SilverLining readPhase(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'phase'", out);
  SilverLining silver;
  if (const yaml::NodePtr inner = reader.find("silver_lining")) {
    yaml::MapReader lobes(*inner, "'silver_lining'", out);
    silver.on = readSwitch(lobes, out);
    silver.inS = lobes.number("in_s", silver.inS, kLobe);
    silver.outS = lobes.number("out_s", silver.outS, kLobe);
    silver.blend = lobes.number("blend", silver.blend, kUnit);
    lobes.finish();
  }
  reader.finish();
  return silver;
}

Powder readPowder(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'powder'", out);
  Powder powder;
  powder.on = readSwitch(reader, out);
  powder.oSa = reader.number("o_sa", powder.oSa, kPowderStrength);
  reader.finish();
  return powder;
}

Octaves readOctaves(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'octaves'", out);
  Octaves octaves;
  const yaml::NodePtr count = reader.find("count");
  if (count && !(count->kind == yaml::Kind::scalar && count->scalar == "auto"))
    if (const auto read = yaml::readInteger(*count, "'count'", kOctaveCount, out))
      octaves.count = static_cast<int>(*read);
  octaves.factorsGiven = reader.find("a") || reader.find("b") || reader.find("c") || reader.find("d");
  octaves.a = reader.number("a", octaves.a, kUnit);
  octaves.b = reader.number("b", octaves.b, kUnit);
  octaves.c = reader.number("c", octaves.c, kUnit);
  octaves.d = reader.number("d", octaves.d, kUnit);
  reader.finish();
  return octaves;
}

Emission readEmission(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'emission'", out);
  Emission emission;
  emission.on = readSwitch(reader, out);
  emission.scale = reader.number("scale", emission.scale, kAmount);
  emission.temperatureScale = reader.number("temperature_scale", emission.temperatureScale, kAmount);
  emission.grid = reader.text("grid", emission.grid);
  reader.finish();
  if (emission.grid.empty()) out.add(reader.where("grid"), "'grid' names no grid");
  return emission;
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

SkyRamp readRamp(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'ramp'", out);
  SkyRamp ramp;
  ramp.ground = reader.numberOrRgb("ground", ramp.ground, kAmount);
  ramp.horizon = reader.numberOrRgb("horizon", ramp.horizon, kAmount);
  ramp.zenith = reader.numberOrRgb("zenith", ramp.zenith, kAmount);
  ramp.cloudiness = reader.number("cloudiness", ramp.cloudiness, kUnit);
  ramp.intensity = reader.number("intensity", ramp.intensity, kAmount);
  reader.finish();
  return ramp;
}

/// `path` as a file that lies in the folder of `where` gives it; absolute ones stay.
std::string besideFile(const std::string& path, const SourceLocation& where) {
  return (std::filesystem::path(where.file).parent_path() / path).lexically_normal().string();
}

/// exr: PATH, or exr: { path: PATH, rotation: DEGREES, intensity: FACTOR }.
LatLong readExrEnvironment(const yaml::Node& node, Diagnostics& out) {
  LatLong exr;
  if (node.kind == yaml::Kind::scalar) {
    exr.path = node.scalar;
  } else {
    yaml::MapReader reader(node, "'exr'", out);
    exr.path = reader.text("path", "");
    exr.rotation = reader.number("rotation", 0.0, kTurn) * kRadiansPerDegree;
    exr.intensity = reader.number("intensity", exr.intensity, kAmount);
    reader.finish();
  }
  if (exr.path.empty())
    out.add(node.where, "'exr' names no file", "write exr: sky.exr, or exr: { path: sky.exr, rotation: 90 }");
  else
    exr.path = besideFile(exr.path, node.where);
  return exr;
}

Environment readEnvironment(const yaml::Node& node, Diagnostics& out) {
  using Kind = Environment::Kind;
  yaml::MapReader reader(node, "'environment'", out);
  Environment environment;
  std::string given;  // the first kind found
  const auto take = [&](Kind kind) {
    const std::string name = nameOf(kind);
    if (!reader.has(name)) return reader.find(name);
    if (!given.empty())
      out.add(reader.where(name), "an environment is of one kind, and '" + given + "' is given already");
    given = name;
    environment.kind = kind;
    return reader.find(name);
  };
  if (take(Kind::constant))
    environment.constant = reader.numberOrRgb("constant", environment.constant, kAmount);
  if (const yaml::NodePtr ramp = take(Kind::ramp)) environment.ramp = readRamp(*ramp, out);
  if (const yaml::NodePtr exr = take(Kind::exr)) environment.exr = readExrEnvironment(*exr, out);
  environment.show = reader.boolean("show", environment.show);
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

/// A number, or `auto` for nothing.
std::optional<double> readOpen(yaml::MapReader& reader, const std::string& key, const Range& range) {
  const yaml::NodePtr node = reader.find(key);
  if (!node || (node->kind == yaml::Kind::scalar && node->scalar == "auto")) return std::nullopt;
  return reader.number(key, 0.0, range);
}

StageThing readThing(const yaml::Node& node, const char* name, const char* size, Diagnostics& out) {
  constexpr Range kSize{0.0, kLargest, true, false};
  yaml::MapReader reader(node, name, out);
  StageThing thing;
  thing.on = reader.boolean("on", true);
  const yaml::NodePtr center = reader.find("center");
  if (center && !(center->kind == yaml::Kind::scalar && center->scalar == "auto"))
    thing.center = vectorOf(reader.vector3("center", {0.0, 0.0, 0.0}, kCoordinate));
  thing.size = readOpen(reader, size, kSize);
  reader.finish();
  return thing;
}

Stage readStage(const yaml::Node& node, Diagnostics& out) {
  // Beyond it a penumbra is narrower than a pixel.
  constexpr Range kEdge{0.0, kLargest, true, false}, kPenumbra{0.0, 1000.0, false, false};
  yaml::MapReader reader(node, "'stage'", out);
  Stage stage;
  stage.on = reader.boolean("on", true);
  stage.floor = reader.boolean("floor", stage.floor);
  stage.height = readOpen(reader, "height", kCoordinate);
  stage.checker = readOpen(reader, "checker", kEdge);
  if (const auto inner = reader.find("chrome_ball"))
    stage.chrome = readThing(*inner, "'chrome_ball'", "radius", out);
  if (const auto inner = reader.find("grey_ball"))
    stage.grey = readThing(*inner, "'grey_ball'", "radius", out);
  if (const auto inner = reader.find("chrome_cube"))
    stage.cube = readThing(*inner, "'chrome_cube'", "edge", out);
  stage.highlights = reader.boolean("highlights", stage.highlights);
  stage.penumbra = reader.number("penumbra", stage.penumbra, kPenumbra);
  reader.finish();
  return stage;
}

// Between samples of the light cache: a voxel at least, at most one of its blocks; so far too it is marched
// before.
constexpr Range kCacheVoxels{1.0, 16.0, false, false}, kNear{0.0, 16.0, false, false};
constexpr Range kPixels{0.0, 64.0, false, false};

MarchSettings readMarch(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "'march'", out);
  MarchSettings march;
  march.stepVoxels = reader.number("step", march.stepVoxels, kStepVoxels);
  march.shadowStepVoxels = reader.number("shadow_step", march.shadowStepVoxels, kStepVoxels);
  march.shadowGrowth = reader.number("shadow_growth", march.shadowGrowth, {1.0, 2.0, false, false});
  march.adaptive = reader.boolean("adaptive", march.adaptive);
  march.lightCache = reader.boolean("light_cache", march.lightCache);
  march.cacheVoxels = reader.number("cache", march.cacheVoxels, kCacheVoxels);
  march.skyCacheVoxels = reader.number("sky_cache", march.skyCacheVoxels, kCacheVoxels);
  march.cacheNearVoxels = reader.number("cache_near", march.cacheNearVoxels, kNear);
  march.cacheDepth = reader.number("cache_depth", march.cacheDepth, {0.0, 1e30, false, false});
  march.giveUp = reader.number("give_up", march.giveUp, {0.0, 0.1, true, false});
  march.cacheNearSteps = static_cast<int>(reader.integer("cache_near_steps", march.cacheNearSteps, kNear));
  march.checkSkips = reader.boolean("check_skips", march.checkSkips);
  march.levelPixels = reader.number("level_pixels", march.levelPixels, kPixels);
  march.stepPixels = reader.number("step_pixels", march.stepPixels, kPixels);
  std::vector<std::string> names;
  for (const AtlasPrecision precision : kAtlasPrecisions) names.push_back(nameOf(precision));
  const std::string name = reader.choice("precision", nameOf(march.precision), names);
  for (const AtlasPrecision precision : kAtlasPrecisions)
    if (name == nameOf(precision)) march.precision = precision;
  reader.finish();
  return march;
}

}  // namespace

Emission::Emission() : grid("temperature") {}

Scene readScene(const yaml::Node& node, Diagnostics& out) {
  yaml::MapReader reader(node, "the scene", out);
  Scene scene;
  if (const auto camera = reader.find("camera")) scene.camera = readCamera(*camera, scene.cameraUpGiven, out);
  if (const auto medium = reader.find("medium")) scene.medium = readMedium(*medium, out);
  if (const auto phase = reader.find("phase")) scene.silverLining = readPhase(*phase, out);
  if (const auto powder = reader.find("powder")) scene.powder = readPowder(*powder, out);
  const std::string transmittance =
      reader.choice("light_transmittance", nameOf(scene.lightTransmittance),
                    {nameOf(LightTransmittance::marched), nameOf(LightTransmittance::chord)});
  scene.lightTransmittance = transmittance == nameOf(LightTransmittance::chord) ? LightTransmittance::chord
                                                                                : LightTransmittance::marched;
  if (const auto emission = reader.find("emission")) scene.emission = readEmission(*emission, out);
  if (const auto octaves = reader.find("octaves")) scene.octaves = readOctaves(*octaves, out);
  if (const auto lights = reader.find("lights")) scene.lights = readLights(*lights, out);
  if (const auto environment = reader.find("environment"))
    scene.environment = readEnvironment(*environment, out);
  if (const auto backdrop = reader.find("background")) scene.backdrop = readBackdrop(*backdrop, out);
  if (const auto stage = reader.find("stage")) scene.stage = readStage(*stage, out);
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

}  // namespace nephele
