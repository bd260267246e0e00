// The content hash of one grid, piece by piece: for grids that are never whole in memory. Includes OpenVDB:
// only bake/voxelize, bake/splat and volume may include this.
#pragma once

#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "base/hash.h"

namespace nephele {

/// Name, type, class and transform, which the hash begins with.
void hashGridHead(Hasher& hasher, const openvdb::GridBase& grid);

/// Takes active tiles in any order and leaves in ascending order of their origins; what is handed over may be
/// gone afterwards. The hash is that of the tree pruned at tolerance 0: leaves and tiles that merge there
/// count as merged, leaves without active voxels not at all. Not thread-safe; works in parallel itself.
template <class Tree>
class ContentHasher {
 public:
  using Leaf = typename Tree::LeafNodeType;
  using Value = typename Tree::ValueType;

  explicit ContentHasher(const openvdb::GridBase& grid) { hashGridHead(head_, grid); }

  /// A tile of `edge` voxels: 8, 128 or 4096.
  void tile(const openvdb::Coord& origin, int edge, const Value& value) {
    (edge == kEdges[0] ? tiles_[0] : edge == kEdges[1] ? tiles_[1] : tiles_[2]).push_back({origin, value});
  }

  void leaves(const std::vector<const Leaf*>& leaves) {
    std::vector<const Leaf*> kept;
    for (const Leaf* leaf : leaves) {
      if (leaf->isInactive()) continue;
      if (isConstant(*leaf))
        tiles_[0].push_back({leaf->origin(), leaf->getValue(0)});
      else
        kept.push_back(leaf);
    }
    size_t next = 0;
    while (next < kept.size() && inDigest_ > 0) take(*kept[next++]);
    const size_t whole = (kept.size() - next) / kLeavesPerDigest, first = digests_.size();
    digests_.resize(first + whole);
    tbb::parallel_for(size_t{0}, whole, [&](size_t d) {
      Hasher part;
      for (size_t n = 0; n < kLeavesPerDigest; ++n) hashLeaf(part, *kept[next + d * kLeavesPerDigest + n]);
      digests_[first + d] = part.hex();
    });
    leafCount_ += whole * kLeavesPerDigest;
    for (next += whole * kLeavesPerDigest; next < kept.size(); ++next) take(*kept[next]);
  }

  /// 32 hex digits. Nothing may be added afterwards.
  std::string finish() {
    for (size_t level = 0; level + 1 < kEdges.size(); ++level) merge(level);
    hashTiles();
    if (inDigest_ > 0) digests_.push_back(digest_->hex());
    head_.value(leafCount_);
    for (const std::string& digest : digests_) head_.text(digest);
    return head_.hex();
  }

 private:
  struct Tile {
    openvdb::Coord origin;
    Value value;
  };

  using Inner = typename Tree::RootNodeType::ChildNodeType;
  static constexpr std::array<int, 3> kEdges{int(Leaf::DIM), int(Inner::ChildNodeType::DIM), int(Inner::DIM)};
  // Fixed, so that the hash does not depend on how threads divide the work.
  static constexpr size_t kLeavesPerDigest = 64;

  /// The value as it is hashed: −0 as 0.
  template <class T>
  static T canonical(const T& value) {
    if constexpr (std::is_floating_point_v<T>)
      return value == T(0) ? T(0) : value;
    else if constexpr (openvdb::VecTraits<T>::IsVec)
      return T(canonical(value[0]), canonical(value[1]), canonical(value[2]));
    else
      return value;
  }

  static void hashCoord(Hasher& hasher, const openvdb::Coord& c) {
    hasher.value(std::array<int32_t, 3>{c.x(), c.y(), c.z()});
  }

  static bool isConstant(const Leaf& leaf) {
    if (!leaf.getValueMask().isOn()) return false;
    for (openvdb::Index i = 1; i < Leaf::SIZE; ++i)
      if (!(leaf.getValue(i) == leaf.getValue(0))) return false;
    return leaf.getValue(0) == leaf.getValue(0);  // NaN merges with nothing
  }

  static void hashLeaf(Hasher& hasher, const Leaf& leaf) {
    hashCoord(hasher, leaf.origin());
    hasher.bytes(&leaf.getValueMask(), sizeof(typename Leaf::NodeMaskType));
    using Stored = std::conditional_t<std::is_same_v<Value, bool>, unsigned char, Value>;
    std::array<Stored, Leaf::SIZE> values;
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) values[i] = Stored(canonical(leaf.getValue(i)));
    hasher.bytes(values.data(), sizeof values);
  }

  /// Adds a leaf to the digest that is being filled.
  void take(const Leaf& leaf) {
    if (inDigest_ == 0) digest_ = std::make_unique<Hasher>();
    hashLeaf(*digest_, leaf);
    ++leafCount_;
    if (++inDigest_ < kLeavesPerDigest) return;
    digests_.push_back(digest_->hex());
    inDigest_ = 0;
  }

  /// Tiles of a level that fill a cube of the next with one value become one of that.
  void merge(size_t level) {
    const int edge = kEdges[level + 1];
    const auto cubeOf = [edge](const Tile& tile) { return tile.origin & ~(edge - 1); };
    const size_t perEdge = size_t(edge / kEdges[level]), full = perEdge * perEdge * perEdge;
    std::vector<Tile>& tiles = tiles_[level];
    std::sort(tiles.begin(), tiles.end(),
              [&](const Tile& a, const Tile& b) { return cubeOf(a) < cubeOf(b); });
    std::vector<Tile> kept;
    for (size_t n = 0; n < tiles.size();) {
      size_t end = n;
      bool alike = true;
      for (; end < tiles.size() && cubeOf(tiles[end]) == cubeOf(tiles[n]); ++end)
        alike = alike && tiles[end].value == tiles[n].value;
      if (alike && end - n == full)
        tiles_[level + 1].push_back({cubeOf(tiles[n]), tiles[n].value});
      else
        kept.insert(kept.end(), tiles.begin() + long(n), tiles.begin() + long(end));
      n = end;
    }
    tiles = std::move(kept);
  }

  void hashTiles() {
    struct Sized {
      Tile tile;
      int edge;
    };
    std::vector<Sized> all;
    for (size_t level = 0; level < kEdges.size(); ++level)
      for (const Tile& tile : tiles_[level]) all.push_back({tile, kEdges[level]});
    std::sort(all.begin(), all.end(),
              [](const Sized& a, const Sized& b) { return a.tile.origin < b.tile.origin; });
    head_.value(static_cast<uint64_t>(all.size()));
    for (const Sized& sized : all) {
      hashCoord(head_, sized.tile.origin);
      hashCoord(head_, sized.tile.origin.offsetBy(sized.edge - 1));
      if constexpr (std::is_same_v<Value, bool>)
        head_.value(static_cast<unsigned char>(sized.tile.value ? 1 : 0));
      else
        head_.value(canonical(sized.tile.value));
    }
  }

  Hasher head_;
  std::unique_ptr<Hasher> digest_;          // of the leaves that do not fill one yet
  std::array<std::vector<Tile>, 3> tiles_;  // of 8, 128 and 4096 voxels
  std::vector<std::string> digests_;        // of 64 leaves each
  size_t inDigest_ = 0;                     // leaves in digest_, below 64
  uint64_t leafCount_ = 0;
};

}  // namespace nephele
