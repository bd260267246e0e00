// One grid of a .vdb → brick arrays. Depends on base, OpenVDB and TBB.
#include <openvdb/tools/Count.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "volume/brick_builder.h"
#include "volume/bricks.h"
#include "volume/vdb_file.h"
#include "volume/vdb_header.h"

namespace nephele {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using Leaf = FloatGrid::TreeType::LeafNodeType;

constexpr double kMostIndexBytes = double{1 << 30};
static_assert(Leaf::DIM == kBrickCells);

struct Tile {
  openvdb::CoordBBox box;
  float value;
};

/// What counts as density: leaves with active voxels, and active tiles.
struct Contents {
  std::vector<const Leaf*> leaves;
  std::vector<Tile> tiles;
};

Contents contentsOf(const FloatGrid& grid) {
  Contents contents;
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
    if (!leaf->isInactive()) contents.leaves.push_back(leaf.getLeaf());
  auto tile = grid.tree().cbeginValueOn();
  tile.setMaxDepth(FloatGrid::TreeType::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) contents.tiles.push_back({tile.getBoundingBox(), tile.getValue()});
  return contents;
}

/// "at index position (1, 2, 3)".
std::string atPlace(const Coord& c) {
  std::ostringstream text;
  text << "at index position (" << c.x() << ", " << c.y() << ", " << c.z() << ")";
  return text.str();
}

/// Sums over the active voxels of one leaf or tile, negative values as 0.
struct Examined {
  double sum = 0.0;
  float least = 0.0f;
  bool allFinite = true;
  Coord notFinite;
};

Examined examine(const Leaf& leaf) {
  Examined result;
  const float* values = leaf.buffer().data();
  for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
    const float value = values[i];
    if (!std::isfinite(value)) {
      if (result.allFinite) result.notFinite = leaf.offsetToGlobalCoord(i);
      result.allFinite = false;
    }
    result.least = std::min(result.least, value);
    if (leaf.isValueOn(i)) result.sum += std::max(0.0, double{value});
  }
  return result;
}

Examined examine(const Tile& tile) {
  Examined result;
  result.allFinite = std::isfinite(tile.value);
  result.notFinite = tile.box.min();
  result.least = std::min(0.0f, tile.value);
  result.sum = std::max(0.0, double{tile.value}) * static_cast<double>(tile.box.volume());
  return result;
}

/// Refuses values that are not finite, notes negative ones, and sets count and mean of active voxels.
void examineValues(const std::string& path, const FloatGrid& grid, const Contents& contents,
                   BrickVolume& volume) {
  std::vector<Examined> parts(contents.leaves.size() + contents.tiles.size());
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t i) {
    const size_t leafCount = contents.leaves.size();
    parts[i] = i < leafCount ? examine(*contents.leaves[i]) : examine(contents.tiles[i - leafCount]);
  });
  double sum = 0.0;
  float least = 0.0f;
  for (const Examined& part : parts) {  // in one order, so that the mean does not depend on threads
    if (!part.allFinite)
      throw InputError({path}, "grid '" + grid.getName() + "' holds a value that is not finite " +
                                   atPlace(part.notFinite));
    sum += part.sum;
    least = std::min(least, part.least);
  }
  volume.activeVoxels = grid.activeVoxelCount();
  volume.meanActive = volume.activeVoxels > 0 ? sum / static_cast<double>(volume.activeVoxels) : 0.0;
  if (least < 0.0f) {
    std::ostringstream note;
    note << "grid '" << grid.getName() << "' holds negative values (down to " << least
         << "); they count as 0";
    volume.notes.push_back(note.str());
  }
}

/// First and last brick, per axis, that read a sample of the box: those of the box and one before it.
struct BrickSpan {
  glm::ivec3 first, last;
};

BrickSpan spanOf(const openvdb::CoordBBox& box) {
  constexpr int kShift = 3;  // an arithmetic shift divides by 8, towards minus infinity
  static_assert(1 << kShift == kBrickCells);
  BrickSpan span{};
  for (int axis = 0; axis < 3; ++axis) {
    span.first[axis] = (box.min()[axis] >> kShift) - 1;
    span.last[axis] = box.max()[axis] >> kShift;
  }
  return span;
}

void markSpan(BrickVolume& volume, const BrickSpan& span) {
  for (int z = span.first.z; z <= span.last.z; ++z)
    for (int y = span.first.y; y <= span.last.y; ++y) {
      const int64_t row = indexOf(volume, {span.first.x, y, z});
      std::fill_n(volume.index.begin() + row, span.last.x - span.first.x + 1, 1u);
    }
}

/// Sets the index's box and marks the bricks that may hold density. Refuses an index of more than 1 GiB.
void markCandidates(const std::string& path, const Contents& contents, BrickVolume& volume) {
  std::vector<BrickSpan> spans;
  for (const Leaf* leaf : contents.leaves) spans.push_back(spanOf(leaf->getNodeBoundingBox()));
  for (const Tile& tile : contents.tiles)
    if (tile.value > 0.0f) spans.push_back(spanOf(tile.box));
  if (spans.empty()) return;
  BrickSpan all = spans.front();
  for (const BrickSpan& span : spans) {
    all.first = glm::min(all.first, span.first);
    all.last = glm::max(all.last, span.last);
  }
  const glm::dvec3 count = glm::dvec3(all.last) - glm::dvec3(all.first) + 1.0;
  const double indexBytes = count.x * count.y * count.z * sizeof(uint32_t);
  if (indexBytes > kMostIndexBytes) {
    std::ostringstream sentence;
    sentence << "grid '" << volume.gridName << "' spans " << count.x * kBrickCells << " x "
             << count.y * kBrickCells << " x " << count.z * kBrickCells
             << " voxels, and an index of its box would take " << indexBytes / kMostIndexBytes
             << " GiB; at most 1 is read";
    throw InputError({path}, sentence.str(), "is there a stray voxel far away?");
  }
  volume.brickMin = all.first;
  volume.brickCount = all.last - all.first + 1;
  volume.index.assign(static_cast<size_t>(count.x * count.y * count.z), 0);
  for (const BrickSpan& span : spans) markSpan(volume, span);
}

/// Reads bricks from a float tree. Neighbours are looked up once a brick, then copied by rows.
class TreeSource : public BrickSource {
 public:
  explicit TreeSource(const FloatGrid& grid) : grid_(grid) {}

  bool isConstant(const glm::ivec3& brick, float& value) const override {
    const auto accessor = grid_.getConstUnsafeAccessor();
    for (int corner = 0; corner < 8; ++corner) {
      const Neighbour n = neighbour(accessor, brick, corner);
      if (n.leaf != nullptr || (corner > 0 && n.constant != value)) return false;
      value = n.constant;
    }
    return true;
  }

  void read(const glm::ivec3& brick, float* samples) const override {
    const auto accessor = grid_.getConstUnsafeAccessor();
    for (int corner = 0; corner < 8; ++corner) copy(neighbour(accessor, brick, corner), corner, samples);
  }

 private:
  /// One of the eight leaf-sized cubes that a brick's samples lie in: a leaf that counts, or one value
  /// throughout.
  struct Neighbour {
    const Leaf* leaf = nullptr;
    float constant = 0.0f;
  };

  /// Bit 0, 1, 2 of `corner` is the step along x, y, z.
  template <class Accessor>
  static Neighbour neighbour(const Accessor& accessor, const glm::ivec3& brick, int corner) {
    const int step[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
    int origin[3];
    for (int axis = 0; axis < 3; ++axis) {
      const int64_t wide = (int64_t{brick[axis]} + step[axis]) * kBrickCells;
      if (wide < std::numeric_limits<int>::min() || wide > std::numeric_limits<int>::max()) return {};
      origin[axis] = static_cast<int>(wide);
    }
    const Coord at(origin[0], origin[1], origin[2]);
    if (const Leaf* leaf = accessor.probeConstLeaf(at)) return {leaf->isInactive() ? nullptr : leaf, 0.0f};
    float value = 0.0f;
    const bool active = accessor.probeValue(at, value);
    return {nullptr, active ? std::max(0.0f, value) : 0.0f};
  }

  static void copy(const Neighbour& from, int corner, float* samples) {
    const int step[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
    int count[3];  // the cube itself gives eight samples along an axis, the next one its first
    for (int axis = 0; axis < 3; ++axis) count[axis] = step[axis] ? 1 : kBrickCells;
    const float* values = from.leaf ? from.leaf->buffer().data() : nullptr;
    for (int z = 0; z < count[2]; ++z)
      for (int y = 0; y < count[1]; ++y)
        for (int x = 0; x < count[0]; ++x) {
          const int sx = x + step[0] * kBrickCells, sy = y + step[1] * kBrickCells,
                    sz = z + step[2] * kBrickCells;
          const float value = values ? values[Leaf::coordToOffset(Coord(x, y, z))] : from.constant;
          samples[(sz * kBrickSamples + sy) * kBrickSamples + sx] = std::max(0.0f, value);
        }
  }

  const FloatGrid& grid_;
};

glm::dmat4 affineOf(const std::string& path, const FloatGrid& grid) {
  const std::string which = "the transform of grid '" + grid.getName() + "' ";
  if (!grid.transform().isLinear())
    throw InputError({path}, which + "is not affine (a frustum?) and is not rendered");
  const openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
  glm::dmat4 result;
  bool finite = true;
  // OpenVDB multiplies row vectors from the left; glm's columns are those rows.
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      result[i][j] = matrix(i, j);
      finite = finite && std::isfinite(matrix(i, j));
    }
  if (!finite) throw InputError({path}, which + "is not finite");
  constexpr double kSmallestSine = 1e-9;  // flatter cells than this turn to nothing in double precision
  const glm::dvec3 x(result[0]), y(result[1]), z(result[2]);
  const double lengths = glm::length(x) * glm::length(y) * glm::length(z);
  if (!(std::abs(glm::dot(x, glm::cross(y, z))) > kSmallestSine * lengths))
    throw InputError({path}, which + "is singular: it flattens space");
  return result;
}

std::string listGrids(const VdbHeader& header) {
  std::string list;
  for (const VdbGridEntry& entry : header.grids) list += (list.empty() ? "'" : ", '") + entry.name + "'";
  return list.empty() ? "it holds no grids" : "it holds " + list;
}

const VdbGridEntry* findGrid(const VdbHeader& header, const std::string& name) {
  for (const VdbGridEntry& entry : header.grids)
    if (entry.name == name) return &entry;
  return nullptr;
}

/// The grid to show where the user named none; says by a note which, unless it is "density".
std::string chooseGrid(const std::string& path, const VdbHeader& header, openvdb::io::File& file,
                       std::vector<std::string>& notes) {
  const std::string floatTree = FloatGrid::gridType();
  const VdbGridEntry* usual = findGrid(header, "density");
  if (usual != nullptr && usual->type == floatTree) return usual->name;
  for (const VdbGridEntry& entry : header.grids) {
    if (entry.type != floatTree) continue;
    const auto gridClass = file.readGridMetadata(entry.name)->getGridClass();
    if (gridClass != openvdb::GRID_FOG_VOLUME && gridClass != openvdb::GRID_UNKNOWN) continue;
    notes.push_back("no float grid is named 'density'; showing '" + entry.name + "'");
    return entry.name;
  }
  throw InputError({path}, "holds no float grid that is a fog volume", listGrids(header));
}

FloatGrid::Ptr readGrid(const std::string& path, const std::string& wanted, BrickVolume& volume) {
  const VdbHeader header = readVdbHeader(path);
  FloatGrid::Ptr grid;
  withVdbFile(path, [&](openvdb::io::File& file) {
    const std::string name = wanted.empty() ? chooseGrid(path, header, file, volume.notes) : wanted;
    const VdbGridEntry* entry = findGrid(header, name);
    if (entry == nullptr) throw InputError({path}, "holds no grid '" + name + "'", listGrids(header));
    if (entry->type != FloatGrid::gridType())
      throw InputError({path}, "grid '" + name + "' is no float grid but " + entry->type, listGrids(header));
    grid = openvdb::gridPtrCast<FloatGrid>(file.readGrid(name));
    if (grid->getGridClass() == openvdb::GRID_LEVEL_SET)
      throw InputError({path},
                       "grid '" + name + "' is a level set: it holds distances to a surface, not density");
    grid->removeMeta(openvdb::GridBase::META_FILE_DELAYED_LOAD);
    volume.gridName = name;
    volume.metadata = metadataAsText(*file.getMetadata());
    for (const auto& [key, value] : metadataAsText(*grid)) volume.metadata[key] = value;
  });
  return grid;
}

void readUpAxis(BrickVolume& volume) {
  const auto up = volume.metadata.find("up_axis");
  if (up == volume.metadata.end()) return;
  if (up->second == "y" || up->second == "z")
    volume.upAxis = up->second[0];
  else
    volume.notes.push_back("the metadata's up_axis '" + up->second + "' is neither y nor z; z is up");
}

/// Everything but what only a file can tell.
void fillFrom(const std::string& path, const FloatGrid& grid, BrickVolume& volume) {
  volume.path = path;
  volume.worldFromIndex = affineOf(path, grid);
  if (grid.background() != 0.0f) {
    std::ostringstream note;
    note << "grid '" << volume.gridName << "' has a background of " << grid.background()
         << "; it counts as 0";
    volume.notes.push_back(note.str());
  }
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (!box.empty()) {
    volume.activeMin = {box.min().x(), box.min().y(), box.min().z()};
    volume.activeMax = glm::ivec3(box.max().x(), box.max().y(), box.max().z()) + 1;
  }
  const Contents contents = contentsOf(grid);
  examineValues(path, grid, contents, volume);
  markCandidates(path, contents, volume);
  buildBricks(volume, TreeSource(grid));
  if (volume.empty())
    volume.notes.push_back("grid '" + volume.gridName + "' is empty: there is no density to show");
}

}  // namespace

bool hasFloatGrid(const std::string& path, const std::string& gridName) {
  const VdbHeader header = readVdbHeader(path);
  const VdbGridEntry* entry = findGrid(header, gridName);
  return entry != nullptr && entry->type == FloatGrid::gridType();
}

BrickVolume loadBricks(const std::string& path, const std::string& gridName) {
  BrickVolume volume;
  const FloatGrid::Ptr grid = readGrid(path, gridName, volume);
  readUpAxis(volume);
  fillFrom(path, *grid, volume);
  return volume;
}

BrickVolume bricksFromGrid(const openvdb::FloatGrid& grid) {
  BrickVolume volume;
  volume.gridName = grid.getName();
  fillFrom("", grid, volume);
  return volume;
}

}  // namespace nephele
