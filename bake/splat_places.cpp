// Frames of particles, and a stable counting sort by tile. Depends on splat_places.h, TBB.
#include "bake/splat_places.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/figures.h"

namespace nephele {
namespace {

// A box larger than this is refused: dense it would take 4 TB.
constexpr double kMostVoxels = 1e12;
// A particle this wide takes 4·10⁹ voxels; recipes that ask for more have the wrong voxel size.
constexpr double kLargestRadius = 1024.0;
// Chunks of particles that are counted apart. Fixed, so that threads do not matter; fewer where counts would
// take much memory.
constexpr size_t kMostChunks = 64;
constexpr size_t kMostCounts = 4u << 20;
constexpr size_t kSmallestChunk = 4096;

glm::ivec3 tileOf(const glm::ivec3& voxel) {
  constexpr int kShift = 6;  // 64 voxels; shifts of negative numbers round down
  return {voxel.x >> kShift, voxel.y >> kShift, voxel.z >> kShift};
}

std::string shown(double value) { return number(value, 3); }

size_t chunksOf(size_t particles, size_t tiles) {
  const size_t byMemory = std::max<size_t>(1, kMostCounts / std::max<size_t>(1, tiles));
  return std::min({kMostChunks, byMemory, particles / kSmallestChunk + 1});
}

template <class Body>
void forEachChunk(size_t count, size_t chunks, const Body& body) {
  tbb::parallel_for(size_t(0), chunks,
                    [&](size_t c) { body(c, count * c / chunks, count * (c + 1) / chunks); });
}

}  // namespace

SplatPlaces::SplatPlaces(const SplatParticles& particles, const SplatSettings& settings)
    : particles_(particles), settings_(settings), perVoxel_(1.0 / settings.voxelSize) {
  if (settings_.voxelSize < kSmallestVoxel)
    throw SplatError("voxels of " + shown(settings_.voxelSize) + " world units are below " +
                     shown(kSmallestVoxel) + ", the smallest that a .vdb can hold; use larger units");
  if (particles_.size() == 0) return;
  findBox();
  sortByTile();
}

void SplatPlaces::refuse(size_t n, const std::string& what) const {
  throw SplatError("particle " + std::to_string(n) + " at (" + shown(double(particles_.x[n])) + ", " +
                   shown(double(particles_.y[n])) + ", " + shown(double(particles_.z[n])) + ") " + what);
}

void SplatPlaces::check(size_t n) const {
  const double h = settings_.voxelSize;
  for (const auto* axis : {&particles_.x, &particles_.y, &particles_.z}) {
    if (!std::isfinite((*axis)[n])) refuse(n, "is not at a finite place");
    if (std::abs(double((*axis)[n])) > kLargestIndex * h) refuse(n, "is beyond voxel 2^30");
  }
  const double radius = double(particles_.radius[n]);
  if (!(radius > 0.0)) refuse(n, "has the radius " + shown(radius) + "; it must be greater than 0");
  if (radius > kLargestRadius * h)
    refuse(n, "has a radius of " + shown(radius / h) + " voxels, more than " + shown(kLargestRadius) +
                  "; use larger voxels");
  const float mass = particles_.mass[n];
  if (!(mass >= 0.0f) || !std::isfinite(mass)) refuse(n, "has the mass " + shown(double(mass)));
  if (settings_.shutterSeconds > 0.0)
    for (const auto* axis : {&particles_.vx, &particles_.vy, &particles_.vz})
      if (!(std::abs(double((*axis)[n])) * settings_.shutterSeconds <= kLargestRadius * h))
        refuse(n, "moves more than " + shown(kLargestRadius) + " voxels while the shutter is open");
}

SplatFrame SplatPlaces::frameOf(size_t n, double h) const {
  SplatFrame f;
  f.record = placeOf(n, 1.0 / h);
  float half[3] = {0.0f, 0.0f, 0.0f};
  bool moves = false;
  if (settings_.shutterSeconds > 0.0) {
    const float velocity[] = {particles_.vx[n], particles_.vy[n], particles_.vz[n]};
    for (int axis = 0; axis < 3; ++axis) {
      f.shape.stretch[axis] = float(double(velocity[axis]) * settings_.shutterSeconds / h);
      half[axis] = 0.5f * std::abs(f.shape.stretch[axis]);
      moves = moves || half[axis] > 0.0f;
    }
  }
  if (settings_.erosion) f.shape.erosion = float(settings_.erosionAmount);
  f.way = moves || f.shape.erosion > 0.0f ? SplatWay::shaped
          : f.record.radius <= 1.0f       ? SplatWay::point
                                          : SplatWay::round;
  if (f.way == SplatWay::shaped) f.record.radius = std::max(f.record.radius, 1.0f);
  for (int axis = 0; axis < 3; ++axis) {
    const float rest = f.record.rest[axis], reach = f.record.radius + half[axis];
    const bool point = f.way == SplatWay::point;
    f.low[axis] = f.record.cell[axis] + (point ? 0 : splatReachBelow(rest, reach));
    f.high[axis] = f.record.cell[axis] + (point ? 1 : splatReachAbove(rest, reach));
  }
  return f;
}

bool SplatPlaces::looksGood(size_t n) const {
  const float limit = float(kLargestIndex * settings_.voxelSize),
              widest = float(kLargestRadius * settings_.voxelSize);
  const bool place = std::abs(particles_.x[n]) < limit && std::abs(particles_.y[n]) < limit &&
                     std::abs(particles_.z[n]) < limit;
  const bool size = particles_.radius[n] > 0.0f && particles_.radius[n] < widest;
  return place && size && particles_.mass[n] >= 0.0f &&
         particles_.mass[n] <= std::numeric_limits<float>::max() && settings_.shutterSeconds == 0.0;
}

/// How far a stretched or eroded particle reaches from its centre along any axis, world units.
double SplatPlaces::reachOf(size_t n) const {
  double farthest = 0.0;
  if (settings_.shutterSeconds > 0.0)
    for (const auto* axis : {&particles_.vx, &particles_.vy, &particles_.vz})
      farthest = std::max(farthest, std::abs(double((*axis)[n])) * settings_.shutterSeconds);
  return std::max(double(particles_.radius[n]), settings_.voxelSize) + 0.5 * farthest;
}

/// A box of voxels that holds all that any particle can reach, and a little more.
void SplatPlaces::findBox() {
  const size_t count = particles_.size(), chunks = chunksOf(count, 1);
  struct Extent {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{-std::numeric_limits<float>::max()};
    double reach = 0.0, mass = 0.0;
    float widest = 0.0f;
    size_t bad = std::numeric_limits<size_t>::max();
  };
  std::vector<Extent> extents(chunks);
  forEachChunk(count, chunks, [&](size_t c, size_t begin, size_t end) {
    Extent own;
    for (size_t n = begin; n < end; ++n) {
      if (!looksGood(n)) {
        try {
          check(n);
        } catch (const SplatError&) {
          own.bad = n;
          break;
        }
      }
      const glm::vec3 p(particles_.x[n], particles_.y[n], particles_.z[n]);
      own.low = glm::min(own.low, p);
      own.high = glm::max(own.high, p);
      own.mass += double(particles_.mass[n]);
      own.widest = std::max(own.widest, particles_.radius[n]);
      if (anyShaped()) own.reach = std::max(own.reach, reachOf(n));
    }
    extents[c] = own;
  });
  Extent all;
  for (const Extent& e : extents) {
    all.low = glm::min(all.low, e.low);
    all.high = glm::max(all.high, e.high);
    all.reach = std::max({all.reach, e.reach, double(e.widest)});
    all.widest = std::max(all.widest, e.widest);
    all.mass += e.mass;
    all.bad = std::min(all.bad, e.bad);
  }
  // The first of them, whichever thread came first.
  if (all.bad < count) check(all.bad);
  const double h = settings_.voxelSize;
  mass_ = all.mass;
  widest_ = float(double(all.widest) * perVoxel_);
  glm::ivec3 low, high;
  double voxels = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = floorToInt((double(all.low[axis]) - all.reach) / h) - 2;
    high[axis] = floorToInt((double(all.high[axis]) + all.reach) / h) + 3;
    voxels *= double(high[axis]) - double(low[axis]) + 1.0;
  }
  if (voxels > kMostVoxels)
    throw SplatError("the particles' box holds " + shown(voxels) + " voxels (" + shown(voxels * 4e-9) +
                     " GB if dense), more than " + shown(kMostVoxels) + "; use larger voxels");
  lowTile_ = tileOf(low);
  tileBox_ = tileOf(high) - lowTile_ + 1;
}

template <class Body>
void SplatPlaces::forEachTileOf(size_t n, const Body& body) const {
  glm::ivec3 low, high;
  if (anyShaped()) {
    const SplatFrame f = frameOf(n);
    low = tileOf(f.low) - lowTile_;
    high = tileOf(f.high) - lowTile_;
  } else {
    // At least a voxel, which a point's weights reach; a little more, so that rounding leaves out none.
    constexpr double kRoom = 1e-5;
    const double perTile = perVoxel_ / double(kTileEdge);
    const double reach =
        std::max(double(particles_.radius[n]) * perVoxel_, 1.0) * ((1.0 + kRoom) / double(kTileEdge)) + kRoom;
    const float place[] = {particles_.x[n], particles_.y[n], particles_.z[n]};
    for (int axis = 0; axis < 3; ++axis) {
      const double at = double(place[axis]) * perTile;
      low[axis] = floorToInt(at - reach) - lowTile_[axis];
      high[axis] = floorToInt(at + reach) - lowTile_[axis];
    }
    if (low == high) {  // most of those that are small beside a tile
      body((size_t(low.x) * size_t(tileBox_.y) + size_t(low.y)) * size_t(tileBox_.z) + size_t(low.z));
      return;
    }
  }
  for (int x = low.x; x <= high.x; ++x)
    for (int y = low.y; y <= high.y; ++y)
      for (int z = low.z; z <= high.z; ++z)
        body((size_t(x) * size_t(tileBox_.y) + size_t(y)) * size_t(tileBox_.z) + size_t(z));
}

void SplatPlaces::sortByTile() {
  const size_t count = particles_.size();
  const size_t tiles = size_t(tileBox_.x) * size_t(tileBox_.y) * size_t(tileBox_.z);
  const size_t chunks = chunksOf(count, tiles);
  std::vector<uint32_t> counts(chunks * tiles, 0);
  forEachChunk(count, chunks, [&](size_t c, size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) forEachTileOf(n, [&](size_t tile) { ++counts[c * tiles + tile]; });
  });
  // Counts become the place where each chunk begins to write its entries of each tile.
  uint64_t total = 0;
  for (size_t tile = 0; tile < tiles; ++tile) {
    const uint64_t start = total;
    for (size_t c = 0; c < chunks; ++c) {
      const uint32_t own = counts[c * tiles + tile];
      counts[c * tiles + tile] = uint32_t(total);
      total += own;
    }
    if (total == start) continue;
    tiles_.push_back(uint32_t(tile));
    starts_.push_back(start);
  }
  if (total > std::numeric_limits<uint32_t>::max())
    throw SplatError("the particles reach " + shown(double(total)) +
                     " tiles of 64^3 voxels; use larger voxels");
  starts_.push_back(total);
  entries_.resize(total);
  forEachChunk(count, chunks, [&](size_t c, size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n)
      forEachTileOf(n, [&](size_t tile) { entries_[counts[c * tiles + tile]++] = uint32_t(n); });
  });
}

glm::ivec3 SplatPlaces::tileOrigin(size_t tile) const {
  const int at = int(tiles_[tile]);
  const glm::ivec3 place(at / (tileBox_.y * tileBox_.z), at / tileBox_.z % tileBox_.y, at % tileBox_.z);
  return (lowTile_ + place) * kTileEdge;
}

std::span<const uint32_t> SplatPlaces::particlesOf(size_t tile) const {
  return std::span(entries_).subspan(starts_[tile], starts_[tile + 1] - starts_[tile]);
}

}  // namespace nephele
