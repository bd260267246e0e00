// Our splat and OpenVDB's FrustumRasterizer on the same points in a ball of 512 voxels; ten million points;
// how time and memory grow. Depends on splat, frustum.h.
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "bake/splat.h"
#include "bench/frustum.h"
#include "bench/pairs.h"

namespace nephele::bench {
namespace {

constexpr double kVoxel = 2.0 / 512.0;

/// Points evenly in the unit ball.
struct Ball {
  std::vector<float> x, y, z, radius, mass;

  Ball(size_t count, double radiusVoxels)
      : radius(count, float(radiusVoxels * kVoxel)), mass(count, float(kVoxel * kVoxel * kVoxel)) {
    uint32_t state = 1;
    while (x.size() < count) {
      const float p[] = {2.0f * motion::nextUniform(state) - 1.0f, 2.0f * motion::nextUniform(state) - 1.0f,
                         2.0f * motion::nextUniform(state) - 1.0f};
      if (p[0] * p[0] + p[1] * p[1] + p[2] * p[2] >= 1.0f) continue;
      x.push_back(p[0]), y.push_back(p[1]), z.push_back(p[2]);
    }
  }
  SplatParticles particles() const { return {x, y, z, radius, mass, {}, {}, {}, {}, {}, {}}; }
  size_t bytes() const { return 5 * sizeof(float) * x.size(); }
};

SplatSettings settingsFor(SplatKernel kernel) {
  SplatSettings settings;
  settings.voxelSize = kVoxel;
  settings.kernel = kernel;
  settings.cutoff = 0.0;
  settings.half = false;
  return settings;
}

void compareWithFrustum(Table& table) {
  struct Case {
    size_t count;
    int radius;
  };
  constexpr double kTarget = 3.0;
  static constexpr const char* kNames[] = {"gaussian", "wendland", "smooth_sphere"};
  for (const Case& c : {Case{1'000'000, 2}, Case{1'000'000, 4}, Case{100'000, 8}})
    for (int kernel = 0; kernel < 3; ++kernel) {
      const std::string name = "splat/frustum/radius_" + std::to_string(c.radius) + "/" + kNames[kernel];
      if (!table.wants(name)) continue;
      const Ball ball(c.count, c.radius);
      Frustum frustum(ball.x, ball.y, ball.z, c.radius * kVoxel, kVoxel);
      const SplatSettings settings = settingsFor(SplatKernel(kernel));
      std::string hash;
      constexpr int kRepeats = 5;
      const Minima minima =
          pairedMinima([&] { splat(ball.particles(), settings); }, [&] { frustum.rasterize(); }, kRepeats);
      table.addSpeedup(name, minima, atLeast(kTarget), contentHashOf(splat(ball.particles(), settings)));
    }
}

/// Bytes of the process's line `key` in /proc/self/status.
double statusBytes(const char* key) {
  std::ifstream in("/proc/self/status");
  std::string line;
  while (std::getline(in, line)) {
    if (!line.starts_with(key)) continue;
    std::istringstream words(line.substr(std::strlen(key) + 1));
    double kilobytes = 0.0;
    words >> kilobytes;
    constexpr double kKilobyte = 1024.0;
    return kilobytes * kKilobyte;
  }
  return 0.0;
}

/// Ten million points of two voxels: seconds, and the peak beside the grid over the points' own bytes.
void measureTenMillion(Table& table) {
  if (!table.wants("splat/ten_million")) return;
  const Ball ball(10'000'000, 2.0);
  const SplatSettings settings = settingsFor(SplatKernel::wendland);
  malloc_trim(0);  // what earlier cases freed must not hide what this one takes
  const double before = statusBytes("VmRSS:");
  std::ofstream("/proc/self/clear_refs") << "5";  // the peak starts anew [proc(5)]
  double gridBytes = 0.0;
  std::string hash;
  Seconds least;
  constexpr int kRepeats = 3;
  double peak = 0.0;
  for (int n = 0; n < kRepeats; ++n) {
    Splatted splatted;
    const Seconds seconds = secondsOf([&] { splatted = splat(ball.particles(), settings); });
    least.clock = std::min(least.clock, seconds.clock);
    least.cpu = std::min(least.cpu, seconds.cpu);
    if (n > 0) continue;  // later peaks hold what the allocator kept
    peak = statusBytes("VmHWM:") - before;
    gridBytes = double(splatted.gridBytes);
    hash = contentHashOf(splatted);
  }
  constexpr double kMostSeconds = 2.0, kMostPeak = 2.0;
  table.add({"splat/ten_million/seconds",
             least.clock,
             "s",
             atMost(kMostSeconds),
             least.clock,
             {},
             least.cpu,
             hash});
  table.add({"splat/ten_million/peak_of_points",
             1.0 + (peak - gridBytes) / double(ball.bytes()),
             "x",
             atMost(kMostPeak),
             {},
             {},
             {},
             {}});
}

/// Time a particle from 10⁴ to 10⁷, in a ball that grows so that they lie as densely.
void measureGrowth(Table& table) {
  double least = 1e9, most = 0.0;
  int measured = 0;
  for (const size_t count : {size_t(10'000), size_t(100'000), size_t(1'000'000), size_t(10'000'000)}) {
    const std::string name = "splat/microseconds_each/" + std::to_string(count);
    if (!table.wants(name)) continue;
    const Ball ball(count, 2.0);
    SplatSettings settings = settingsFor(SplatKernel::wendland);
    std::vector<float> x = ball.x, y = ball.y, z = ball.z;
    const float grown = float(std::cbrt(double(count) / 1e7));
    for (auto* axis : {&x, &y, &z})
      for (float& v : *axis) v *= grown;
    double seconds = 1e9;
    const int repeats = count < 1'000'000 ? 20 : 3;
    for (int n = 0; n < repeats; ++n)
      seconds =
          std::min(seconds, secondsOf([&] {
                              splat({x, y, z, ball.radius, ball.mass, {}, {}, {}, {}, {}, {}}, settings);
                            }).clock);
    const double each = seconds / double(count) * 1e6;
    least = std::min(least, each);
    most = std::max(most, each);
    ++measured;
    table.add({name, each, "us", {}, seconds, {}, {}, {}});
  }
  // Linear: a particle takes as long among ten million as among ten thousand.
  constexpr double kMostGrowth = 1.5;
  if (measured > 1)
    table.add(
        {"splat/microseconds_each/most_over_least", most / least, "x", atMost(kMostGrowth), {}, {}, {}, {}});
}

}  // namespace

void compareSplat(Table& table) {
  compareWithFrustum(table);
  measureTenMillion(table);
  measureGrowth(table);
}

}  // namespace nephele::bench
