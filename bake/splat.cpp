// Particles → sparse grids. Tiles of 64³ voxels are filled in parallel, each by its own particles in a fixed
// order, leaf by leaf; nothing is shared while they fill. Depends on the other splat files, volume, OpenVDB,
// TBB.
#include "bake/splat.h"

#include <openvdb/tools/Prune.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "bake/splat_batch.h"
#include "bake/splat_leaf.h"
#include "bake/splat_scales.h"
#include "bake/splat_shaped.h"
#include "bake/splat_tile.h"
#include "base/hash.h"
#include "volume/vdb_file.h"

namespace nephele {

struct SplatGrids {
  openvdb::GridCPtrVec all;  // density first
};

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
using openvdb::Coord;

// Particles that a tile takes in at a time: their records stay in the second cache, and their sums are added
// up apart, so that ten million particles in one voxel lose no digits.
constexpr size_t kBatch = 16384;

constexpr int kLeavesOfBlock = 64, kBlocksOfTile = kLeavesOfTile / kLeavesOfBlock;

/// Room for one tile's particles and voxels, which a thread keeps for its next tile. Voxels are all 0 between
/// tiles, but for what lies outside of the tile.
struct TileRoom {
  SplatBatch batch;
  std::vector<float> values =
      std::vector<float>(size_t(SplatTile::kEdge) * SplatTile::kEdge * SplatTile::kPitch, 0.0f);
  std::vector<uint8_t> touched = std::vector<uint8_t>(kLeavesOfTile, 0);

  /// Moves a leaf's rows to `to`, or adds them there.
  void take(const Coord& inTile, bool add, float* to) {
    for (int x = 0; x < kLeafEdge; ++x)
      for (int y = 0; y < kLeafEdge; ++y, to += kLeafEdge) {
        float* const from = values.data() +
                            ((inTile.x() + x) * SplatTile::kEdge + inTile.y() + y) * SplatTile::kPitch +
                            SplatTile::kBefore + inTile.z();
        if (add)
          for (int z = 0; z < kLeafEdge; ++z) to[z] += from[z];
        else
          std::memcpy(to, from, kLeafEdge * sizeof(float));
        std::memset(from, 0, kLeafEdge * sizeof(float));
      }
  }
};

class Splatter {
 public:
  Splatter(const SplatParticles& particles, const SplatSettings& settings)
      : particles_(particles),
        settings_(settings),
        places_(particles, settings),
        leaves_(settings),
        shaping_(particles, settings),
        sorter_(particles, settings, places_, scales_),
        extras_(leaves_.extras()) {}

  Splatted run() {
    scales_ = splatScales(particles_, settings_, places_, sorter_, shaping_);
    std::vector<TileResult> tiles(places_.tileCount());
    tbb::parallel_for(size_t(0), tiles.size(), [&](size_t t) { tiles[t] = fillTile(t); });
    return gather(tiles);
  }

 private:
  TileResult fillTile(size_t tile) const {
    const glm::ivec3 at = places_.tileOrigin(tile);
    const Coord origin(at.x, at.y, at.z);
    std::vector<OpenLeaf> leaves(kLeavesOfTile);
    const std::span<const uint32_t> all = places_.particlesOf(tile);
    TileRoom& room = rooms_.local();
    SplatBatch& batch = room.batch;
    const size_t batches = (all.size() + kBatch - 1) / kBatch;
    for (size_t b = 0; b < batches; ++b) {
      if (b > 0) takeAll(origin, room, leaves);
      const size_t begin = all.size() * b / batches, end = all.size() * (b + 1) / batches;
      batch.particles = all.subspan(begin, end - begin);
      sorter_.sort(at, batch);
      splatIntoTile(settings_.kernel, batch.small.data(), batch.smallOrder.data(), batch.small.size(),
                    {room.values.data(), room.touched.data()});
      if (batch.list.empty()) continue;
      forEachOf(kLeavesOfTile, batch.list.size(),
                [&](int leaf) { addToLeaf(batch, origin, leaf, leaves[size_t(leaf)]); });
      if (settings_.measure)
        forEachOf(kBlocksOfTile, batch.list.size(),
                  [&](int block) { addToBlock(batch, origin, block, leaves); });
    }
    TileResult result;
    std::vector<SplatLedger> ledgers(kLeavesOfTile);
    std::vector<float> maxima(kLeavesOfTile, 0.0f);
    forEachOf(kLeavesOfTile, all.size(), [&](int leaf) {
      const size_t n = size_t(leaf);
      takeLeaf(origin, leaf, room, leaves[n]);
      if (leaves[n].density) leaves_.close(originOf(origin, leaf), leaves[n], ledgers[n], maxima[n]);
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
      result.origins.expand(leaf.origin());
      result.constant = result.constant || leaf.isConstant(constantValue, constantState);
      result.leaves.emplace_back(int(n), std::move(leaves[n]));
    }
    return result;
  }

  /// Calls body(n) for each part of a tile, in parallel where there is much to do: a tile may hold most of
  /// the particles.
  template <class Body>
  static void forEachOf(int count, size_t work, const Body& body) {
    constexpr size_t kWorthSharing = 8192;
    if (work < kWorthSharing) {
      for (int n = 0; n < count; ++n) body(n);
      return;
    }
    // Isolated, so that a thread that waits here does not begin another tile.
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(0, count, body); });
  }

  static Coord originOf(const Coord& tile, int leaf) {
    return tile.offsetBy(leaf / (kTileLeaves * kTileLeaves) * kLeafEdge,
                         leaf / kTileLeaves % kTileLeaves * kLeafEdge, leaf % kTileLeaves * kLeafEdge);
  }

  /// Moves what small particles have given to the tile's voxels into its leaves.
  void takeAll(const Coord& tile, TileRoom& room, std::vector<OpenLeaf>& leaves) const {
    for (int leaf = 0; leaf < kLeavesOfTile; ++leaf) takeLeaf(tile, leaf, room, leaves[size_t(leaf)]);
  }

  void takeLeaf(const Coord& tile, int leaf, TileRoom& room, OpenLeaf& open) const {
    if (room.touched[size_t(leaf)] == 0) return;
    room.touched[size_t(leaf)] = 0;
    const bool there = bool(open.density);
    if (!there) leaves_.allocate(originOf(tile, leaf), open);
    room.take(originOf(Coord(0), leaf), there, open.density->buffer().data());
  }

  void addToLeaf(const SplatBatch& batch, const Coord& tile, int leaf, OpenLeaf& open) const {
    const size_t first = size_t(leaf * kSplatWays);
    if (batch.starts[first] == batch.starts[first + kSplatWays]) return;
    const Coord inTile = originOf(Coord(0), leaf), origin = tile + inTile;
    if (!isRead(origin)) return;
    if (!open.density) {
      leaves_.open(origin, open);
      addBatch(batch, origin, inTile, leaf,
               {open.density->buffer().data(), extras_ ? open.extras->values : nullptr});
      return;
    }
    float density[kLeafVoxels] = {};
    ExtraSums extras;
    if (extras_) std::memset(extras.values, 0, sizeof extras.values);
    addBatch(batch, origin, inTile, leaf, {density, extras_ ? extras.values : nullptr});
    float* const whole = open.density->buffer().data();
    for (int v = 0; v < kLeafVoxels; ++v) whole[v] += density[v];
    for (int e = 0; e < kExtraCount && extras_; ++e)
      for (int v = 0; v < kLeafVoxels; ++v) open.extras->values[e][v] += extras.values[e][v];
  }

  bool isRead(const Coord& leaf) const {
    return !settings_.measure || settings_.measure->only.ofLeaf({leaf.x(), leaf.y(), leaf.z()});
  }

  void addBatch(const SplatBatch& batch, const Coord& origin, const Coord& inTile, int leaf,
                const SplatLeaf& sums) const {
    const std::span<const uint32_t> round = batch.listOf(leaf, SplatWay::round);
    splatIntoLeaf(settings_.kernel, batch.records.data(), extras_ ? batch.extras.data() : nullptr,
                  round.data(), round.size(), inTile.data(), sums);
    for (const uint32_t k : batch.listOf(leaf, SplatWay::point)) addPoint(batch, k, inTile, sums);
    if (settings_.measure) return;  // shaped ones are added by blocks
    for (const uint32_t k : batch.listOf(leaf, SplatWay::shaped)) addShaped(batch, k, origin, sums);
  }

  /// Adds shaped particles to those voxels of a block of leaves that are read.
  void addToBlock(const SplatBatch& batch, const Coord& tile, int block,
                  std::vector<OpenLeaf>& leaves) const {
    std::vector<PartOfLeaf> parts;
    std::vector<char> reaches(batch.records.size(), 0);
    for (int n = 0; n < kLeavesOfBlock; ++n) {
      const int leaf = leafOfBlock(block, n);
      const std::span<const uint32_t> shaped = batch.listOf(leaf, SplatWay::shaped);
      OpenLeaf& open = leaves[size_t(leaf)];
      if (shaped.empty() || !open.density) continue;
      for (const uint32_t k : shaped) reaches[k] = 1;
      const Coord origin = originOf(tile, leaf);
      const glm::ivec3 at(origin.x(), origin.y(), origin.z());
      if (const auto read = settings_.measure->only.ofLeaf(at))
        parts.push_back({at, *read, open.density->buffer().data()});
    }
    if (parts.empty()) return;
    for (size_t k = 0; k < reaches.size(); ++k)
      if (reaches[k])
        shaping_.add(batch.owners[k], places_.frameOf(batch.owners[k]), batch.records[k].scale, parts);
  }

  /// Blocks of 4³ leaves, by eights that lie together.
  static int leafOfBlock(int block, int n) {
    const auto along = [&](int axis) {
      return (block >> axis & 1) << 2 | (n >> (axis + 3) & 1) << 1 | (n >> axis & 1);
    };
    return (along(2) * kTileLeaves + along(1)) * kTileLeaves + along(0);
  }

  void addWeight(const SplatBatch& batch, uint32_t k, int voxel, float weight, const SplatLeaf& sums) const {
    sums.density[voxel] += weight;
    for (int e = 0; e < kExtraCount && extras_; ++e)
      sums.extra[e][voxel] += weight * batch.extras[k].value[e];
  }

  /// Shares a point out over the eight voxels round it by trilinear weights, which keep mass and centre.
  void addPoint(const SplatBatch& batch, uint32_t k, const Coord& inTile, const SplatLeaf& sums) const {
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

  void addShaped(const SplatBatch& batch, uint32_t k, const Coord& origin, const SplatLeaf& sums) const {
    const size_t n = batch.owners[k];
    const SplatFrame f = places_.frameOf(n);
    float weights[kLeafVoxels];
    if (!shaping_.weights(n, f, {origin.x(), origin.y(), origin.z()}, weights)) return;
    for (int v = 0; v < kLeafVoxels; ++v)
      if (weights[v] > 0.0f) addWeight(batch, k, v, weights[v] * batch.records[k].scale, sums);
  }

  Splatted gather(std::vector<TileResult>& tiles) const {
    const double h = settings_.voxelSize, volume = h * h * h;
    auto grids = std::make_shared<SplatGrids>();
    const auto density = makeFogGrid("density", h, settings_.half);
    const auto temperature = settings_.temperature ? makeFogGrid("temperature", h, settings_.half) : nullptr;
    const auto age = settings_.age ? makeFogGrid("age", h, settings_.half) : nullptr;
    const auto velocity = settings_.vel ? makeVelocityGrid(h, settings_.half) : nullptr;
    Splatted result;
    result.ledger.given = places_.mass();
    uint64_t count = 0;
    openvdb::CoordBBox active = activeBoxOf(tiles);
    bool constant = false;
    for (const TileResult& tile : tiles) {
      count += tile.active;
      constant = constant || tile.constant;
      result.ledger.splatted += tile.ledger.splatted * volume;
      result.ledger.lostToCutoff += tile.ledger.lostToCutoff * volume;
      result.ledger.stored += tile.ledger.stored * volume;
      result.maximum = std::max(result.maximum, double(tile.maximum));
    }
    addLeaves(density->tree(), tiles, &OpenLeaf::density);
    if (temperature) addLeaves(temperature->tree(), tiles, &OpenLeaf::temperature);
    if (age) addLeaves(age->tree(), tiles, &OpenLeaf::age);
    if (velocity) addLeaves(velocity->tree(), tiles, &OpenLeaf::velocity);
    if (settings_.box) result.ledger.outsideBox = result.ledger.given - result.ledger.splatted;
    result.ledger.lostToHalf = result.ledger.splatted - result.ledger.lostToCutoff - result.ledger.stored;
    if (constant) openvdb::tools::prune(density->tree());
    close(*density, *grids, result);
    if (settings_.box)
      for (const Coord& corner : {leaves_.box().min(), leaves_.box().max()}) active.expand(corner);
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
      for (const Coord& corner : {leaves_.box().min(), leaves_.box().max()})
        grid.tree().setActiveState(corner, true);
    // Blender 3.4 draws nothing for a grid that holds active tiles alone.
    if (grid.tree().leafCount() == 0) grid.tree().voxelizeActiveTiles();
    result.gridBytes += bytesOf(grid.tree());
    grids.all.push_back(grid.copyGrid());  // shares the tree
  }

  const SplatParticles& particles_;
  const SplatSettings& settings_;
  const SplatPlaces places_;
  mutable tbb::enumerable_thread_specific<TileRoom> rooms_;
  std::vector<float> scales_;
  const SplatLeaves leaves_;
  SplatShaping shaping_;
  const SplatSorter sorter_;
  const bool extras_;
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

BrickVolume bricksOf(const Splatted& splatted) {
  return bricksFromGrid(static_cast<const openvdb::FloatGrid&>(*splatted.grids->all.front()));
}

uint64_t writeSplatted(const std::string& path, const Splatted& splatted, const Provenance& provenance) {
  Provenance complete = provenance;
  complete.mass = splatted.ledger.stored;
  return writeVdb(path, splatted.grids->all, complete);
}

}  // namespace nephele
