// Whether a grid fits into memory, told before it is filled. Depends on voxelize_fill.h, OpenVDB, TBB.
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <random>

#include "bake/voxelize_fill.h"

namespace nephele {
namespace {

// Places that are looked at: a share of 1% is then known to ± 0.5% (three standard deviations).
constexpr size_t kPlaces = 4000;
constexpr double kDeviations = 3.0;

/// The share of leaves in the cubes that hold voxels which memory has to hold: surely no less.
double leastShare(const LeafFiller& filler, const std::vector<openvdb::Coord>& cubes) {
  std::mt19937_64 random(1);  // the same places in every run
  std::vector<openvdb::Coord> places;
  constexpr uint64_t kLeavesAlong = uint64_t(kCoarseEdge / kBlockEdge);
  const auto along = [&] { return int(random() % kLeavesAlong) * kBlockEdge; };
  for (size_t n = 0; n < kPlaces; ++n) {
    const openvdb::Coord& cube = cubes[size_t(random() % cubes.size())];
    const int x = along(), y = along(), z = along();
    places.push_back(cube.offsetBy(x, y, z));
  }
  std::atomic<size_t> held{0};
  tbb::parallel_for(size_t(0), kPlaces, [&](size_t n) {
    LeafSums sums;
    if (!filler.isSettled(places[n]) && filler.fill(places[n], sums)) ++held;
  });
  const double share = double(held) / double(kPlaces);
  return share - kDeviations * std::sqrt(share * (1.0 - share) / double(kPlaces));
}

}  // namespace

void checkDomain(const Field& field, const VoxelizeSettings& settings) {
  const LeafFiller filler(field, settings);
  const openvdb::CoordBBox box = filler.box();
  if (box.empty()) return;
  const auto fits = [&](double leaves) {
    return leaves * bytesOfLeaf(settings) <= double(settings.memoryBytes);
  };
  const auto leavesAlong = [&](int axis) { return double(box.dim()[axis]) / kBlockEdge; };
  if (fits(leavesAlong(0) * leavesAlong(1) * leavesAlong(2))) return;
  const std::vector<openvdb::Coord> cubes = filler.findCoarse().origins;
  constexpr double kLeavesInCube =
      double(kCoarseEdge / kBlockEdge) * (kCoarseEdge / kBlockEdge) * (kCoarseEdge / kBlockEdge);
  const double most = double(cubes.size()) * kLeavesInCube;
  if (fits(most)) return;
  const double least = most * leastShare(filler, cubes);
  if (!fits(least)) throw tooMuchMemory(least, settings);
}

}  // namespace nephele
