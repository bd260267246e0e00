// What is lit and from where: camera, medium, the terms of the light, lights, environment, look, march; and
// YAML both ways. What is on once the look has decided: scene/light_model.h.
// Depends on base alone. Lengths in world units; angles in radians here, in degrees in files. Structs are
// equal where all members are. Names and defaults: DESIGN.md, section 1.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/yaml.h"
#include "scene/stage.h"

namespace nephele {

using Rgb = std::array<double, 3>;

/// Where the picture is taken from. `fov` is the full vertical angle, in (0, π).
struct Camera {
  glm::dvec3 position{3.0, 1.0, 2.0};
  glm::dvec3 target{0.0};
  glm::dvec3 up{0.0, 0.0, 1.0};
  double fov = 0.6108652381980153;  // 35 degrees
  bool operator==(const Camera&) const = default;
};

/// Scattering and absorption per unit density per world unit, each ≥ 0, and the Henyey–Greenstein asymmetry,
/// −1 < g < 1.
struct Medium {
  Rgb sigmaS{8.0, 8.0, 8.0};
  Rgb sigmaA{0.0, 0.0, 0.0};
  double g = 0.6;
  bool operator==(const Medium&) const = default;
};

/// A term of the light is on, off, or (nullopt, `auto` in files) as the look decides. In a file, a term's map
/// without `on` switches it on.
using Switch = std::optional<bool>;

/// Silver lining plus: mix(HG(inS), HG(−outS), blend) in the place of HG(g). Of one kind with the medium's
/// phase function: it scatters as much. Look: on in `report`.
struct SilverLining {
  Switch on;
  double inS = 0.8;     // asymmetry of the lobe towards the light, in [0, 1)
  double outS = 0.4;    // of the lobe away from it, in [0, 1)
  double blend = 0.45;  // share of the second lobe, in [0, 1]
  bool operator==(const SilverLining&) const = default;
};

/// Ambient out-scattering: darkens in-scattering where the medium is dense, less low in the cloud. Not
/// physical. Look: on in `report`.
struct Powder {
  Switch on;
  double oSa = 0.5;  // strength, in [0, 100]; the product with density is cut at 1
  bool operator==(const Powder&) const = default;
};

/// Light from sample to light source: by marching, or by the chord to the exit of the ellipsoid inscribed in
/// the active box at the mean active density (cheap; wrong inside uneven clouds).
enum class LightTransmittance { marched, chord };

inline constexpr int kMostOctaveCount = 16;

/// Orders of scattering beyond the first, kMostOctaveCount at most: order m uses a^m σ_t towards the light,
/// (b (1 − d · openness))^m σ_s, c^m g, openness being the share of light that would leave the medium
/// unscattered if it set out evenly to all sides. Factors in [0, 1]. Look: none in `physical`, kReportOctaves
/// in `report`.
struct Octaves {
  std::optional<int> count;  // nullopt (`auto` in files): as the look decides
  double a = 0.5, b = 0.5, c = 0.5, d = 0.0;
  bool factorsGiven = false;  // else a file's fitted ones are taken, where it holds some (preview/resolve.h)
  bool operator==(const Octaves&) const = default;
};

/// Thermal emission σ_a ρ · scale · B(T · temperatureScale), T from the grid of that name in the same file.
/// nullopt (`auto`): on in both looks where the file has the grid. On without the grid is the user's error.
struct Emission {
  Emission();  // not inline: g++ 12 takes the text of a temporary scene for uninitialised
  Switch on;
  double scale = 1.0;             // ≥ 0; B has luminance 1 at 2000 K (scene/blackbody.h)
  double temperatureScale = 1.0;  // kelvin per unit of the grid, ≥ 0
  std::string grid;               // "temperature"
  bool operator==(const Emission&) const = default;
};

/// Parallel light; irradiance on a plane that faces it. toLight is of unit length (files may give any length
/// > 0).
struct Sun {
  glm::dvec3 toLight{0.30304576336566325, 0.80812203564176865, 0.50507627227610541};
  Rgb irradiance{3.1416, 3.1416, 3.1416};
  bool operator==(const Sun&) const = default;
};

/// A point of intensity I per steradian: irradiance I/d² at distance d.
struct PointLight {
  glm::dvec3 position{0.0};
  Rgb intensity{1.0, 1.0, 1.0};
  bool operator==(const PointLight&) const = default;
};

using Light = std::variant<Sun, PointLight>;

/// Lights that a scene may hold: as many as the march's parameter block (asserted in
/// preview/gpu/camera_rays.cpp).
inline constexpr size_t kMostLights = 8;

/// Radiance over elevation alone [Neyret]: ground below, horizon, zenith; the shape is in
/// shaders/shared/environment.glsl. Colours linear Rec.709, each ≥ 0.
struct SkyRamp {
  Rgb ground{0.26, 0.19, 0.13};
  Rgb horizon{0.85, 0.92, 1.0};
  Rgb zenith{0.10, 0.24, 0.60};
  double cloudiness = 0.2;  // in [0, 1]: dims the ground's reflection and raises the horizon's white
  double intensity = 1.0;   // factor of all radiance, ≥ 0
  bool operator==(const SkyRamp&) const = default;
};

/// A lat-long EXR: top is up; the centre column looks along −Z where Y is up, +Y where Z is up.
struct LatLong {
  std::string path;       // as opened: files give it relative to themselves
  double rotation = 0.0;  // radians about up, counter-clockwise seen from above: the centre column turns left
  double intensity = 1.0;  // factor of all radiance, ≥ 0
  bool operator==(const LatLong&) const = default;
};

/// Radiance from all around, of one kind; the others' values are kept for the panel alone. Shown behind the
/// medium in every picture where asked; in the `report` look behind PNG and window anyhow.
struct Environment {
  enum class Kind { constant, ramp, exr };
  Kind kind = Kind::constant;
  Rgb constant{0.0, 0.0, 0.0};
  SkyRamp ramp;
  LatLong exr;
  bool show = false;
  bool operator==(const Environment&) const = default;
};

/// Colours behind PNG and window for people to look at, in place of an environment that is not asked to show:
/// never light, never in an EXR. Linear Rec.709.
struct BackdropColours {
  Rgb bottom{0.42, 0.55, 0.72};
  Rgb top{0.10, 0.22, 0.48};
  bool operator==(const BackdropColours&) const = default;
};

enum class Look { physical, report };

/// How densities are kept for the march: `automatic` (`auto` in files) takes the smallest that is as good
/// (volume/brick_texel.h).
enum class AtlasPrecision { automatic, r8, r16f, r32f };
inline constexpr AtlasPrecision kAtlasPrecisions[] = {AtlasPrecision::automatic, AtlasPrecision::r8,
                                                      AtlasPrecision::r16f, AtlasPrecision::r32f};

/// Steps and the light cache's spacings in voxels of the level being read; those of the view and of the cache
/// in what covers stepPixels pixels, where that is longer, and the cache's farther where voxels are thin.
struct MarchSettings {
  double stepVoxels = 0.5;
  double shadowStepVoxels = 1.0;  // the first step towards a light
  double shadowGrowth = 1.1;      // of each such step over the one before, from 1 (none) to 2
  bool adaptive = true;           // steps grow where the medium is thin; else all are stepVoxels
  bool lightCache = true;         // light from a coarse volume; else marched for at every point
  double cacheVoxels = 2.0;       // between samples of that volume, from 1 to 16; 16/n is reached
  double skyCacheVoxels = 4.0;    // the same for what the sky scatters
  double cacheNearVoxels = 8.0;   // marched towards a light before the volume is asked, from 0 to 16
  int cacheNearSteps = 4;         // in so many steps, from 0 to 16
  double cacheDepth = 0.05;       // optical depth of a voxel of mean density above which light is marched
                                  // for all the same, since the volume is then too coarse; >= 0
  double giveUp = 1e-4;           // transmittance below which a ray ends, in (0, 0.1]
  // No key of files; moving pictures set it: light comes from that volume however thick a voxel is.
  bool alwaysCached = false;
  bool checkSkips = false;  // reads what was skipped as well, and counts what that would have changed
  AtlasPrecision precision = AtlasPrecision::automatic;
  double levelPixels = 0.25;  // voxels that cover at most so many come from coarser levels; 0: none do
  double stepPixels = 1.0;    // steps take voxels to cover at least so many, the view's where that takes
                              // little of it; 0: whatever they cover
  bool operator==(const MarchSettings&) const = default;
};

/// Keys that a scene left out are nullopt where the program chooses instead (camera: frame the active box;
/// medium: the file's metadata, else auto-exposure), and hold their default elsewhere.
struct Scene {
  std::optional<Camera> camera;
  bool cameraUpGiven = false;
  std::optional<Medium> medium;
  SilverLining silverLining;
  Powder powder;
  LightTransmittance lightTransmittance = LightTransmittance::marched;
  Octaves octaves;
  Emission emission;
  std::vector<Light> lights{Sun{}};
  Environment environment;
  std::optional<BackdropColours> backdrop;  // nullopt: the environment in `report`, the default in `physical`
  Stage stage;
  Look look = Look::physical;
  MarchSettings march;
  // No key of files; presets set it. Directions of lights are for Z up, and resolveScene (preview/resolve.h)
  // turns them where the file's up is Y.
  bool lightsFollowUp = false;
  bool operator==(const Scene&) const = default;
};

/// Reads a scene's map. Paths in it are relative to the file that holds them. Adds every error it finds to
/// `out`; the result is usable only where none was added.
Scene readScene(const yaml::Node& node, Diagnostics& out);

/// Reads a scene file, or the `scene:` of any file that has one at top level. Throws InputError with all
/// errors.
Scene loadScene(const std::string& path);

/// The scene as YAML that readScene reads back to the same values (nullopt keys are left out), with comments
/// on units. Paths are written relative to `folder` where one is given, else as they are.
std::string writeScene(const Scene& scene, const std::string& folder = {});

/// Names as in files: "physical", "report"; "marched", "chord"; "constant", "ramp", "exr".
std::string nameOf(Look look);
std::string nameOf(LightTransmittance transmittance);
std::string nameOf(Environment::Kind kind);
/// "auto", "r8", "r16f", "r32f".
std::string nameOf(AtlasPrecision precision);

}  // namespace nephele
