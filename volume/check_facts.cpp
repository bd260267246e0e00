// What the rules ask of a file, gathered in one reading. Depends on base and OpenVDB.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/frame_name.h"
#include "base/half.h"
#include "volume/check.h"
#include "volume/inspect_grid.h"
#include "volume/vdb_file.h"
#include "volume/vdb_header.h"

namespace nephele {
namespace {

void countNumber(GridFacts& facts, float value) {
  const double size = std::abs(double{value});
  if (!std::isfinite(value))
    ++facts.notFinite;
  else if (size > double{kLargestHalf})
    ++facts.aboveHalf;
  else if (size > 0.0 && size < double{kLeastHalf})
    ++facts.belowHalf;
}

void countValue(GridFacts& facts, float value) { countNumber(facts, value); }
void countValue(GridFacts& facts, const openvdb::Vec3s& value) {
  for (int axis = 0; axis < 3; ++axis) countNumber(facts, value[axis]);
}

void weigh(GridFacts& facts, float value, double voxels) {
  if (!(value > 0.0f) || !std::isfinite(value)) return;
  facts.largest = std::max(facts.largest, double{value});
  facts.mass += voxels * double{value};
  if (double{value} < kFaintDensity) facts.faintMass += voxels * double{value};
}
void weigh(GridFacts&, const openvdb::Vec3s&, double) {}

template <class Grid>
void countValues(const Grid& grid, GridFacts& facts) {
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    bool isOne = leaf->isDense();
    for (auto value = leaf->cbeginValueAll(); value; ++value) {
      countValue(facts, *value);
      isOne = isOne && *value == leaf->getFirstValue();
    }
    for (auto value = leaf->cbeginValueOn(); value; ++value) weigh(facts, *value, 1.0);
    facts.constantLeaves += isOne ? 1 : 0;
    facts.emptyLeaves += leaf->isEmpty() ? 1 : 0;
  }
  auto tile = grid.cbeginValueOn();
  tile.setMaxDepth(Grid::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    countValue(facts, *tile);
    weigh(facts, *tile, static_cast<double>(tile.getVoxelCount()));
  }
  countValue(facts, grid.background());
}

GridFacts factsOf(const openvdb::GridBase& grid) {
  GridFacts facts;
  facts.info = inspectGrid(grid);
  facts.tree = grid.type();
  facts.vectorType = openvdb::GridBase::vecTypeToString(grid.getVectorType());
  if (const auto* scalar = dynamic_cast<const openvdb::FloatGrid*>(&grid)) {
    facts.background = double{scalar->background()};
    countValues(*scalar, facts);
  }
  if (const auto* vector = dynamic_cast<const openvdb::Vec3SGrid*>(&grid)) countValues(*vector, facts);
  return facts;
}

std::vector<std::string> framesBeside(const std::string& file) {
  const std::filesystem::path path(file);
  const Stem own = stemOf(path.stem().string());
  if (own.digits.empty()) return {};
  std::vector<std::string> frames;
  std::error_code error;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (const auto& beside : std::filesystem::directory_iterator(folder, error)) {
    if (beside.path().extension() != path.extension()) continue;
    const Stem stem = stemOf(beside.path().stem().string());
    if (stem.head == own.head && !stem.digits.empty()) frames.push_back(stem.digits);
  }
  std::sort(frames.begin(), frames.end(), [](const std::string& a, const std::string& b) {
    const auto number = [](const std::string& text) {
      const size_t first = std::min(text.find_first_not_of('0'), text.size());
      return std::pair(text.size() - first, text.substr(first));
    };
    return std::pair(number(a), a) < std::pair(number(b), b);
  });
  return frames;
}

}  // namespace

FileFacts factsOf(const std::string& path) {
  FileFacts facts;
  const VdbHeader header = readVdbHeader(path);
  facts.path = path;
  facts.fileVersion = header.fileVersion;
  facts.frames = framesBeside(path);
  initializeOpenVdb();
  for (const VdbGridEntry& entry : header.grids)
    if (!openvdb::GridBase::isRegistered(entry.type))
      facts.unknownTrees.push_back(entry.name + ": " + entry.type);
  facts.metadata = header.metadata;
  if (!facts.unknownTrees.empty()) return facts;
  const VdbContents contents = readVdb(path);
  facts.metadata = metadataAsText(*contents.metadata);
  for (const auto& grid : *contents.grids) {
    facts.grids.push_back(factsOf(*grid));
    // OpenVDB has an order of its own.
    const auto entry = std::find_if(header.grids.begin(), header.grids.end(),
                                    [&](const VdbGridEntry& e) { return e.name == grid->getName(); });
    if (entry != header.grids.end()) facts.grids.back().compression = entry->compression;
  }
  return facts;
}

}  // namespace nephele
