// Leaves of sums → leaves as stored, cut, rounded and counted. Depends on splat_leaf.h, splat_places.h,
// voxelize_kernels.h, OpenVDB.
#include "bake/splat_leaf.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "bake/splat_places.h"
#include "bake/voxelize_kernels.h"
#include "base/figures.h"
#include "base/half.h"

namespace nephele {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
using VelocityLeaf = openvdb::Vec3STree::LeafNodeType;
using openvdb::Coord;

constexpr int kWordBits = 64;

std::string shown(double value) { return number(value, 3); }

std::unique_ptr<Leaf> leafOf(const Coord& origin, const Leaf::NodeMaskType& mask, const float* values) {
  auto leaf = std::make_unique<Leaf>(openvdb::PartialCreate(), origin, 0.0f);
  leaf->allocate();
  std::copy_n(values, kLeafVoxels, leaf->buffer().data());
  leaf->setValueMask(mask);
  return leaf;
}

}  // namespace

SplatLeaves::SplatLeaves(const SplatSettings& settings) : settings_(settings) {
  if (!settings_.box) return;
  const double h = settings_.voxelSize;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = settings_.box->low[axis], high = settings_.box->high[axis];
    if (std::max(std::abs(low), std::abs(high)) > kLargestIndex * h)
      throw SplatError("the frames' box reaches from " + shown(low) + " to " + shown(high) + " along " +
                       "xyz"[axis] + ", beyond voxel 2^30; use larger voxels, or another 'box'");
    box_.min()[axis] = int(std::ceil(settings_.box->low[axis] / h));
    box_.max()[axis] = int(std::floor(settings_.box->high[axis] / h));
  }
}

void SplatLeaves::allocate(const Coord& origin, OpenLeaf& leaf) const {
  leaf.density = std::make_unique<Leaf>(openvdb::PartialCreate(), origin, 0.0f);
  leaf.density->allocate();
}

void SplatLeaves::open(const Coord& origin, OpenLeaf& leaf) const {
  allocate(origin, leaf);
  std::memset(leaf.density->buffer().data(), 0, kLeafVoxels * sizeof(float));
  if (extras()) leaf.extras = std::make_unique<ExtraSums>();  // all 0
}

void SplatLeaves::close(const Coord& origin, OpenLeaf& open, SplatLedger& ledger, float& maximum) const {
  float* const values = open.density->buffer().data();
  if (settings_.box) cutToBox(origin, values);
  const LeafRules rules{float(settings_.cutoff),
                        settings_.half ? kLargestHalf : std::numeric_limits<float>::max(), settings_.half,
                        float(settings_.densityStep)};
  // Floats above 0 that are neither cut nor rounded are stored as they are.
  const bool lossless = !rules.half && rules.step <= 0.0f && rules.cutoff <= 0.0f && !extras();
  float sums[kLeafVoxels];
  if (!lossless) std::copy_n(values, kLeafVoxels, sums);
  const LeafScan scan = scanLeaf(rules, values);
  if (!scan.storable) refuseUnstorable(origin, lossless ? values : sums, rules.limit);
  if (lossless) {
    ledger.splatted = ledger.stored = scan.mass;
  } else {
    const SplatLosses losses = splatLosses(sums, values, rules.cutoff);
    ledger.splatted = losses.before;
    ledger.lostToCutoff = losses.cut;
    ledger.stored = losses.before - losses.cut - losses.rounded;
  }
  maximum = scan.maximum;
  if (!scan.active) {
    open.density.reset();
    return;
  }
  Leaf::NodeMaskType mask;
  for (int word = 0; word < kLeafVoxels / kWordBits; ++word)
    mask.getWord<uint64_t>(openvdb::Index(word)) = scan.mask[word];
  open.density->setValueMask(mask);
  if (extras()) closeExtras(origin, sums, open);
}

/// Means weighted by density, where density is stored.
void SplatLeaves::closeExtras(const Coord& origin, const float* density, OpenLeaf& open) const {
  const Leaf::NodeMaskType& mask = open.density->valueMask();
  auto& values = open.extras->values;
  for (auto& extra : values) {
    for (int v = 0; v < kLeafVoxels; ++v)
      extra[v] = mask.isOn(openvdb::Index(v)) ? extra[v] / density[v] : 0.0f;
    if (!settings_.half) continue;
    for (int v = 0; v < kLeafVoxels; ++v)
      if (std::abs(extra[v]) > kLargestHalf)
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

void SplatLeaves::refuseUnstorable(const Coord& origin, const float* values, float limit) const {
  int v = 0;
  while (v < kLeafVoxels - 1 && values[v] <= limit) ++v;
  const Coord at = origin + Leaf::offsetToLocalCoord(openvdb::Index(v));
  const double h = settings_.voxelSize;
  throw SplatError(
      "the density reaches " + shown(double(values[v])) + " at (" + shown(at.x() * h) + ", " +
      shown(at.y() * h) + ", " + shown(at.z() * h) + "), more than " +
      (settings_.half ? "half precision holds (65504); ask for 'precision: float'" : "a float holds"));
}

void SplatLeaves::cutToBox(const Coord& origin, float* values) const {
  if (box_.isInside(openvdb::CoordBBox::createCube(origin, kLeafEdge))) return;
  for (int v = 0; v < kLeafVoxels; ++v)
    if (!box_.isInside(origin + Leaf::offsetToLocalCoord(openvdb::Index(v)))) values[v] = 0.0f;
}

}  // namespace nephele
