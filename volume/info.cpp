// Inspects .vdb files for people and programs. Depends on base, OpenVDB and nlohmann_json.
#include "volume/info.h"

#include <iomanip>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "volume/inspect_grid.h"
#include "volume/vdb_file.h"
#include "volume/vdb_header.h"

namespace nephele {
namespace {

using Json = nlohmann::ordered_json;

// Texture-based viewers allocate the whole box, and few can above this (VDB-CONVENTIONS.md, 10).
constexpr int64_t kWidestBox = 2048;

uint64_t valueBytes(const std::string& type) {
  static const std::map<std::string, uint64_t> kBytes{
      {"float", 4},  {"double", 8}, {"int32", 4},  {"int64", 8},       {"bool", 1},   {"mask", 1},
      {"vec3s", 12}, {"vec3d", 24}, {"vec3i", 12}, {"ptdataidx32", 4}, {"ptidx32", 4}};
  const auto found = kBytes.find(type);
  return found == kBytes.end() ? 0 : found->second;
}

std::array<int64_t, 3> extentOf(const GridInfo& grid) {
  return {int64_t{grid.boxMax.x} - grid.boxMin.x, int64_t{grid.boxMax.y} - grid.boxMin.y,
          int64_t{grid.boxMax.z} - grid.boxMin.z};
}

/// Bytes of the active box as a dense array; 2^64 − 1 where there are more.
uint64_t denseBytesOf(const GridInfo& grid) {
  uint64_t bytes = valueBytes(grid.type);
  for (const int64_t n : extentOf(grid))
    if (__builtin_mul_overflow(bytes, static_cast<uint64_t>(n), &bytes))
      return std::numeric_limits<uint64_t>::max();
  return bytes;
}

}  // namespace

GridInfo inspectGrid(const openvdb::GridBase& grid) {
  GridInfo info;
  info.name = grid.getName();
  info.type = grid.valueType();
  info.gridClass = openvdb::GridBase::gridClassToString(grid.getGridClass());
  info.half = grid.saveFloatAsHalf();
  info.activeVoxels = grid.activeVoxelCount();
  info.leaves = grid.baseTree().leafCount();
  info.tiles = grid.baseTree().activeTileCount();
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (!box.empty()) {
    info.boxMin = {box.min().x(), box.min().y(), box.min().z()};
    info.boxMax = glm::ivec3(box.max().x(), box.max().y(), box.max().z()) + 1;
  }
  info.linear = grid.transform().isLinear();
  if (info.linear) {
    const openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) info.worldFromIndex[i][j] = matrix(i, j);
  }
  info.bytes = grid.memUsage();
  info.denseBytes = denseBytesOf(info);
  info.metadata = metadataAsText(grid);
  return info;
}

std::string sizeText(uint64_t bytes) {
  constexpr std::array<const char*, 7> kUnits{"bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  constexpr double kStep = 1024.0;
  double amount = static_cast<double>(bytes);
  size_t unit = 0;
  for (; amount >= kStep && unit + 1 < kUnits.size(); ++unit) amount /= kStep;
  std::ostringstream text;
  text << std::fixed << std::setprecision(unit == 0 ? 0 : 1) << amount << ' ' << kUnits[unit];
  return text.str();
}

namespace {

std::string vectorText(const glm::ivec3& v) {
  return std::string("[") + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) +
         "]";
}

/// "[0.1, 0.1, 0.1]", the world lengths of a voxel's edges.
std::string voxelText(const glm::dmat4& m) {
  std::ostringstream text;
  text << "[" << glm::length(glm::dvec3(m[0])) << ", " << glm::length(glm::dvec3(m[1])) << ", "
       << glm::length(glm::dvec3(m[2])) << "]";
  return text.str();
}

void addRow(std::ostringstream& text, const std::string& name, const std::string& value) {
  constexpr int kNameWidth = 14;
  text << "    " << std::left << std::setw(kNameWidth) << name << "  " << value << '\n';
}

void addWarnings(std::ostringstream& text, const GridInfo& grid) {
  if (grid.activeVoxels == 0) text << "    warning: the grid is empty\n";
  const auto extent = extentOf(grid);
  for (size_t axis = 0; axis < extent.size(); ++axis)
    if (extent[axis] > kWidestBox)
      text << "    warning: " << extent[axis] << " voxels along "
           << "xyz"[axis] << ", above " << kWidestBox << "; viewers that fill the whole box may fail\n";
}

void addGrid(std::ostringstream& text, const GridInfo& grid) {
  text << "  " << grid.name << ": " << grid.type << ", " << grid.gridClass
       << (grid.half ? ", stored as half" : "") << '\n';
  addRow(text, "active voxels", std::to_string(grid.activeVoxels));
  addRow(text, "leaves, tiles", std::to_string(grid.leaves) + ", " + std::to_string(grid.tiles));
  const auto extent = extentOf(grid);
  addRow(text, "box",
         vectorText(grid.boxMin) + " up to " + vectorText(grid.boxMax) + ", " + std::to_string(extent[0]) +
             " x " + std::to_string(extent[1]) + " x " + std::to_string(extent[2]) + " voxels");
  addRow(text, "voxel size",
         grid.linear ? voxelText(grid.worldFromIndex) : "differs from place to place (a frustum)");
  addRow(text, "memory", sizeText(grid.bytes) + ", dense box " + sizeText(grid.denseBytes));
  addRow(text, "content hash", grid.contentHash.empty() ? "none for this type" : grid.contentHash);
  for (const auto& [key, value] : grid.metadata) addRow(text, key, value);
  addWarnings(text, grid);
}

/// Rows of the matrix that takes index positions as column vectors to the world.
Json transformJson(const glm::dmat4& m) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) rows.push_back({m[0][row], m[1][row], m[2][row], m[3][row]});
  return rows;
}

Json gridJson(const GridInfo& grid) {
  Json json;
  json["name"] = grid.name;
  json["type"] = grid.type;
  json["class"] = grid.gridClass;
  json["half"] = grid.half;
  json["voxels_active"] = grid.activeVoxels;
  json["leaves"] = grid.leaves;
  json["tiles"] = grid.tiles;
  json["box_min"] = {grid.boxMin.x, grid.boxMin.y, grid.boxMin.z};
  json["box_max"] = {grid.boxMax.x, grid.boxMax.y, grid.boxMax.z};
  json["transform"] = grid.linear ? transformJson(grid.worldFromIndex) : Json(nullptr);
  json["bytes"] = grid.bytes;
  json["dense_bytes"] = grid.denseBytes;
  json["content_hash"] = grid.contentHash.empty() ? Json(nullptr) : Json(grid.contentHash);
  json["metadata"] = Json(grid.metadata);
  return json;
}

Json fileJson(const FileInfo& info) {
  Json json;
  json["path"] = info.path;
  json["file_bytes"] = info.fileBytes;
  json["metadata"] = Json(info.metadata);
  json["grids"] = Json::array();
  for (const GridInfo& grid : info.grids) json["grids"].push_back(gridJson(grid));
  return json;
}

}  // namespace

FileInfo inspectFile(const std::string& path) {
  const VdbContents contents = readVdb(path);
  FileInfo info;
  info.path = path;
  info.fileBytes = readVdbHeader(path).sizeBytes;
  info.metadata = metadataAsText(*contents.metadata);
  for (const auto& grid : *contents.grids)
    info.grids.emplace_back(inspectGrid(*grid)).contentHash = contentHash(*grid);
  return info;
}

std::string infoAsText(const FileInfo& info) {
  std::ostringstream text;
  text << info.path << ": " << sizeText(info.fileBytes) << ", " << info.grids.size()
       << (info.grids.size() == 1 ? " grid\n" : " grids\n");
  for (const auto& [key, value] : info.metadata) addRow(text, key, value);
  for (const GridInfo& grid : info.grids) addGrid(text, grid);
  return text.str();
}

std::string infoAsJson(const std::vector<FileInfo>& infos) {
  Json json = Json::array();
  for (const FileInfo& info : infos) json.push_back(fileJson(info));
  constexpr int kIndent = 2;
  // Names in foreign files need not be UTF-8.
  const auto kReplace = Json::error_handler_t::replace;
  const Json& shown = json.size() == 1 ? json[0] : json;
  return shown.dump(kIndent, ' ', false, kReplace) + "\n";
}

}  // namespace nephele
