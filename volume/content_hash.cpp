// Content hash of one grid: name, type, class, transform, then active tiles and leaves in order of their
// origins. Depends on content_hasher.h, base, OpenVDB.
#include <openvdb/math/Maps.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "volume/content_hasher.h"
#include "volume/vdb_file.h"

namespace nephele {
namespace {

/// Linear transforms by their matrix, whichever kind of map holds it; others by all that OpenVDB writes of
/// them.
void hashTransform(Hasher& hasher, const openvdb::math::Transform& transform) {
  if (transform.isLinear()) {
    const openvdb::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) hasher.value(matrix(i, j) == 0.0 ? 0.0 : matrix(i, j));  // −0 is 0
    return;
  }
  std::ostringstream written;
  transform.write(written);
  hasher.text(written.str());
}

template <class Tree>
std::string hashOf(const openvdb::GridBase& grid, const Tree& tree) {
  ContentHasher<Tree> hasher(grid);
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const openvdb::CoordBBox box = tile.getBoundingBox();
    hasher.tile(box.min(), box.dim().x(), tile.getValue());
  }
  using Leaf = typename Tree::LeafNodeType;
  std::vector<const Leaf*> leaves;
  leaves.reserve(tree.leafCount());
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) leaves.push_back(leaf.getLeaf());
  std::sort(leaves.begin(), leaves.end(),
            [](const Leaf* a, const Leaf* b) { return a->origin() < b->origin(); });
  hasher.leaves(leaves);
  return hasher.finish();
}

}  // namespace

void hashGridHead(Hasher& hasher, const openvdb::GridBase& grid) {
  hasher.text(grid.getName());
  hasher.text(grid.type());
  hasher.text(openvdb::GridBase::gridClassToString(grid.getGridClass()));
  hashTransform(hasher, grid.transform());
}

std::string contentHash(const openvdb::GridBase& grid) {
  using Hashed = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                   openvdb::Int64Grid, openvdb::BoolGrid, openvdb::MaskGrid,
                                   openvdb::Vec3SGrid, openvdb::Vec3DGrid, openvdb::Vec3IGrid>;
  std::string hash;
  grid.apply<Hashed>([&](const auto& typed) { hash = hashOf(grid, typed.tree()); });
  return hash;
}

}  // namespace nephele
