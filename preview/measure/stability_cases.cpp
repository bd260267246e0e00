// Cases by formulas. Depends on what its header names.
#include "preview/measure/stability_cases.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

namespace nephele {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::ivec3;

constexpr double kPi = std::numbers::pi;
constexpr int kRadius = 14;  // voxels of the ball
constexpr double kVoxel = 1.0 / kRadius;
constexpr double kThickness = 4.0;  // optical depths of the ball, where nothing else is asked
// Mean density along the ball's diameters times their length, about: so that σ = depth/kColumn.
constexpr double kColumn = 0.9;

std::string textOf(double value) {
  char text[24];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

dmat4 placed(double voxel, const dvec3& offset = dvec3(0.0)) {
  dmat4 m(voxel);
  m[3] = glm::dvec4(offset, 1.0);
  return m;
}

/// Samples at index positions −half … half along each axis.
template <class Density>
BrickVolume cube(int half, const dmat4& worldFromIndex, Density&& density) {
  const int side = 2 * half + 1;
  std::vector<float> values;
  values.reserve(static_cast<size_t>(side) * static_cast<size_t>(side) * static_cast<size_t>(side));
  for (int z = -half; z <= half; ++z)
    for (int y = -half; y <= half; ++y)
      for (int x = -half; x <= half; ++x) values.push_back(static_cast<float>(density(dvec3(x, y, z))));
  return bricksFromDense(values, ivec3(side), ivec3(-half), worldFromIndex);
}

/// Waves cut off at 0 inside a ball; `phase` moves them.
double bumpyBall(const dvec3& p, double phase) {
  const double ball = 1.0 - glm::length(p) / kRadius;
  const double waves =
      std::sin(0.6 * p.x + 1.1 + phase) * std::sin(0.5 * p.y + 0.4) * std::sin(0.7 * p.z + 2.0 - phase);
  return ball <= 0.0 ? 0.0 : std::clamp(1.5 * ball + 0.5 * waves, 0.0, 1.0);
}

BrickVolume ballAt(const dmat4& worldFromIndex, double phase = 0.0) {
  return cube(kRadius + 1, worldFromIndex, [phase](const dvec3& p) { return bumpyBall(p, phase); });
}

/// The middle of the table.
StabilityCase middle(const std::string& axis, const std::string& value) {
  StabilityCase made{axis, value, [] { return ballAt(placed(kVoxel)); }, {}};
  made.view.camera.position = {0.7, -4.0, 0.9};
  made.view.camera.fov = 0.6;  // radians: the ball fills most of the picture
  const double sigma = kThickness / kColumn;
  made.view.medium = {{sigma, sigma, sigma}, {0.0, 0.0, 0.0}, 0.5};
  made.view.scene.lights = {Sun{glm::normalize(dvec3(-0.8, -0.3, 0.5)), {3.0, 3.0, 3.0}}};
  return made;
}

void setExtinction(StabilityCase& made, double sigma, double albedo) {
  const double s = sigma * albedo, a = sigma - s;
  made.view.medium.sigmaS = {s, s, s};
  made.view.medium.sigmaA = {a, a, a};
}

using Cases = std::vector<StabilityCase>;

/// One case a value; `change` makes it of the middle.
template <class Change>
void axis(Cases& cases, const std::string& name, const std::vector<double>& values, Change&& change) {
  for (const double value : values) {
    cases.push_back(middle(name, textOf(value)));
    change(cases.back(), value);
  }
}

void addMedia(Cases& cases) {
  axis(cases, "optical depth", {1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4},
       [](StabilityCase& c, double depth) { setExtinction(c, depth / kColumn, 1.0); });
  axis(cases, "g", {-0.999, -0.99, -0.9, -0.5, 0.0, 0.5, 0.9, 0.99, 0.999},
       [](StabilityCase& c, double g) { c.view.medium.g = g; });
  axis(cases, "albedo", {0.0, 0.01, 0.5, 0.9, 0.99, 1.0},
       [](StabilityCase& c, double albedo) { setExtinction(c, kThickness / kColumn, albedo); });
  axis(cases, "step, voxels", {0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0},
       [](StabilityCase& c, double step) { c.view.scene.march.stepVoxels = step; });
}

/// A sheet across z, one voxel thick, turned about x by `tilt` and of `depth` optical depths straight
/// through.
void makeSheet(StabilityCase& c, double tilt, double depth) {
  const dvec3 normal(0.0, std::sin(tilt), std::cos(tilt));
  c.volume = [normal] {
    return cube(kRadius, placed(kVoxel), [&](const dvec3& p) {
      const bool inside = glm::length(p) < kRadius - 1;
      return inside ? std::max(0.0, 1.0 - std::abs(glm::dot(p, normal))) : 0.0;
    });
  };
  setExtinction(c, depth / kVoxel, 1.0);
  c.view.camera.position = {0.4, -0.8, -4.0};
  c.view.camera.up = {0.0, 1.0, 0.0};
}

void addGrids(Cases& cases) {
  constexpr double kSheetDepth = 1.0;
  axis(cases, "sheet of a voxel, tilt in degrees", {0.0, 5.0, 15.0, 30.0, 45.0, 60.0, 85.0},
       [](StabilityCase& c, double tilt) { makeSheet(c, tilt * kPi / 180.0, kSheetDepth); });
  constexpr double kSomeTilt = 0.4;
  axis(cases, "sheet of a voxel, optical depth", {0.01, 0.1, 1.0, 10.0, 100.0, 1e3},
       [](StabilityCase& c, double depth) { makeSheet(c, kSomeTilt, depth); });
  axis(cases, "sheet of a voxel, step in voxels", {0.25, 0.5, 1.0, 2.0, 4.0, 8.0},
       [](StabilityCase& c, double step) {
         makeSheet(c, kSomeTilt, 1.0);
         c.view.scene.march.stepVoxels = step;
       });
  axis(cases, "checkerboard, optical depth of a voxel", {0.01, 0.1, 1.0, 10.0, 100.0},
       [](StabilityCase& c, double depth) {
         c.volume = [] {
           return cube(kRadius / 2, placed(2.0 * kVoxel), [](const dvec3& p) {
             return (static_cast<int>(p.x + p.y + p.z) & 1) == 0 ? 1.0 : 0.0;
           });
         };
         setExtinction(c, depth / (2.0 * kVoxel), 1.0);
       });
  axis(cases, "one voxel of this density beside 0", {1.0, 1e2, 1e4, 1e6},
       [](StabilityCase& c, double density) {
         c.volume = [density] {
           return cube(kRadius, placed(kVoxel), [density](const dvec3& p) {
             return p == dvec3(1.0, 0.0, 0.0) ? density : 0.05 * bumpyBall(p, 0.0);
           });
         };
         constexpr double kOpaque = 100.0;  // denser, the reference looks a million times at each ray
         setExtinction(c, std::min(kThickness / kColumn, kOpaque / (density * kVoxel)), 1.0);
       });
  struct Named {
    const char* name;
    std::function<BrickVolume()> volume;
  };
  const Named grids[] = {
      {"empty", [] { return cube(2, placed(kVoxel), [](const dvec3&) { return 0.0; }); }},
      {"one voxel", [] { return cube(0, placed(2.0), [](const dvec3&) { return 1.0; }); }},
      {"full", [] { return cube(kRadius, placed(kVoxel), [](const dvec3&) { return 1.0; }); }},
      {"denormal", [] { return cube(kRadius, placed(kVoxel), [](const dvec3&) { return 1e-40; }); }}};
  for (const Named& grid : grids) {
    cases.push_back(middle("grid", grid.name));
    cases.back().volume = grid.volume;
  }
}

void look(StabilityCase& c, const dvec3& from, const dvec3& towards) {
  c.view.camera.position = from;
  c.view.camera.target = from + towards;
  const bool along = std::abs(towards.z) > 0.9 * glm::length(towards);
  c.view.camera.up = along ? dvec3(0.0, 1.0, 0.0) : dvec3(0.0, 0.0, 1.0);
}

void addCameras(Cases& cases) {
  // The medium's support reaches from −kEdge to kEdge; see bricksFromDense and VDB cells.
  constexpr double kEdge = (kRadius + 0.0) * kVoxel;
  const std::tuple<const char*, dvec3, dvec3> places[] = {
      {"on a face", {0.1, -kEdge, 0.05}, {0.0, 1.0, 0.0}},
      {"on an edge", {-kEdge, -kEdge, 0.0}, {1.0, 1.0, 0.1}},
      {"on a corner", {-kEdge, -kEdge, -kEdge}, {1.0, 1.0, 1.0}},
      {"inside", {0.13, 0.21, -0.17}, {0.3, 1.0, 0.2}},
      {"on a sample", {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}},
      {"on a brick's corner", {-8.0 * kVoxel, 0.0, 0.0}, {1.0, 0.0, 0.0}}};
  for (const auto& [name, from, towards] : places) {
    cases.push_back(middle("camera", name));
    look(cases.back(), from, towards);
  }
  constexpr double kFar = 4.0;
  const double tiny = std::numeric_limits<double>::denorm_min(), small = 1e-310;
  const std::tuple<const char*, dvec3> directions[] = {{"+x", {1.0, 0.0, 0.0}},
                                                       {"-y", {0.0, -1.0, 0.0}},
                                                       {"+z", {0.0, 0.0, 1.0}},
                                                       {"-0", {-0.0, 1.0, -0.0}},
                                                       {"denormal", {tiny, 1.0, -small}},
                                                       {"diagonal", {1.0, 1.0, 1.0}},
                                                       {"1e-8 aslant", {1.0, 1e-8, -1e-8}}};
  for (const auto& [name, towards] : directions) {
    cases.push_back(middle("direction", name));
    look(cases.back(), -kFar * glm::normalize(towards), towards);
  }
  // Along a face and along an edge of the support: the middle ray lies in it.
  cases.push_back(middle("direction", "in a face"));
  look(cases.back(), {0.0, -kFar, kEdge}, {0.0, 1.0, 0.0});
  cases.push_back(middle("direction", "in an edge"));
  look(cases.back(), {kEdge, -kFar, kEdge}, {0.0, 1.0, 0.0});
}

void addWorlds(Cases& cases) {
  axis(cases, "world's scale", {1e-6, 1e-3, 1.0, 1e3, 1e6}, [](StabilityCase& c, double scale) {
    c.volume = [scale] { return ballAt(placed(scale * kVoxel)); };
    c.view.camera.position *= scale;
    c.view.camera.target *= scale;
    setExtinction(c, kThickness / kColumn / scale, 1.0);
  });
  axis(cases, "distance from the origin", {0.0, 1e3, 1e5, 1e7}, [](StabilityCase& c, double distance) {
    const dvec3 offset(distance, -distance, 0.5 * distance);
    c.volume = [offset] { return ballAt(placed(kVoxel, offset)); };
    c.view.camera.position += offset;
    c.view.camera.target += offset;
  });
  axis(cases, "camera's distance", {4.0, 1e2, 1e4, 1e6}, [](StabilityCase& c, double distance) {
    c.view.camera.fov = std::min(c.view.camera.fov, 2.4 / distance);
    c.view.camera.position = distance * glm::normalize(c.view.camera.position);
  });
}

void addLights(Cases& cases) {
  const std::tuple<const char*, dvec3> suns[] = {{"horizon", {1.0, 0.0, 0.0}},
                                                 {"up", {0.0, 0.0, 1.0}},
                                                 {"down", {0.0, 0.0, -1.0}},
                                                 {"behind", {-0.17, 1.0, -0.22}},
                                                 {"at the camera", {0.17, -1.0, 0.22}},
                                                 {"-0 and denormal", {1.0, -0.0, 1e-310}}};
  for (const auto& [name, toLight] : suns) {
    cases.push_back(middle("sun", name));
    cases.back().view.scene.lights = {Sun{glm::normalize(toLight), {3.0, 3.0, 3.0}}};
  }
  axis(cases, "point light, distance from the middle", {0.0, 0.5, 1.5, 1e3},
       [](StabilityCase& c, double distance) {
         const double power = std::max(1.0, distance * distance);
         c.view.scene.lights = {PointLight{{distance, 0.0, 0.0}, {power, power, power}}};
       });
  axis(cases, "powder's strength", {0.0, 0.5, 100.0}, [](StabilityCase& c, double strength) {
    c.view.scene.powder = {true, strength};
    c.hasTruth = false;
  });
  axis(cases, "octaves' factors", {0.0, 0.5, 1.0}, [](StabilityCase& c, double factor) {
    constexpr int kCount = 8;
    c.view.scene.octaves = {kCount, factor, factor, factor};
    c.hasTruth = false;
  });
}

}  // namespace

std::vector<StabilityCase> stabilityCases() {
  Cases cases;
  addMedia(cases);
  addGrids(cases);
  addCameras(cases);
  addWorlds(cases);
  addLights(cases);
  return cases;
}

StabilityCase orbitFrame(int frame) {
  StabilityCase made = middle("flicker", "orbit");
  constexpr double kTurn = 0.5 * kPi / 180.0;
  const double angle = kTurn * frame, c = std::cos(angle), s = std::sin(angle);
  const dvec3 p = made.view.camera.position;
  made.view.camera.position = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  return made;
}

StabilityCase sequenceFrame(int frame) {
  StabilityCase made = middle("flicker", "sequence");
  constexpr double kPhase = 0.08;  // radians a frame: a voxel in 8 frames or so
  made.volume = [phase = kPhase * frame] { return ballAt(placed(kVoxel), phase); };
  return made;
}

}  // namespace nephele
