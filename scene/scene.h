// What is lit and from where: camera, medium, octaves, lights, environment, look, march; and YAML both ways.
// Depends on base alone. Lengths in world units; angles in radians here, in degrees in files. Names and
// defaults: DESIGN.md, section 1.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/yaml.h"

namespace nephele {

using Rgb = std::array<double, 3>;

/// Where the picture is taken from. `fov` is the full vertical angle, in (0, π).
struct Camera {
  glm::dvec3 position{3.0, 1.0, 2.0};
  glm::dvec3 target{0.0};
  glm::dvec3 up{0.0, 0.0, 1.0};
  double fov = 0.6108652381980153;  // 35 degrees
};

/// Scattering and absorption per unit density per world unit, each ≥ 0, and the Henyey–Greenstein asymmetry,
/// −1 < g < 1.
struct Medium {
  Rgb sigmaS{8.0, 8.0, 8.0};
  Rgb sigmaA{0.0, 0.0, 0.0};
  double g = 0.6;
};

/// Orders of scattering beyond the first: order m uses a^m σ_t towards the light, b^m σ_s, c^m g. Factors in
/// [0, 1].
struct Octaves {
  int count = 0;
  double a = 0.5, b = 0.5, c = 0.5;
};

/// Parallel light; irradiance on a plane that faces it. toLight is of unit length (files may give any length
/// > 0).
struct Sun {
  glm::dvec3 toLight{0.30304576336566325, 0.80812203564176865, 0.50507627227610541};
  Rgb irradiance{3.1416, 3.1416, 3.1416};
};

/// A point of intensity I per steradian: irradiance I/d² at distance d.
struct PointLight {
  glm::dvec3 position{0.0};
  Rgb intensity{1.0, 1.0, 1.0};
};

using Light = std::variant<Sun, PointLight>;

/// Lights that a scene may hold: as many as the march's parameter block (asserted in
/// preview/gpu/camera_rays.cpp).
inline constexpr size_t kMostLights = 8;

/// Uniform radiance from all around; shown behind the medium only where asked.
struct Environment {
  Rgb constant{0.0, 0.0, 0.0};
  bool show = false;
};

/// Colours behind PNG and window for people to look at: never light, never in an EXR. Linear Rec.709.
struct BackdropColours {
  Rgb bottom{0.42, 0.55, 0.72};
  Rgb top{0.10, 0.22, 0.48};
};

enum class Look { physical, report };

/// Steps in voxels of the level being read.
struct MarchSettings {
  double stepVoxels = 0.5;
  double shadowStepVoxels = 1.0;  // the first step towards a light
  double shadowGrowth = 1.15;     // of each such step over the one before, from 1 (none) to 2
};

/// Keys that a scene left out are nullopt where the program chooses instead (camera: frame the active box;
/// medium: the file's metadata, else auto-exposure), and hold their default elsewhere.
struct Scene {
  std::optional<Camera> camera;
  bool cameraUpGiven = false;
  std::optional<Medium> medium;
  Octaves octaves;
  std::vector<Light> lights{Sun{}};
  Environment environment;
  BackdropColours backdrop;
  Look look = Look::physical;
  MarchSettings march;
};

/// Reads a scene's map. Adds every error it finds to `out`; the result is usable only where none was added.
Scene readScene(const yaml::Node& node, Diagnostics& out);

/// Reads a scene file, or the `scene:` of any file that has one at top level. Throws InputError with all
/// errors.
Scene loadScene(const std::string& path);

/// The scene as YAML that readScene reads back to the same values (nullopt keys are left out), with comments
/// on units.
std::string writeScene(const Scene& scene);

/// Names of looks as in files: "physical", "report".
std::string nameOf(Look look);

}  // namespace nephele
