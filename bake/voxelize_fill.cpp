// Interval bounds cull from the root down; a leaf is evaluated as a block. Depends on voxelize_fill.h,
// OpenVDB, TBB.
#include "bake/voxelize_fill.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/figures.h"
#include "base/half.h"

namespace nephele {

namespace {

using openvdb::Coord;

// Index coordinates stay well inside 32 bits, so that no neighbour or box overflows.
constexpr double kLargestIndex = 1073741824.0;
// A recipe that asks for a larger box than this is refused: dense it would take 4 TB.
constexpr double kMostVoxels = 1e12;
constexpr int kWordBits = 64;
// What a leaf that is yet to be filled takes: its origin, its sums, a pointer.
constexpr uint64_t kCandidateBytes = 48;

std::string shown(double value) { return number(value, 3); }

std::string inGigabytes(double bytes) { return shown(bytes * 1e-9) + " GB"; }

}  // namespace

VoxelizeError tooMuchMemory(double leaves, const VoxelizeSettings& settings) {
  return VoxelizeError("the density fills about " + shown(leaves * kBlockPoints) + " voxels, which take " +
                       inGigabytes(leaves * bytesOfLeaf(settings)) + " of memory" +
                       (settings.bytesBeside > 0 ? " with the other grids" : "") + ", and " +
                       inGigabytes(double(settings.memoryBytes)) + " are available; use larger voxels");
}

void checkEnds(const Field& field) {
  const Box support = field.support();
  if (support.empty()) return;
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(support.low[axis]) || !std::isfinite(support.high[axis]))
      throw VoxelizeError(std::string("the density fills all of space along ") + "xyz"[axis] +
                          "; multiply it by a shape that ends, as a sphere");
}

LeafFiller::LeafFiller(const Field& field, const VoxelizeSettings& settings)
    : field_(field),
      settings_(settings),
      rules_{float(settings.cutoff), settings.half ? kLargestHalf : std::numeric_limits<float>::max(),
             settings.half, float(settings.densityStep)} {
  if (settings_.voxelSize < kSmallestVoxel)
    throw VoxelizeError("voxels of " + shown(settings_.voxelSize) + " world units are below " +
                        shown(kSmallestVoxel) + ", the smallest that a .vdb can hold; use larger units");
}

openvdb::CoordBBox LeafFiller::box() const {
  checkEnds(field_);
  const Box support = field_.support();
  if (support.empty()) return {};
  double voxels = 1.0;
  openvdb::CoordBBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::floor(support.low[axis] / settings_.voxelSize),
                 high = std::ceil(support.high[axis] / settings_.voxelSize);
    if (low < -kLargestIndex || high > kLargestIndex)
      throw VoxelizeError("the density reaches voxel " + shown(std::max(-low, high)) + " along " +
                          "xyz"[axis] + ", beyond 2^30; use larger voxels or stay nearer to the origin");
    voxels *= high - low + 1.0;
    box.min()[axis] = int(low) & ~(kCoarseEdge - 1);
    box.max()[axis] = int(high) | (kCoarseEdge - 1);
  }
  if (voxels > kMostVoxels)
    throw VoxelizeError("the density's box holds " + shown(voxels) + " voxels (" +
                        inGigabytes(voxels * sizeof(float)) + " if dense), more than " + shown(kMostVoxels) +
                        "; use larger voxels");
  return box;
}

Box LeafFiller::worldBox(const Cube& cube) const {
  const glm::dvec3 low(cube.origin.x(), cube.origin.y(), cube.origin.z());
  return roundedOutwards({low * settings_.voxelSize, (low + double(cube.edge - 1)) * settings_.voxelSize});
}

float LeafFiller::asStored(const Coord& origin, float value) const {
  alignas(kBlockAlignment) float values[kBlockPoints];
  std::fill_n(values, kBlockPoints, value);
  kept(origin, values);
  return values[0];
}

std::optional<float> LeafFiller::settledValue(const Coord& origin, int edge) const {
  const Interval bounds = field_.bounds(worldBox({origin, edge}));
  if (bounds.high <= settings_.cutoff) return 0.0f;
  // All values are floats, so one value that bounds leave is one.
  if (bounds.exact() && bounds.low == double(float(bounds.low))) return asStored(origin, float(bounds.low));
  return std::nullopt;
}

void LeafFiller::descend(const Cube& cube, int leastEdge, const openvdb::CoordBBox& within,
                         Occupied& found) const {
  if (!within.hasOverlap(openvdb::CoordBBox::createCube(cube.origin, cube.edge))) return;
  if (const std::optional<float> value = settledValue(cube.origin, cube.edge)) {
    if (*value > 0.0f) found.constant.push_back({cube.origin, cube.edge, *value});
    return;
  }
  if (cube.edge == leastEdge) {
    found.origins.push_back(cube.origin);
    return;
  }
  const int half = cube.edge / 2;
  for (int octant = 0; octant < 8; ++octant)
    descend({cube.origin.offsetBy(octant & 4 ? half : 0, octant & 2 ? half : 0, octant & 1 ? half : 0), half},
            leastEdge, within, found);
}

namespace {

void append(Occupied& to, const Occupied& from) {
  to.origins.insert(to.origins.end(), from.origins.begin(), from.origins.end());
  to.constant.insert(to.constant.end(), from.constant.begin(), from.constant.end());
}

}  // namespace

Occupied LeafFiller::findCoarse() const {
  const openvdb::CoordBBox within = box();
  Occupied all;
  if (within.empty()) return all;
  std::vector<Coord> roots;
  const Coord first = within.min() & ~(kRootEdge - 1);
  for (int x = first.x(); x <= within.max().x(); x += kRootEdge)
    for (int y = first.y(); y <= within.max().y(); y += kRootEdge)
      for (int z = first.z(); z <= within.max().z(); z += kRootEdge) roots.emplace_back(x, y, z);
  std::vector<Occupied> found(roots.size());
  tbb::parallel_for(size_t(0), roots.size(), [&](size_t n) {
    descend({roots[n], kRootEdge}, kCoarseEdge, within, found[n]);
  });
  for (const Occupied& part : found) append(all, part);
  return all;
}

Occupied LeafFiller::find() const {
  Occupied coarse = findCoarse();
  std::vector<Occupied> found(coarse.origins.size());
  std::atomic<uint64_t> count{0};
  tbb::parallel_for(size_t(0), found.size(), [&](size_t n) {
    const Cube cube{coarse.origins[n], kCoarseEdge};
    descend(cube, kBlockEdge, openvdb::CoordBBox::createCube(cube.origin, cube.edge), found[n]);
    if ((count += found[n].origins.size()) > settings_.memoryBytes / kCandidateBytes)
      throw VoxelizeError("the density may lie in more than " + shown(double(count) * kBlockPoints) +
                          " voxels; the list of them alone takes the " +
                          inGigabytes(double(settings_.memoryBytes)) +
                          " of memory that are available; use larger voxels");
  });
  coarse.origins.clear();
  for (const Occupied& part : found) append(coarse, part);
  return coarse;
}

bool LeafFiller::isSettled(const Coord& origin) const {
  const Interval bounds = field_.bounds(worldBox({origin, kBlockEdge}));
  return bounds.exact() || bounds.high <= settings_.cutoff;
}

std::unique_ptr<DensityLeaf> LeafFiller::fill(const Coord& origin, LeafSums& sums) const {
  alignas(kBlockAlignment) float values[kBlockPoints];
  const LeafScan scanned = scan(origin, values);
  if (!scanned.active) return nullptr;
  sums = {scanned.mass, scanned.maximum};
  auto leaf = std::make_unique<DensityLeaf>(openvdb::PartialCreate(), origin, 0.0f);
  leaf->allocate();
  std::copy_n(values, kBlockPoints, leaf->buffer().data());
  DensityLeaf::NodeMaskType mask;
  for (int word = 0; word < kBlockPoints / kWordBits; ++word)
    mask.getWord<uint64_t>(openvdb::Index(word)) = scanned.mask[word];
  leaf->setValueMask(mask);
  return leaf;
}

LeafScan LeafFiller::scan(const Coord& origin, float* values) const {
  const glm::dvec3 corner(origin.x(), origin.y(), origin.z());
  field_.evaluate(Lattice{corner * settings_.voxelSize, settings_.voxelSize}, values);
  return kept(origin, values);
}

LeafScan LeafFiller::scan(const Coord& origin, const uint16_t* places, size_t count, float* values) const {
  float x[kBlockPoints], y[kBlockPoints], z[kBlockPoints], found[kBlockPoints];
  for (size_t n = 0; n < count; ++n) {
    const Coord at = DensityLeaf::offsetToLocalCoord(places[n]);
    x[n] = float(at.x() * settings_.voxelSize);
    y[n] = float(at.y() * settings_.voxelSize);
    z[n] = float(at.z() * settings_.voxelSize);
  }
  const glm::dvec3 corner(origin.x(), origin.y(), origin.z());
  field_.evaluate(Points{corner * settings_.voxelSize, count, x, y, z}, found);
  std::fill_n(values, kBlockPoints, 0.0f);
  for (size_t n = 0; n < count; ++n) values[places[n]] = found[n];
  return kept(origin, values);
}

/// Cuts and rounds, or refuses.
LeafScan LeafFiller::kept(const Coord& origin, float* values) const {
  alignas(kBlockAlignment) float given[kBlockPoints];
  std::copy_n(values, kBlockPoints, given);
  const LeafScan scanned = scanLeaf(rules_, values);
  if (!scanned.storable) refuseUnstorable(origin, given);
  return scanned;
}

void LeafFiller::refuseUnstorable(const Coord& origin, const float* values) const {
  for (int n = 0; n < kBlockPoints; ++n) {
    if (!std::isfinite(values[n])) throw VoxelizeError("the density is not finite" + placeOf(origin, n));
    if (values[n] > rules_.limit)
      throw VoxelizeError("the density reaches " + shown(double(values[n])) + placeOf(origin, n) +
                          ", more than half precision holds (65504); ask for 'precision: float'");
  }
  failCheck(__FILE__, __LINE__, "a leaf that cannot be stored holds a value that cannot", "none", "one");
}

std::string LeafFiller::placeOf(const Coord& origin, int n) const {
  const Coord at = origin + DensityLeaf::offsetToLocalCoord(openvdb::Index(n));
  return " at (" + shown(at.x() * settings_.voxelSize) + ", " + shown(at.y() * settings_.voxelSize) + ", " +
         shown(at.z() * settings_.voxelSize) + ")";
}

}  // namespace nephele
