// Counting sorts of a tile's particles, by leaf and way or along x. Depends on splat_batch.h.
#include "bake/splat_batch.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nephele {
namespace {

/// A stable counting sort by cell: equal cells keep their order.
void sortAlongX(const std::vector<SplatRecord>& small, std::vector<SplatRecord>& sorted) {
  // Cells of small particles lie up to their reach outside the tile.
  constexpr int kOutside = 8;
  std::array<uint32_t, kTileEdge + 2 * kOutside + 1> next{};
  for (const SplatRecord& p : small) ++next[size_t(p.cell[0] + kOutside) + 1];
  for (size_t n = 1; n < next.size(); ++n) next[n] += next[n - 1];
  sorted.resize(small.size());
  for (const SplatRecord& p : small) sorted[next[size_t(p.cell[0] + kOutside)]++] = p;
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
      extras_(settings.vel || settings.temperature || settings.age),
      shaped_(places.anyShaped()) {}

void SplatSorter::sort(const glm::ivec3& tile, SplatBatch& batch) const {
  batch.records.clear();
  batch.owners.clear();
  std::vector<SplatRecord> small;
  batch.extras.clear();
  std::vector<Reach> reaches;
  batch.starts.assign(size_t(kLeavesOfTile * kSplatWays) + 1, 0);
  // Particles of a tile lie far apart in memory: asked for this many ahead, they are there when they are
  // needed.
  constexpr size_t kAhead = 16;
  const size_t count = batch.particles.size();
  for (size_t k = 0; k < count; ++k) {
    const size_t n = batch.particles[k], soon = batch.particles[std::min(k + kAhead, count - 1)];
    places_.prefetch(soon);
    __builtin_prefetch(scales_.data() + soon);
    Reach reach;
    const SplatRecord record = recordOf(n, tile, reach);
    if (isSmall(record)) {
      if (!reach.empty()) small.push_back(record);
      continue;
    }
    batch.records.push_back(record);
    batch.owners.push_back(uint32_t(n));
    reaches.push_back(reach);
    if (extras_) batch.extras.push_back(extrasOf(n));
    reach.forEachList([&](size_t list) { ++batch.starts[list + 1]; });
  }
  for (size_t n = 1; n < batch.starts.size(); ++n) batch.starts[n] += batch.starts[n - 1];
  batch.list.resize(batch.starts.back());
  std::vector<uint32_t> next(batch.starts.begin(), batch.starts.end() - 1);
  for (size_t k = 0; k < reaches.size(); ++k)
    reaches[k].forEachList([&](size_t list) { batch.list[next[list]++] = uint32_t(k); });
  sortAlongX(small, batch.small);
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
    if (scales_[n] < 0.0f) way = SplatWay::point;
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
  record.scale = std::abs(scales_[n]);
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
