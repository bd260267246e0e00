// The head of a .vdb file, walked by hand without OpenVDB: is it a .vdb, which grids does it hold, and is all
// of it there? OpenVDB itself does not notice a file's early end. Depends on base alone.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace nephele {

struct VdbGridEntry {
  std::string name;         // without the suffix that OpenVDB adds to repeated names
  std::string type;         // "Tree_float_5_4_3", …
  bool half = false;        // stored with half precision
  bool sharesTree = false;  // it has no tree of its own in the file
  uint64_t begin = 0;       // byte range in the file: from the entry's head,
  uint64_t grid = 0;        // with the grid itself (compression, metadata, transform, topology) from here on
  uint64_t blocks = 0;      // and its leaves' buffers from here
  uint64_t end = 0;
  std::optional<uint32_t> compression;  // kZip, kActiveMask, kBlosc; nullopt before version 222
};

/// Compression flags of a grid, in OpenVDB's io/Compression.h.
inline constexpr uint32_t kZip = 1, kActiveMask = 2, kBlosc = 4;

struct VdbHeader {
  uint32_t fileVersion = 0;
  std::map<std::string, std::string> metadata;  // string metadata of the file; other types are left out
  std::vector<VdbGridEntry> grids;
  uint64_t sizeBytes = 0;
};

/// Reads the header and every grid's place. Throws InputError where the file is missing, is no .vdb, is older
/// than version 220, or ends before its last grid does (the sentence names both sizes). Reads a few
/// kilobytes.
VdbHeader readVdbHeader(const std::string& path);

}  // namespace nephele
