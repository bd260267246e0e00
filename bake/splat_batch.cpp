// Counting sorts of a tile's particles, by leaf and way or along x. Depends on splat_batch.h.
#include "bake/splat_batch.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nephele {
namespace {

// Cells of small particles lie up to their reach outside the tile.
constexpr int kOutside = 8;
constexpr int kCells = kTileEdge + 2 * kOutside;
constexpr int kStripes = kCells / kLeafEdge;

/// Which part of the tile a particle is added to: stripes of 8 voxels along y, and in each plane after plane
/// along x, so that what neighbours touch stays in the first cache.
size_t stripeOf(const SplatRecord& p) {
  return size_t(((p.cell[1] + kOutside) / kLeafEdge) * kCells + p.cell[0] + kOutside);
}

/// A stable counting sort by stripe: equal ones keep their order.
void sortByStripe(const std::vector<SplatRecord>& small, std::vector<uint32_t>& order) {
  std::array<uint32_t, size_t(kStripes) * kCells + 1> next{};
  for (const SplatRecord& p : small) ++next[stripeOf(p) + 1];
  for (size_t n = 1; n < next.size(); ++n) next[n] += next[n - 1];
  order.resize(small.size());
  for (size_t n = 0; n < small.size(); ++n) order[next[stripeOf(small[n])]++] = uint32_t(n);
}

}  // namespace

/// The leaves of a tile that a particle reaches, and the way it takes there.
struct SplatSorter::Reach {
  uint8_t low[3], high[3], way;

  bool empty() const { return low[0] > high[0] || low[1] > high[1] || low[2] > high[2]; }
  /// Calls body with the number of the list that each leaf has for this way.
  template <class Body>
  void forEachList(const Body& body) const {
    for (int x = low[0]; x <= high[0]; ++x)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int z = low[2]; z <= high[2]; ++z)
          body(size_t(((x * kTileLeaves + y) * kTileLeaves + z) * kSplatWays + way));
  }
};

SplatSorter::SplatSorter(const SplatParticles& particles, const SplatSettings& settings,
                         const SplatPlaces& places, const std::vector<float>& scales)
    : particles_(particles),
      settings_(settings),
      places_(places),
      scales_(scales),
      perVolume_(1.0 / (settings.voxelSize * settings.voxelSize * settings.voxelSize)),
      extras_(settings.vel || settings.temperature || settings.age),
      shaped_(places.anyShaped()) {}

// Particles of a tile lie far apart in memory: asked for this many ahead, they are there when they are
// needed.
constexpr size_t kAhead = 16;

void SplatSorter::sort(const glm::ivec3& tile, SplatBatch& batch) const {
  batch.records.clear();
  batch.owners.clear();
  batch.extras.clear();
  batch.small.clear();
  batch.small.reserve(batch.particles.size());
  batch.starts.assign(size_t(kLeavesOfTile * kSplatWays) + 1, 0);
  std::vector<Reach> reaches;
  const size_t count = batch.particles.size();
  for (size_t k = 0; k < count; ++k) {
    const size_t n = batch.particles[k], soon = batch.particles[std::min(k + kAhead, count - 1)];
    places_.prefetch(soon);
    __builtin_prefetch(scales_.empty() ? particles_.mass.data() + soon : scales_.data() + soon);
    if (isSmall(places_.radiusOf(n))) {
      SplatRecord& record = batch.small.emplace_back(places_.placeOf(n));
      for (int axis = 0; axis < 3; ++axis) record.cell[axis] -= tile[axis];
      record.scale = scaleOf(n);
      continue;
    }
    Reach reach;
    batch.records.push_back(recordOf(n, tile, reach));
    batch.owners.push_back(uint32_t(n));
    reaches.push_back(reach);
    if (extras_) batch.extras.push_back(extrasOf(n));
    reach.forEachList([&](size_t list) { ++batch.starts[list + 1]; });
  }
  sortByStripe(batch.small, batch.smallOrder);
  batch.list.clear();
  if (reaches.empty()) return;
  for (size_t n = 1; n < batch.starts.size(); ++n) batch.starts[n] += batch.starts[n - 1];
  batch.list.resize(batch.starts.back());
  std::vector<uint32_t> next(batch.starts.begin(), batch.starts.end() - 1);
  for (size_t k = 0; k < reaches.size(); ++k)
    reaches[k].forEachList([&](size_t list) { batch.list[next[list]++] = uint32_t(k); });
}

/// The particle in a tile's frame, and the leaves of the tile that it reaches.
SplatRecord SplatSorter::recordOf(size_t n, const glm::ivec3& tile, Reach& reach) const {
  SplatRecord record;
  SplatWay way = SplatWay::round;
  int from[3], to[3];
  if (shaped_) {
    const SplatFrame f = places_.frameOf(n);
    record = f.record;
    way = f.way;
    for (int axis = 0; axis < 3; ++axis) from[axis] = f.low[axis], to[axis] = f.high[axis];
    // An eroded particle of which nothing is left is kept as a point.
    if (scaleOf(n) < 0.0f) way = SplatWay::point;
  } else {
    record = places_.placeOf(n);
    way = record.radius <= 1.0f ? SplatWay::point : SplatWay::round;
    for (int axis = 0; axis < 3; ++axis) {
      const float rest = record.rest[axis], radius = record.radius;
      const bool point = way == SplatWay::point;
      from[axis] = record.cell[axis] + (point ? 0 : splatReachBelow(rest, radius));
      to[axis] = record.cell[axis] + (point ? 1 : splatReachAbove(rest, radius));
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    record.cell[axis] -= tile[axis];
    const int first = std::max(0, from[axis] - tile[axis]),
              last = std::min(kTileEdge - 1, to[axis] - tile[axis]);
    // A tile that rounding alone put on the list has an empty range.
    reach.low[axis] = uint8_t(first / kLeafEdge);
    reach.high[axis] = first <= last ? uint8_t(last / kLeafEdge) : 0;
    if (first > last) reach.low[axis] = 1;
  }
  reach.way = uint8_t(way);
  record.scale = std::abs(scaleOf(n));
  return record;
}

SplatExtras SplatSorter::extrasOf(size_t n) const {
  SplatExtras e{};
  if (settings_.vel) {
    e.value[0] = particles_.vx[n];
    e.value[1] = particles_.vy[n];
    e.value[2] = particles_.vz[n];
  }
  if (settings_.temperature) e.value[3] = particles_.temperature[n];
  if (settings_.age) e.value[4] = particles_.age[n];
  return e;
}

}  // namespace nephele
