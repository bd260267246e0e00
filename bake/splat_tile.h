// What a filled tile of the splat hands on, and how the tiles' leaves become trees. Part of splat; depends on
// splat_leaf.h, OpenVDB, TBB.
#pragma once

#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>

#include <map>
#include <utility>
#include <vector>

#include "bake/splat_leaf.h"

namespace nephele {

/// One tile of 64³ voxels, filled.
struct TileResult {
  std::vector<std::pair<int, OpenLeaf>> leaves;  // by growing number
  SplatLedger ledger;
  float maximum = 0.0f;
  uint64_t active = 0;
  openvdb::CoordBBox origins;  // of leaves
  bool constant = false;       // whether a leaf holds one value alone, so that there is something to prune
};

/// The box of all active voxels. Only leaves on the faces of the leaves' box are looked into.
openvdb::CoordBBox activeBoxOf(const std::vector<TileResult>& tiles);

/// Hands leaves over to a tree: nodes of 128³ voxels one after the other, their leaves in parallel.
template <class Tree>
void addLeaves(Tree& tree, std::vector<TileResult>& tiles,
               std::unique_ptr<typename Tree::LeafNodeType> OpenLeaf::*member) {
  using Upper = typename Tree::RootNodeType::ChildNodeType;
  using Lower = typename Upper::ChildNodeType;
  std::map<Lower*, std::vector<TileResult*>> parts;
  for (TileResult& tile : tiles) {
    if (tile.leaves.empty()) continue;
    const openvdb::Coord& at = tile.origins.min();
    Upper* upper = tree.root().template probeNode<Upper>(at);
    if (!upper) tree.root().addChild(upper = new Upper(at, tree.background(), false));
    Lower* lower = upper->template probeNode<Lower>(at);
    if (!lower) upper->addChild(lower = new Lower(at, tree.background(), false));
    parts[lower].push_back(&tile);
  }
  std::vector<std::pair<Lower*, std::vector<TileResult*>>> list(parts.begin(), parts.end());
  tbb::parallel_for(size_t(0), list.size(), [&](size_t n) {
    for (TileResult* tile : list[n].second)
      for (auto& numbered : tile->leaves)
        if (auto& leaf = numbered.second.*member) list[n].first->addLeaf(leaf.release());
  });
}

}  // namespace nephele
