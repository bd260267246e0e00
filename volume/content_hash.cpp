// Content hash of one grid: name, type, class, transform, then active tiles and leaves in order of their
// origins. Depends on base, OpenVDB and TBB.
#include <openvdb/math/Maps.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <vector>

#include "base/hash.h"
#include "volume/vdb_file.h"

namespace nephele {
namespace {

// Leaves of one digest. Fixed, so that the hash does not depend on how threads divide the work.
constexpr size_t kLeavesPerDigest = 64;

/// The value as it is hashed: −0 as 0.
template <class T>
T canonical(const T& value) {
  if constexpr (std::is_floating_point_v<T>)
    return value == T(0) ? T(0) : value;
  else if constexpr (openvdb::VecTraits<T>::IsVec)
    return T(canonical(value[0]), canonical(value[1]), canonical(value[2]));
  else
    return value;
}

template <class T>
void hashValue(Hasher& hasher, const T& value) {
  if constexpr (std::is_same_v<T, bool>)
    hasher.value(static_cast<unsigned char>(value ? 1 : 0));
  else
    hasher.value(canonical(value));
}

void hashCoord(Hasher& hasher, const openvdb::Coord& c) {
  hasher.value(std::array<int32_t, 3>{c.x(), c.y(), c.z()});
}

template <class Leaf>
void hashLeaf(Hasher& hasher, const Leaf& leaf) {
  using Value = typename Leaf::ValueType;
  hashCoord(hasher, leaf.origin());
  hasher.bytes(&leaf.getValueMask(), sizeof(typename Leaf::NodeMaskType));
  if constexpr (std::is_same_v<Value, bool>) {
    std::array<unsigned char, Leaf::SIZE> values;
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) values[i] = leaf.getValue(i) ? 1 : 0;
    hasher.bytes(values.data(), sizeof values);
  } else {
    std::vector<Value> values(Leaf::SIZE);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) values[i] = canonical(leaf.getValue(i));
    hasher.bytes(values.data(), values.size() * sizeof(Value));
  }
}

template <class Tree>
void hashLeaves(Hasher& hasher, const Tree& tree) {
  using Leaf = typename Tree::LeafNodeType;
  std::vector<const Leaf*> leaves;
  leaves.reserve(tree.leafCount());
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
    if (!leaf->isInactive()) leaves.push_back(leaf.getLeaf());
  std::sort(leaves.begin(), leaves.end(),
            [](const Leaf* a, const Leaf* b) { return a->origin() < b->origin(); });
  const size_t digestCount = (leaves.size() + kLeavesPerDigest - 1) / kLeavesPerDigest;
  std::vector<std::string> digests(digestCount);
  tbb::parallel_for(size_t{0}, digestCount, [&](size_t d) {
    Hasher part;
    const size_t end = std::min(leaves.size(), (d + 1) * kLeavesPerDigest);
    for (size_t i = d * kLeavesPerDigest; i < end; ++i) hashLeaf(part, *leaves[i]);
    digests[d] = part.hex();
  });
  hasher.value(static_cast<uint64_t>(leaves.size()));
  for (const std::string& digest : digests) hasher.text(digest);
}

template <class Tree>
void hashTiles(Hasher& hasher, const Tree& tree) {
  using Value = typename Tree::ValueType;
  struct Tile {
    openvdb::CoordBBox box;
    Value value;
  };
  std::vector<Tile> tiles;
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) tiles.push_back({tile.getBoundingBox(), tile.getValue()});
  std::sort(tiles.begin(), tiles.end(),
            [](const Tile& a, const Tile& b) { return a.box.min() < b.box.min(); });
  hasher.value(static_cast<uint64_t>(tiles.size()));
  for (const Tile& t : tiles) {
    hashCoord(hasher, t.box.min());
    hashCoord(hasher, t.box.max());
    hashValue(hasher, t.value);
  }
}

/// Linear transforms by their matrix, whichever kind of map holds it; others by all that OpenVDB writes of
/// them.
void hashTransform(Hasher& hasher, const openvdb::math::Transform& transform) {
  if (transform.isLinear()) {
    const openvdb::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) hashValue(hasher, matrix(i, j));
    return;
  }
  std::ostringstream written;
  transform.write(written);
  hasher.text(written.str());
}

}  // namespace

std::string contentHash(const openvdb::GridBase& grid) {
  Hasher hasher;
  hasher.text(grid.getName());
  hasher.text(grid.type());
  hasher.text(openvdb::GridBase::gridClassToString(grid.getGridClass()));
  hashTransform(hasher, grid.transform());
  using Hashed = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                   openvdb::Int64Grid, openvdb::BoolGrid, openvdb::MaskGrid,
                                   openvdb::Vec3SGrid, openvdb::Vec3DGrid, openvdb::Vec3IGrid>;
  const bool hashed = grid.apply<Hashed>([&](const auto& typed) {
    hashTiles(hasher, typed.tree());
    hashLeaves(hasher, typed.tree());
  });
  return hashed ? hasher.hex() : std::string();
}

}  // namespace nephele
