// Particles → sparse grids. Tiles of 64³ voxels are filled in parallel, each by its own particles in a fixed
// order, leaf by leaf; nothing is shared while they fill. Depends on splat_places, splat_kernels, volume,
// OpenVDB, TBB.
#include "bake/splat.h"

#include <openvdb/tools/Prune.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "bake/splat_places.h"
#include "bake/voxelize_kernels.h"
#include "base/hash.h"
#include "volume/vdb_file.h"

namespace nephele {

struct SplatGrids {
  openvdb::GridCPtrVec all;  // density first
};

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
using VelocityLeaf = openvdb::Vec3STree::LeafNodeType;
using openvdb::Coord;

constexpr int kTileLeaves = kTileEdge / kLeafEdge;
constexpr int kLeavesOfTile = kTileLeaves * kTileLeaves * kTileLeaves;
constexpr int kWays = 3;
// Particles that a tile takes in at a time: their records stay in the second cache, and their sums are added
// up apart, so that ten million particles in one voxel lose no digits.
constexpr size_t kBatch = 16384;
constexpr int kExtraCount = 5;
constexpr float kHalfLargest = 65504.0f;
constexpr int kWordBits = 64;

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Sums of the grids beside density.
struct ExtraSums {
  float values[kExtraCount][kLeafVoxels];
};

/// One leaf while it fills, then what it becomes.
struct OpenLeaf {
  std::unique_ptr<Leaf> density, temperature, age;
  std::unique_ptr<VelocityLeaf> velocity;
  std::unique_ptr<ExtraSums> extras;
};

/// Room for one tile's voxels, which a thread keeps for its next tile. All 0 between tiles, but for what lies
/// outside of the tile.
struct TileRoom {
  std::vector<float> values =
      std::vector<float>(size_t(SplatTile::kEdge) * SplatTile::kEdge * SplatTile::kPitch, 0.0f);
  std::vector<uint8_t> touched = std::vector<uint8_t>(kLeavesOfTile, 0);
};

struct TileResult {
  std::vector<std::pair<int, OpenLeaf>> leaves;  // by growing number
  SplatLedger ledger;
  float maximum = 0.0f;
  uint64_t active = 0;
  openvdb::CoordBBox box;  // of active voxels
  bool constant = false;   // whether a leaf holds one value alone, so that there is something to prune
};

class Splatter {
 public:
  Splatter(const SplatParticles& particles, const SplatSettings& settings)
      : particles_(particles),
        settings_(settings),
        places_(particles, settings),
        extras_(settings.vel || settings.temperature || settings.age),
        shaped_(places_.anyShaped()) {
    if (settings_.box) {
      const double h = settings_.voxelSize;
      for (int axis = 0; axis < 3; ++axis) {
        box_.min()[axis] = int(std::ceil(settings_.box->low[axis] / h));
        box_.max()[axis] = int(std::floor(settings_.box->high[axis] / h));
      }
    }
  }

  Splatted run() {
    findScales();
    std::vector<TileResult> tiles(places_.tileCount());
    tbb::parallel_for(size_t(0), tiles.size(), [&](size_t t) { tiles[t] = fillTile(t); });
    return gather(tiles);
  }

 private:
  /// What each particle's kernel is multiplied by: its mass over the voxel's volume and the kernel's sum.
  void findScales() {
    scales_.resize(particles_.size());
    const double volume = settings_.voxelSize * settings_.voxelSize * settings_.voxelSize;
    constexpr size_t kAtOnce = 256;
    tbb::parallel_for(size_t(0), (particles_.size() + kAtOnce - 1) / kAtOnce, [&](size_t block) {
      const size_t begin = block * kAtOnce, end = std::min(particles_.size(), begin + kAtOnce);
      SplatRecord records[kAtOnce]{};
      size_t owner[kAtOnce], count = 0;
      double sums[kAtOnce];
      for (size_t n = begin; n < end; ++n) {
        const double density = double(particles_.mass[n]) / volume;
        if (shaped_) {
          const SplatFrame f = places_.frameOf(n);
          if (f.way == SplatWay::shaped) {
            const double sum = shapedSum(n, f);
            // Where noise has eaten all of it, it is kept as a point.
            scales_[n] = sum > 0.0 ? float(density / sum) : -float(density);
            continue;
          }
        }
        const SplatRecord record = places_.placeOf(n);
        scales_[n] = float(density);
        if (record.radius <= 1.0f || isSmall(record)) continue;
        owner[count] = n;
        records[count++] = record;
      }
      splatSums(settings_.kernel, records, count, sums);
      for (size_t k = 0; k < count; ++k)
        scales_[owner[k]] = float(double(particles_.mass[owner[k]]) / volume / sums[k]);
    });
  }

  /// Whether a tile takes the particle whole, and scales its kernel itself.
  bool isSmall(const SplatRecord& record) const {
    return !extras_ && !shaped_ && record.radius > 1.0f && record.radius <= SplatTile::kWidest;
  }

  /// The field on the voxels from `origin` in the particle's own frame, or null where nothing erodes.
  const float* fieldAt(size_t n, const SplatFrame& f, const Coord& origin, float* values) const {
    if (f.shape.erosion == 0.0f) return nullptr;
    float x[kLeafVoxels], y[kLeafVoxels], z[kLeafVoxels];
    for (int v = 0; v < kLeafVoxels; ++v) {
      const Coord at = origin + Leaf::offsetToLocalCoord(openvdb::Index(v));
      x[v] = (float(at.x() - f.record.cell[0]) - f.record.rest[0]) / f.record.radius;
      y[v] = (float(at.y() - f.record.cell[1]) - f.record.rest[1]) / f.record.radius;
      z[v] = (float(at.z() - f.record.cell[2]) - f.record.rest[2]) / f.record.radius;
    }
    // Each particle lies elsewhere in the field, by up to 1024 radii.
    constexpr uint32_t kTenBits = 1023;
    const uint32_t h = motion::hashBits(particles_.id.empty() ? uint32_t(n) : particles_.id[n]);
    const glm::dvec3 elsewhere(h & kTenBits, (h >> 10) & kTenBits, (h >> 20) & kTenBits);
    settings_.erosion->evaluate(Points{elsewhere, size_t(kLeafVoxels), x, y, z}, values);
    return values;
  }

  /// False where no voxel of the leaf can be within reach of the line that the particle is drawn along.
  static bool mayReach(const SplatFrame& f, const Coord& origin) {
    constexpr float kToCentre = 3.5f, kToCorner = 6.0622f;  // half of 7 voxels, and √3 of that
    float apart[3], dotted = 0.0f, length = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      apart[axis] = float(origin[axis] - f.record.cell[axis]) + kToCentre - f.record.rest[axis];
      dotted += apart[axis] * f.shape.stretch[axis];
      length += f.shape.stretch[axis] * f.shape.stretch[axis];
    }
    const float t = length > 0.0f ? std::clamp(dotted / length, -0.5f, 0.5f) : 0.0f;
    float squared = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      const float e = apart[axis] - t * f.shape.stretch[axis];
      squared += e * e;
    }
    const float reach = (f.record.radius + kToCorner) * 1.001f;  // room for rounding
    return squared <= reach * reach;
  }

  double shapedSum(size_t n, const SplatFrame& f) const {
    double sum = 0.0;
    float weights[kLeafVoxels], field[kLeafVoxels];
    for (int x = f.low.x & ~(kLeafEdge - 1); x <= f.high.x; x += kLeafEdge)
      for (int y = f.low.y & ~(kLeafEdge - 1); y <= f.high.y; y += kLeafEdge)
        for (int z = f.low.z & ~(kLeafEdge - 1); z <= f.high.z; z += kLeafEdge) {
          const Coord origin(x, y, z);
          if (!mayReach(f, origin)) continue;
          sum += splatShaped(settings_.kernel, f.record, f.shape, origin.data(), fieldAt(n, f, origin, field),
                             weights);
        }
    return sum;
  }

  /// The leaves of a tile that a particle reaches, and the way it takes there.
  struct Reach {
    uint8_t low[3], high[3], way;

    bool empty() const { return low[0] > high[0] || low[1] > high[1] || low[2] > high[2]; }
    /// Calls body with the number of the list that each leaf has for this way.
    template <class Body>
    void forEachList(const Body& body) const {
      for (int x = low[0]; x <= high[0]; ++x)
        for (int y = low[1]; y <= high[1]; ++y)
          for (int z = low[2]; z <= high[2]; ++z)
            body(size_t(((x * kTileLeaves + y) * kTileLeaves + z) * kWays + way));
    }
  };

  /// Particles of one batch of a tile, and for each leaf and way those that reach it.
  struct Batch {
    std::span<const uint32_t> particles;
    std::vector<SplatRecord> records;             // those that leaves take, cells in the tile's frame
    std::vector<uint32_t> owners;                 // the particle of each record
    std::vector<SplatRecord> small, smallSorted;  // those that the tile takes whole, by place along x
    std::vector<SplatExtras> extras;
    std::vector<uint32_t> starts, list;
  };

  TileResult fillTile(size_t tile) const {
    const glm::ivec3 at = places_.tileOrigin(tile);
    const Coord origin(at.x, at.y, at.z);
    std::vector<OpenLeaf> leaves(kLeavesOfTile);
    const std::span<const uint32_t> all = places_.particlesOf(tile);
    Batch batch;
    const size_t batches = (all.size() + kBatch - 1) / kBatch;
    for (size_t b = 0; b < batches; ++b) {
      const size_t begin = all.size() * b / batches, end = all.size() * (b + 1) / batches;
      batch.particles = all.subspan(begin, end - begin);
      sortByLeaf(origin, batch);
      addSmall(batch, origin, leaves);
      forEachLeaf(batch.list.size(), [&](int leaf) { addToLeaf(batch, origin, leaf, leaves[size_t(leaf)]); });
    }
    TileResult result;
    std::vector<SplatLedger> ledgers(kLeavesOfTile);
    std::vector<float> maxima(kLeavesOfTile, 0.0f);
    forEachLeaf(all.size(), [&](int leaf) {
      const size_t n = size_t(leaf);
      if (leaves[n].density) closeLeaf(originOf(origin, leaf), leaves[n], ledgers[n], maxima[n]);
    });
    float constantValue = 0.0f;
    bool constantState = false;
    for (size_t n = 0; n < leaves.size(); ++n) {
      result.ledger.splatted += ledgers[n].splatted;
      result.ledger.lostToCutoff += ledgers[n].lostToCutoff;
      result.ledger.stored += ledgers[n].stored;
      result.maximum = std::max(result.maximum, maxima[n]);
      if (!leaves[n].density) continue;
      const Leaf& leaf = *leaves[n].density;
      result.active += leaf.onVoxelCount();
      leaf.evalActiveBoundingBox(result.box);  // looks at voxels only where the leaf lies outside the box
      result.constant = result.constant || leaf.isConstant(constantValue, constantState);
      result.leaves.emplace_back(int(n), std::move(leaves[n]));
    }
    return result;
  }

  /// Calls body(leaf) for each leaf of a tile, in parallel where there is much to do: a tile may hold most of
  /// the particles.
  template <class Body>
  static void forEachLeaf(size_t work, const Body& body) {
    constexpr size_t kWorthSharing = 8192;
    if (work < kWorthSharing) {
      for (int leaf = 0; leaf < kLeavesOfTile; ++leaf) body(leaf);
      return;
    }
    // Isolated, so that a thread that waits here does not begin another tile.
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(0, kLeavesOfTile, body); });
  }

  static Coord originOf(const Coord& tile, int leaf) {
    return tile.offsetBy(leaf / (kTileLeaves * kTileLeaves) * kLeafEdge,
                         leaf / kTileLeaves % kTileLeaves * kLeafEdge, leaf % kTileLeaves * kLeafEdge);
  }

  void sortByLeaf(const Coord& tile, Batch& batch) const {
    batch.records.clear();
    batch.owners.clear();
    batch.small.clear();
    batch.extras.clear();
    std::vector<Reach> reaches;
    batch.starts.assign(size_t(kLeavesOfTile * kWays) + 1, 0);
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
        if (!reach.empty()) batch.small.push_back(record);
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
  }

  /// The particle in a tile's frame, and the leaves of the tile that it reaches.
  SplatRecord recordOf(size_t n, const Coord& tile, Reach& reach) const {
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

  /// Adds the batch's small particles through one array, plane after plane along x, so that what they touch
  /// stays near.
  void addSmall(Batch& batch, const Coord& tile, std::vector<OpenLeaf>& leaves) const {
    if (batch.small.empty()) return;
    sortAlongX(batch);
    TileRoom& room = rooms_.local();
    splatIntoTile(settings_.kernel, batch.smallSorted.data(), batch.smallSorted.size(),
                  {room.values.data(), room.touched.data()});
    for (int leaf = 0; leaf < kLeavesOfTile; ++leaf) {
      if (room.touched[size_t(leaf)] == 0) continue;
      room.touched[size_t(leaf)] = 0;
      OpenLeaf& open = leaves[size_t(leaf)];
      const Coord at = originOf(Coord(0), leaf);
      const bool fresh = !open.density;
      if (fresh) openLeaf(tile + at, open);
      float* to = open.density->buffer().data();
      for (int x = 0; x < kLeafEdge; ++x)
        for (int y = 0; y < kLeafEdge; ++y, to += kLeafEdge) {
          float* const from = room.values.data() +
                              ((at.x() + x) * SplatTile::kEdge + at.y() + y) * SplatTile::kPitch +
                              SplatTile::kBefore + at.z();
          if (fresh)
            std::memcpy(to, from, kLeafEdge * sizeof(float));
          else
            for (int z = 0; z < kLeafEdge; ++z) to[z] += from[z];
          std::memset(from, 0, kLeafEdge * sizeof(float));
        }
    }
  }

  /// A stable counting sort by cell: equal cells keep their order.
  static void sortAlongX(Batch& batch) {
    // Cells of small particles lie up to their reach outside the tile.
    constexpr int kOutside = 8;
    std::array<uint32_t, kTileEdge + 2 * kOutside + 1> next{};
    for (const SplatRecord& p : batch.small) ++next[size_t(p.cell[0] + kOutside) + 1];
    for (size_t n = 1; n < next.size(); ++n) next[n] += next[n - 1];
    batch.smallSorted.resize(batch.small.size());
    for (const SplatRecord& p : batch.small) batch.smallSorted[next[size_t(p.cell[0] + kOutside)]++] = p;
  }

  void openLeaf(const Coord& origin, OpenLeaf& open) const {
    open.density = std::make_unique<Leaf>(openvdb::PartialCreate(), origin, 0.0f);
    open.density->allocate();
    std::memset(open.density->buffer().data(), 0, kLeafVoxels * sizeof(float));
    if (extras_) open.extras = std::make_unique<ExtraSums>();  // all 0
  }

  SplatExtras extrasOf(size_t n) const {
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

  std::span<const uint32_t> listOf(const Batch& batch, int leaf, SplatWay way) const {
    const size_t list = size_t(leaf * kWays + int(way));
    return std::span(batch.list).subspan(batch.starts[list], batch.starts[list + 1] - batch.starts[list]);
  }

  void addToLeaf(const Batch& batch, const Coord& tile, int leaf, OpenLeaf& open) const {
    const size_t first = size_t(leaf * kWays);
    if (batch.starts[first] == batch.starts[first + kWays]) return;
    const Coord inTile = originOf(Coord(0), leaf);
    if (!open.density) {
      openLeaf(tile + inTile, open);
      addBatch(batch, tile, inTile, leaf,
               {open.density->buffer().data(), extras_ ? open.extras->values : nullptr});
      return;
    }
    float density[kLeafVoxels] = {};
    ExtraSums extras;
    if (extras_) std::memset(extras.values, 0, sizeof extras.values);
    addBatch(batch, tile, inTile, leaf, {density, extras_ ? extras.values : nullptr});
    float* const whole = open.density->buffer().data();
    for (int v = 0; v < kLeafVoxels; ++v) whole[v] += density[v];
    for (int e = 0; e < kExtraCount && extras_; ++e)
      for (int v = 0; v < kLeafVoxels; ++v) open.extras->values[e][v] += extras.values[e][v];
  }

  void addBatch(const Batch& batch, const Coord& tile, const Coord& inTile, int leaf,
                const SplatLeaf& sums) const {
    const std::span<const uint32_t> round = listOf(batch, leaf, SplatWay::round);
    splatIntoLeaf(settings_.kernel, batch.records.data(), extras_ ? batch.extras.data() : nullptr,
                  round.data(), round.size(), inTile.data(), sums);
    for (const uint32_t k : listOf(batch, leaf, SplatWay::point)) addPoint(batch, k, inTile, sums);
    for (const uint32_t k : listOf(batch, leaf, SplatWay::shaped)) addShaped(batch, k, tile, inTile, sums);
  }

  void addWeight(const Batch& batch, uint32_t k, int voxel, float weight, const SplatLeaf& sums) const {
    sums.density[voxel] += weight;
    for (int e = 0; e < kExtraCount && extras_; ++e)
      sums.extra[e][voxel] += weight * batch.extras[k].value[e];
  }

  /// Shares a point out over the eight voxels round it by trilinear weights, which keep mass and centre.
  void addPoint(const Batch& batch, uint32_t k, const Coord& inTile, const SplatLeaf& sums) const {
    const SplatRecord& p = batch.records[k];
    for (int corner = 0; corner < 8; ++corner) {
      const int step[] = {corner >> 2, (corner >> 1) & 1, corner & 1};
      float weight = p.scale;
      int at[3];
      bool inside = true;
      for (int axis = 0; axis < 3; ++axis) {
        weight *= step[axis] == 1 ? p.rest[axis] : 1.0f - p.rest[axis];
        at[axis] = p.cell[axis] + step[axis] - inTile[axis];
        inside = inside && at[axis] >= 0 && at[axis] < kLeafEdge;
      }
      if (inside) addWeight(batch, k, (at[0] * kLeafEdge + at[1]) * kLeafEdge + at[2], weight, sums);
    }
  }

  void addShaped(const Batch& batch, uint32_t k, const Coord& tile, const Coord& inTile,
                 const SplatLeaf& sums) const {
    const size_t n = batch.owners[k];
    const SplatFrame f = places_.frameOf(n);
    const Coord origin = tile + inTile;
    if (!mayReach(f, origin)) return;
    float weights[kLeafVoxels], field[kLeafVoxels];
    const double sum = splatShaped(settings_.kernel, f.record, f.shape, origin.data(),
                                   fieldAt(n, f, origin, field), weights);
    if (sum == 0.0) return;
    for (int v = 0; v < kLeafVoxels; ++v)
      if (weights[v] > 0.0f) addWeight(batch, k, v, weights[v] * batch.records[k].scale, sums);
  }

  /// Turns sums into what the file stores, and adds up the masses, in units of a voxel's volume.
  void closeLeaf(const Coord& origin, OpenLeaf& open, SplatLedger& ledger, float& maximum) const {
    float* const values = open.density->buffer().data();
    if (settings_.box) cutToBox(origin, values);
    const LeafRules rules{float(settings_.cutoff),
                          settings_.half ? kHalfLargest : std::numeric_limits<float>::max(), settings_.half};
    float sums[kLeafVoxels];
    std::copy_n(values, kLeafVoxels, sums);
    const LeafScan scan = scanLeaf(rules, values);
    if (!scan.storable) refuseUnstorable(origin, sums, rules.limit);
    const SplatLosses losses = splatLosses(sums, values, rules.cutoff);
    ledger.splatted = losses.before;
    ledger.lostToCutoff = losses.cut;
    ledger.stored = losses.before - losses.cut - losses.rounded;
    maximum = scan.maximum;
    if (!scan.active) {
      open.density.reset();
      return;
    }
    Leaf::NodeMaskType mask;
    for (int word = 0; word < kLeafVoxels / kWordBits; ++word)
      mask.getWord<uint64_t>(openvdb::Index(word)) = scan.mask[word];
    open.density->setValueMask(mask);
    if (extras_) closeExtras(origin, mask, sums, open);
  }

  static std::unique_ptr<Leaf> leafOf(const Coord& origin, const Leaf::NodeMaskType& mask,
                                      const float* values) {
    auto leaf = std::make_unique<Leaf>(openvdb::PartialCreate(), origin, 0.0f);
    leaf->allocate();
    std::copy_n(values, kLeafVoxels, leaf->buffer().data());
    leaf->setValueMask(mask);
    return leaf;
  }

  /// Means weighted by density, where density is stored.
  void closeExtras(const Coord& origin, const Leaf::NodeMaskType& mask, const float* density,
                   OpenLeaf& open) const {
    auto& values = open.extras->values;
    for (auto& extra : values) {
      for (int v = 0; v < kLeafVoxels; ++v)
        extra[v] = mask.isOn(openvdb::Index(v)) ? extra[v] / density[v] : 0.0f;
      if (!settings_.half) continue;
      for (int v = 0; v < kLeafVoxels; ++v)
        if (std::abs(extra[v]) > kHalfLargest)
          throw SplatError("a velocity, temperature or age reaches " + shown(double(extra[v])) +
                           ", more than half precision holds (65504); ask for 'precision: float'");
      roundToHalf(extra, kLeafVoxels);
    }
    if (settings_.vel) {
      open.velocity = std::make_unique<VelocityLeaf>(openvdb::PartialCreate(), origin, openvdb::Vec3s(0.0f));
      open.velocity->allocate();
      for (int v = 0; v < kLeafVoxels; ++v)
        open.velocity->buffer().data()[v] = openvdb::Vec3s(values[0][v], values[1][v], values[2][v]);
      open.velocity->setValueMask(mask);
    }
    if (settings_.temperature) open.temperature = leafOf(origin, mask, values[3]);
    if (settings_.age) open.age = leafOf(origin, mask, values[4]);
    open.extras.reset();
  }

  [[noreturn]] void refuseUnstorable(const Coord& origin, const float* values, float limit) const {
    int v = 0;
    while (v < kLeafVoxels - 1 && values[v] <= limit) ++v;
    const Coord at = origin + Leaf::offsetToLocalCoord(openvdb::Index(v));
    const double h = settings_.voxelSize;
    throw SplatError(
        "the density reaches " + shown(double(values[v])) + " at (" + shown(at.x() * h) + ", " +
        shown(at.y() * h) + ", " + shown(at.z() * h) + "), more than " +
        (settings_.half ? "half precision holds (65504); ask for 'precision: float'" : "a float holds"));
  }

  void cutToBox(const Coord& origin, float* values) const {
    if (box_.isInside(openvdb::CoordBBox::createCube(origin, kLeafEdge))) return;
    for (int v = 0; v < kLeafVoxels; ++v)
      if (!box_.isInside(origin + Leaf::offsetToLocalCoord(openvdb::Index(v)))) values[v] = 0.0f;
  }

  Splatted gather(std::vector<TileResult>& tiles) const {
    const double h = settings_.voxelSize, volume = h * h * h;
    auto grids = std::make_shared<SplatGrids>();
    const auto density = makeFogGrid("density", h, settings_.half);
    const auto temperature = settings_.temperature ? makeFogGrid("temperature", h, settings_.half) : nullptr;
    const auto age = settings_.age ? makeFogGrid("age", h, settings_.half) : nullptr;
    const auto velocity = settings_.vel ? makeVelocityGrid(h, settings_.half) : nullptr;
    openvdb::tree::ValueAccessor<openvdb::FloatTree> into(density->tree());
    Splatted result;
    for (const float mass : particles_.mass) result.ledger.given += double(mass);
    uint64_t count = 0;
    openvdb::CoordBBox active;
    bool constant = false;
    for (size_t t = 0; t < tiles.size(); ++t) {
      count += tiles[t].active;
      constant = constant || tiles[t].constant;
      if (!tiles[t].box.empty()) active.expand(tiles[t].box);
      result.ledger.splatted += tiles[t].ledger.splatted * volume;
      result.ledger.lostToCutoff += tiles[t].ledger.lostToCutoff * volume;
      result.ledger.stored += tiles[t].ledger.stored * volume;
      result.maximum = std::max(result.maximum, double(tiles[t].maximum));
      for (auto& [number, leaf] : tiles[t].leaves) {
        into.addLeaf(leaf.density.release());
        if (leaf.temperature) temperature->tree().addLeaf(leaf.temperature.release());
        if (leaf.age) age->tree().addLeaf(leaf.age.release());
        if (leaf.velocity) velocity->tree().addLeaf(leaf.velocity.release());
      }
    }
    if (settings_.box) result.ledger.outsideBox = result.ledger.given - result.ledger.splatted;
    result.ledger.lostToHalf = result.ledger.splatted - result.ledger.lostToCutoff - result.ledger.stored;
    if (constant) openvdb::tools::prune(density->tree());
    close(*density, *grids, result);
    if (settings_.box)
      for (const Coord& corner : {box_.min(), box_.max()}) active.expand(corner);
    result.voxelsActive = count;
    if (!active.empty()) {
      const Coord size = active.dim();
      result.longestAxis = std::max({size.x(), size.y(), size.z()});
    }
    const auto closeBeside = [&](const auto& grid) {
      if (!grid) return;
      openvdb::tools::prune(grid->tree());
      close(*grid, *grids, result);
    };
    closeBeside(velocity);
    closeBeside(temperature);
    closeBeside(age);
    result.grids = std::move(grids);
    return result;
  }

  /// What a tree's nodes take, all leaves being in memory, without looking at each of them.
  template <class Tree>
  static uint64_t bytesOf(const Tree& tree) {
    using Upper = typename Tree::RootNodeType::ChildNodeType;
    using Lower = typename Upper::ChildNodeType;
    using LeafNode = typename Tree::LeafNodeType;
    constexpr uint64_t kLeafBytes = sizeof(LeafNode) + kLeafVoxels * sizeof(typename Tree::ValueType);
    const std::vector<openvdb::Index32> counts = tree.nodeCount();  // leaves first
    return sizeof(Tree) + counts[0] * kLeafBytes + counts[1] * sizeof(Lower) + counts[2] * sizeof(Upper);
  }

  template <class Grid>
  void close(Grid& grid, SplatGrids& grids, Splatted& result) const {
    // Active corners give every frame the same box.
    if (settings_.box)
      for (const Coord& corner : {box_.min(), box_.max()}) grid.tree().setActiveState(corner, true);
    // Blender 3.4 draws nothing for a grid that holds active tiles alone.
    if (grid.tree().leafCount() == 0) grid.tree().voxelizeActiveTiles();
    result.gridBytes += bytesOf(grid.tree());
    grids.all.push_back(grid.copyGrid());  // shares the tree
  }

  const SplatParticles& particles_;
  const SplatSettings& settings_;
  const SplatPlaces places_;
  const bool extras_, shaped_;
  openvdb::CoordBBox box_;
  mutable tbb::enumerable_thread_specific<TileRoom> rooms_;
  std::vector<float> scales_;  // below 0: a point, since noise left nothing else
};

}  // namespace

Splatted splat(const SplatParticles& particles, const SplatSettings& settings) {
  return Splatter(particles, settings).run();
}

std::string contentHashOf(const Splatted& splatted, const std::string& name) {
  Hasher joined;
  for (const auto& grid : splatted.grids->all) {
    if (grid->getName() == name) return contentHash(*grid);
    if (name.empty()) joined.text(contentHash(*grid));
  }
  return name.empty() ? joined.hex() : std::string();
}

uint64_t writeSplatted(const std::string& path, const Splatted& splatted, const Provenance& provenance) {
  Provenance complete = provenance;
  complete.mass = splatted.ledger.stored;
  return writeVdb(path, splatted.grids->all, complete);
}

}  // namespace nephele
