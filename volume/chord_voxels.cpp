// Voxels along rays, as a tree of masks. Depends on chord_voxels.h, OpenVDB, TBB.
#include "volume/chord_voxels.h"

#include <openvdb/openvdb.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <glm/common.hpp>

namespace nephele {
namespace {

using openvdb::Coord;
using Masks = openvdb::MaskTree;

/// Turns on the eight corners of each cell that the walk has a midpoint in.
void mark(const ChordWalk& walk, openvdb::tree::ValueAccessor<Masks>& masks) {
  glm::ivec3 before(0);
  for (int n = walk.begin; n < walk.end; ++n) {
    const glm::ivec3 cell(glm::floor(walk.at(n)));
    if (n > walk.begin && cell == before) continue;
    before = cell;
    for (int corner = 0; corner < 8; ++corner)
      masks.setValueOn(Coord(cell.x + (corner >> 2), cell.y + (corner >> 1 & 1), cell.z + (corner & 1)));
  }
}

}  // namespace

struct ChordVoxels::Tree {
  Masks masks;
};

ChordVoxels::ChordVoxels(std::span<const Chord> chords, double voxelSize, const glm::dvec3& low,
                         const glm::dvec3& high)
    : tree_(new Tree) {
  tbb::enumerable_thread_specific<Masks> parts;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, chords.size()), [&](const auto& range) {
    openvdb::tree::ValueAccessor<Masks> masks(parts.local());
    for (size_t n = range.begin(); n < range.end(); ++n)
      mark(walkBetween(chords[n].from / voxelSize, chords[n].to / voxelSize, low / voxelSize,
                       high / voxelSize),
           masks);
  });
  for (Masks& part : parts) tree_->masks.merge(part);
}

ChordVoxels::~ChordVoxels() = default;

std::optional<LeafMask> ChordVoxels::ofLeaf(const glm::ivec3& origin) const {
  const auto* leaf = tree_->masks.probeConstLeaf(Coord(origin.x, origin.y, origin.z));
  if (!leaf) return std::nullopt;
  LeafMask mask;
  for (size_t word = 0; word < mask.size(); ++word)
    mask[word] = leaf->getValueMask().getWord<uint64_t>(openvdb::Index(word));
  return mask;
}

}  // namespace nephele
