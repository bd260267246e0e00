// What is empty costs nothing: a domain filled to 1% against the same domain filled, and the peak memory of
// whole bakes by the program. Depends on voxelize, fields; runs nephele-bake.
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bake/voxelize.h"
#include "bench/pairs.h"
#include "bench/samples.h"

extern char** environ;

namespace nephele::bench {
namespace {

constexpr double kDomainEdge = 512.0;  // voxels, as the box of the fog ball
constexpr double kMegabyte = 1e6;

FieldPtr fogIn(const FieldPtr& where) {
  const FieldPtr noise = makeField("remap", {{"input", makeField("fbm", {{"cell_size", 50.0}})},
                                             {"from", std::array<double, 2>{-1.5, 1.0}}});
  return fold("multiply", {where, noise});
}

FieldPtr domain() {
  return makeField("box", {{"size", std::array<double, 3>{kDomainEdge, kDomainEdge, kDomainEdge}},
                           {"rounding", 0.0},
                           {"falloff", 0.0}});
}

/// Five balls, four in corners of the domain and one in its middle, that hold 1% of it together.
FieldPtr sparseClouds() {
  constexpr double kShare = 0.01, kBalls = 5.0, kBallVolume = 4.18879020478639;  // 4π/3
  const double radius = kDomainEdge * std::cbrt(kShare / (kBalls * kBallVolume));
  const double reach = 0.5 * kDomainEdge - radius;
  std::vector<FieldPtr> balls;
  for (const std::array<double, 3>& at :
       {std::array<double, 3>{0, 0, 0}, {1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}})
    balls.push_back(
        makeField("sphere", {{"center", std::array<double, 3>{reach * at[0], reach * at[1], reach * at[2]}},
                             {"radius", radius},
                             {"falloff", 0.0}}));
  return fold("union", balls);
}

struct Child {
  double seconds = 0.0, peakBytes = 0.0;
};

/// Runs a program to its end. Throws where it fails.
Child runProgram(std::vector<std::string> command) {
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  Child child;
  child.seconds = secondsOf([&] {
                    pid_t process = 0;
                    if (posix_spawn(&process, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0)
                      throw std::runtime_error("cannot run " + command[0]);
                    int status = 0;
                    rusage usage{};
                    if (wait4(process, &status, 0, &usage) != process || status != 0)
                      throw std::runtime_error(command[0] + " failed");
                    constexpr double kKilobyte = 1024.0;  // Linux counts ru_maxrss in these
                    child.peakBytes = double(usage.ru_maxrss) * kKilobyte;
                  }).clock;
  return child;
}

/// A recipe of a ball of fog with features of 50 voxels.
std::string fogRecipe(int radius, const char* precision) {
  const std::string r = std::to_string(radius);
  return "assets:\n  fog:\n    voxel_size: 1\n    cutoff: 0\n    precision: " + std::string(precision) +
         "\n    density:\n      multiply:\n        - sphere: {radius: " + r +
         ", falloff: 0}\n        - remap: {from: [-1.5, 1], input: {fbm: {cell_size: 50}}}\n";
}

}  // namespace

void compareSparseness(Table& table) {
  const char* const name = "sparse/1%_of_a_domain_against_all_of_it";
  if (!table.wants(name)) return;
  const FieldPtr sparse = fogIn(sparseClouds()), full = fogIn(domain());
  const examples::SampleFolder folder;
  const VoxelizeSettings settings{1.0, 0.0, false};
  // Each side has a file of its own: putting a small file in place of a large one costs the removal of the
  // large one.
  const auto bake = [&](const FieldPtr& field, const char* file) {
    const Voxelized voxelized = voxelize(*field, settings);
    writeDensity(folder.file(file), voxelized, Provenance{});
    return voxelized;
  };
  constexpr int kRepeats = 3;
  constexpr double kMostPercent = 3.0, kPercent = 100.0;
  const Minima minima =
      pairedMinima([&] { bake(sparse, "sparse.vdb"); }, [&] { bake(full, "full.vdb"); }, kRepeats);
  table.add({name, kPercent * minima.ours.clock / minima.theirs.clock, "%", atMost(kMostPercent),
             minima.ours.clock, minima.theirs.clock, kPercent * minima.ours.cpu / minima.theirs.cpu,
             contentHashOf(bake(sparse, "sparse.vdb"))});
}

void measurePeakMemory(Table& table, const std::string& bakeProgram) {
  for (const char* const precision : {"float", "half"}) {
    const std::string name = std::string("memory/fog_ball_") + precision;
    if (!table.wants(name)) continue;
    const examples::SampleFolder folder;
    constexpr int kRadius = 256;
    std::ofstream(folder.file("fog.yaml")) << fogRecipe(kRadius, precision);
    const Child child = runProgram({bakeProgram, folder.file("fog.yaml"), "--out", folder.file("out"),
                                    "--report", folder.file("report.json"), "--quiet"});
    nlohmann::json report;
    std::ifstream(folder.file("report.json")) >> report;
    const nlohmann::json& asset = report.at("assets").at(0);
    // The limit: 1.5 times the finished grid and 200 MB.
    constexpr double kGrids = 1.5, kRest = 200.0;
    const double grid = asset.at("grid_bytes").get<double>() / kMegabyte;
    table.add({name, child.peakBytes / kMegabyte, "MB", atMost(kGrids * grid + kRest), child.seconds,
               std::nullopt, std::nullopt, asset.at("content_hash").get<std::string>()});
  }
}

}  // namespace nephele::bench
