// What a .vdb holds, for `info`: numbers first, then a table or JSON. No OpenVDB in this header. Depends on
// base.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <vector>

namespace nephele {

struct GridInfo {
  std::string name;
  std::string type;       // "float", "vec3s", …: the value type
  std::string gridClass;  // "fog volume", "level set", "unknown", …
  bool half = false;
  uint64_t activeVoxels = 0;  // voxels of leaves and of active tiles
  uint64_t leaves = 0;
  uint64_t tiles = 0;    // active tiles
  glm::ivec3 boxMin{0};  // half-open box of active voxels, index space
  glm::ivec3 boxMax{0};
  bool linear = true;  // else a frustum, which no matrix describes: worldFromIndex means nothing
  glm::dmat4 worldFromIndex{1.0};
  uint64_t bytes = 0;       // in memory
  uint64_t denseBytes = 0;  // of the active box as a dense array of the value type
  std::string contentHash;
  std::map<std::string, std::string> metadata;
};

struct FileInfo {
  std::string path;
  uint64_t fileBytes = 0;
  std::map<std::string, std::string> metadata;
  std::vector<GridInfo> grids;
};

/// Reads the file. Throws as readVdb does.
FileInfo inspectFile(const std::string& path);

/// "12.3 MiB".
std::string sizeText(uint64_t bytes);

std::string infoAsText(const FileInfo& info);
/// The keys of DESIGN.md, section 1: path, grids[{name, type, class, …}]; an object for one file, a list of
/// them for more. Boxes are half-open; the transform is the rows of a matrix for column vectors, null where
/// it is not linear; a type without a hash has null.
std::string infoAsJson(const std::vector<FileInfo>& infos);

}  // namespace nephele
