// Cases as recipes. Depends on stability_cases.h, base.
#include "bake/stability_cases.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/figures.h"

namespace nephele {
namespace {

using glm::dvec3;

// Powers of two, so that clouds at different places may lie on one lattice exactly.
constexpr double kVoxel = 0.0625;
constexpr double kRadius = 12.0;  // voxels
constexpr double kPi = std::numbers::pi;

std::string exact(double value) {
  constexpr int kAllDigits = 17;
  return number(value, kAllDigits);
}

std::string listOf(const dvec3& v) { return "[" + exact(v.x) + ", " + exact(v.y) + ", " + exact(v.z) + "]"; }

std::string recipeOf(const std::string& density, double voxel) {
  return "assets: { cloud: { voxel_size: " + exact(voxel) +
         ", precision: float, cutoff: 0, density: " + density + " } }\n";
}

/// A ball filled with noise, about a middle, in a world of any scale.
struct Cloud {
  dvec3 middle{0.0};  // world units
  double scale = 1.0;
  std::string noise = "fbm", basis = "perlin";
  int octaves = 3, period = 0;
  double lacunarity = 2.0, cellVoxels = 8.0;
  double warpCells = 0.0;  // largest displacement, in cells of the noise's first octave
  int iterations = 0;      // of the warp; 0: none

  double voxel() const { return kVoxel * scale; }
  double cell() const { return cellVoxels * voxel(); }

  std::string ball() const {
    const std::string radius = exact(kRadius * voxel());
    return "{ sphere: { center: " + listOf(middle) + ", radius: " + radius + ", falloff: " + radius + " } }";
  }
  std::string filling() const {
    const std::string plain = "{ " + noise + ": { basis: " + basis + ", cell_size: " + exact(cell()) +
                              ", octaves: " + std::to_string(octaves) + ", lacunarity: " + exact(lacunarity) +
                              ", period: " + std::to_string(period) + " } }";
    if (iterations == 0) return plain;
    return "{ warp: { input: " + plain + ", warp_scale: " + exact(warpCells * cell()) +
           ", cell_size: " + exact(cell()) + ", iterations: " + std::to_string(iterations) +
           ", period: " + std::to_string(period) + " } }";
  }
  std::string recipe() const {
    return recipeOf("{ multiply: [" + ball() + ", { add: [0.5, { multiply: [0.5, " + filling() + "] }] }] }",
                    voxel());
  }
  BakeCase at(const std::string& axis, const std::string& value) const {
    BakeCase made;
    made.axis = axis;
    made.value = value;
    made.recipe = recipe();
    made.middle = middle / voxel();
    return made;
  }
};

using Cases = std::vector<BakeCase>;

// Beyond the last a voxel's index would leave 32 bits.
constexpr double kDistances[] = {0.0, 1e3, 1e5, 1e7, 1e8};

dvec3 offsetAt(double distance) { return {distance, -distance, 0.5 * distance}; }

/// A noise with a period comes round: far away it is what it is at the origin, voxel for voxel. Every
/// distance is a whole number of periods.
void addFarNoises(Cases& cases) {
  constexpr int kPeriod = 4;
  const auto add = [&](const std::string& axis, const Cloud& cloud) {
    for (const double distance : kDistances) {
      Cloud far = cloud;
      far.middle = offsetAt(distance);
      cases.push_back(far.at("distance from the origin, " + axis, number(distance)));
      if (cloud.period == 0) continue;
      cases.back().twin = cloud.recipe();
    }
  };
  Cloud cloud;
  add("gradient noise without period", cloud);
  cloud.period = kPeriod;
  add("gradient noise", cloud);
  cloud.basis = "value";
  add("value noise", cloud);
  cloud.basis = "worley";
  add("cellular noise", cloud);
  cloud.basis = "perlin";
  cloud.warpCells = 1.0;
  cloud.iterations = 2;
  add("warped noise", cloud);
}

/// Where shapes and ramps go, their whole cloud goes.
void addFarShapes(Cases& cases) {
  struct Shape {
    const char* axis;
    std::function<std::string(const dvec3&)> density;  // about a middle
  };
  const auto sphere = [](const dvec3& at) {
    return "{ sphere: { center: " + listOf(at) + ", radius: 0.75, falloff: 0.5 } }";
  };
  const Shape shapes[] = {
      {"torus",
       [](const dvec3& at) { return "{ torus: { center: " + listOf(at) + ", major: 0.5, minor: 0.25 } }"; }},
      {"box",
       [](const dvec3& at) { return "{ box: { center: " + listOf(at) + ", size: [1.2, 0.9, 0.7] } }"; }},
      {"height profile",
       [=](const dvec3& at) {
         return "{ multiply: [" + sphere(at) + ", { height_profile: { base: " + exact(at.z - 0.75) +
                ", top: " + exact(at.z + 0.75) + " } }] }";
       }},
      {"transform",
       [=](const dvec3& at) {
         return "{ transform: { input: " + sphere(dvec3(0.0)) +
                ", scale: [1, 0.5, 0.8], rotate: [10, 20, 30], translate: " + listOf(at) + " } }";
       }},
      {"smooth union", [=](const dvec3& at) {
         return "{ smooth_union: [" + sphere(at) + ", { capsule: { from: " + listOf(at - dvec3(0.5)) +
                ", to: " + listOf(at + dvec3(0.4)) + ", radius: 0.2 } }] }";
       }}};
  for (const Shape& shape : shapes)
    for (const double distance : kDistances) {
      BakeCase made;
      made.axis = std::string("distance from the origin, ") + shape.axis;
      made.value = number(distance);
      made.recipe = recipeOf(shape.density(offsetAt(distance)), kVoxel);
      made.middle = offsetAt(distance) / kVoxel;
      made.twin = recipeOf(shape.density(dvec3(0.0)), kVoxel);
      cases.push_back(made);
    }
}

void addScales(Cases& cases) {
  const Cloud plain;
  for (const double scale : {1e-10, 1e-6, 2e-4, 3e-4, 1e-3, 1.0, 1e3, 1e6, 1e8, 1e12}) {
    Cloud cloud;
    cloud.scale = scale;
    cases.push_back(cloud.at("world's scale, noise in a ball", number(scale)));
    cases.back().twin = plain.recipe();
  }
  for (const double scale : {1e-10, 1e-6, 2e-4, 3e-4, 1e-3, 1.0, 1e3, 1e6, 1e8, 1e12}) {
    Cloud cloud, twin;
    cloud.scale = scale;
    cloud.warpCells = twin.warpCells = 1.0;
    cloud.iterations = twin.iterations = 2;
    cloud.basis = twin.basis = "worley";
    cases.push_back(cloud.at("world's scale, warped cellular noise", number(scale)));
    cases.back().twin = twin.recipe();
  }
}

void addNoises(Cases& cases) {
  const auto add = [&](const std::string& axis, const std::vector<double>& values, const Cloud& from,
                       const std::function<void(Cloud&, double)>& change) {
    for (const double value : values) {
      Cloud cloud = from;
      change(cloud, value);
      cases.push_back(cloud.at(axis, number(value)));
      cases.back().depths = true;
    }
  };
  const std::vector<double> octaves = {0, 1, 2, 3, 5, 8, 12, 16};
  const auto setOctaves = [](Cloud& c, double value) { c.octaves = int(value); };
  add("octaves, fbm", octaves, {}, setOctaves);
  Cloud folded;
  folded.noise = "ridged";
  add("octaves, ridged", octaves, folded, setOctaves);
  Cloud cellular;
  cellular.basis = "worley";
  add("octaves, cellular", octaves, cellular, setOctaves);
  Cloud many;
  constexpr int kMany = 16;
  many.octaves = kMany;
  add("lacunarity of 16 octaves", {1.0, 1.01, 1.3, 1.9, 2.0, 2.7, std::numbers::pi, 7.5, 16.0}, many,
      [](Cloud& c, double value) { c.lacunarity = value; });
  add("voxels a cell", {1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 16.0, 64.0}, {}, [](Cloud& c, double value) {
    c.cellVoxels = value;
    c.octaves = 1;
  });
  Cloud warped;
  warped.octaves = 1;
  warped.iterations = 1;
  add("warp, cells", {0.0, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0}, warped,
      [](Cloud& c, double value) { c.warpCells = value; });
  warped.warpCells = 0.3;
  add("iterations of a warp of 0.3 cells", {1, 2, 3, 4, 6, 8}, warped,
      [](Cloud& c, double value) { c.iterations = int(value); });
  warped.warpCells = 100.0;
  add("iterations of a warp of 100 cells", {1, 2, 3, 4, 6, 8}, warped,
      [](Cloud& c, double value) { c.iterations = int(value); });
}

/// A ball that falls off from its middle, lifted by `lift`, remapped from [lift + ½, lift + ½ + apart].
void addRemaps(Cases& cases) {
  const auto add = [&](const std::string& axis, double lift, double sign) {
    for (const double apart : {1.0, 0.1, 1e-2, 1e-4, 1e-6, 1e-7, 1e-9}) {
      const double from = lift + 0.5, to = from + sign * apart;
      const std::string radius = exact(kRadius * kVoxel);
      const std::string ball = "{ sphere: { radius: " + radius + ", falloff: " + radius + " } }";
      const std::string remapped = "{ remap: { from: [" + exact(from) + ", " + exact(to) +
                                   "], input: { add: [" + exact(lift) + ", " + ball + "] } } }";
      BakeCase made;
      made.axis = axis;
      made.value = number(apart);
      // The product keeps a reversed remap within the ball.
      made.recipe = recipeOf("{ multiply: [" + ball + ", " + remapped + "] }", kVoxel);
      made.formula = [=](const dvec3& p) {
        const double ball01 = std::max(0.0, 1.0 - std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z) / kRadius);
        return ball01 * std::clamp((ball01 - 0.5) / (sign * apart), 0.0, 1.0);
      };
      cases.push_back(made);
    }
  };
  add("remap, its ends apart", 0.0, 1.0);
  add("remap, its ends apart, reversed", 0.0, -1.0);
  constexpr double kLift = 1000.0;
  add("remap, its ends apart, at 1000", kLift, 1.0);
}

/// Shapes without falloff hold their volume; with the falloff that is their own size a ball holds a quarter.
void addThinShapes(Cases& cases) {
  const auto add = [&](const std::string& axis, const std::vector<double>& sizes,
                       const std::function<std::string(double)>& density,
                       const std::function<double(double)>& volume) {
    for (const double size : sizes) {
      BakeCase made;
      made.axis = axis;
      made.value = number(size);
      made.recipe = recipeOf(density(size), kVoxel);
      made.mass = volume(size);
      cases.push_back(made);
    }
  };
  // Sheets reach to the middle between two samples at their sides, so that their own thickness alone counts.
  constexpr double kSide = 16.0;
  const auto sheet = [](double thick, double height) {
    return "{ box: { center: " + listOf(kVoxel * dvec3(0.5, 0.5, height)) +
           ", size: " + listOf(kVoxel * dvec3(kSide, kSide, thick)) + ", rounding: 0, falloff: 0 } }";
  };
  const auto volumeOfSheet = [](double thick) { return kSide * kSide * thick; };
  const std::vector<double> thicknesses = {0.01, 0.1, 0.3, 0.5, 0.9, 1.1, 1.5, 1.9, 2.5, 4.5, 8.5, 16.5};
  add(
      "thickness of a sheet on samples, voxels", thicknesses, [=](double t) { return sheet(t, 0.0); },
      volumeOfSheet);
  add(
      "thickness of a sheet between samples, voxels", thicknesses, [=](double t) { return sheet(t, 0.5); },
      volumeOfSheet);
  const std::vector<double> radii = {0.1, 0.3, 0.5, 0.9, 1.5, 2.5, 4.5, 8.5};
  const auto ball = [](double radius, double falloff, const dvec3& at) {
    return "{ sphere: { center: " + listOf(kVoxel * at) + ", radius: " + exact(kVoxel * radius) +
           ", falloff: " + exact(kVoxel * falloff) + " } }";
  };
  const auto volumeOfBall = [](double r) { return 4.0 / 3.0 * kPi * r * r * r; };
  const dvec3 aside(0.31, 0.17, 0.42);  // off the samples
  add(
      "radius of a hard ball, voxels", radii, [=](double r) { return ball(r, 0.0, aside); }, volumeOfBall);
  add(
      "radius of a soft ball, voxels", radii, [=](double r) { return ball(r, r, aside); },
      [=](double r) { return 0.25 * volumeOfBall(r); });
  constexpr double kMajor = 10.0;
  add(
      "radius of a ring's wire, voxels", {0.1, 0.3, 0.5, 0.9, 1.5, 2.5},
      [=](double r) {
        return "{ torus: { center: " + listOf(kVoxel * aside) +
               ", axis: [0.3, 0.2, 1], major: " + exact(kVoxel * kMajor) + ", minor: " + exact(kVoxel * r) +
               ", falloff: 0 } }";
      },
      [=](double r) { return 2.0 * kPi * kPi * kMajor * r * r; });
}

}  // namespace

std::vector<BakeCase> bakeCases() {
  Cases cases;
  addFarNoises(cases);
  addFarShapes(cases);
  addScales(cases);
  addNoises(cases);
  addRemaps(cases);
  addThinShapes(cases);
  return cases;
}

}  // namespace nephele
