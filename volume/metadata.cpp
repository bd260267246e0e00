// Adding metadata. Depends on volume/vdb_file.h and OpenVDB.
#include "volume/metadata.h"

#include "volume/vdb_file.h"

namespace nephele {

void addMetadata(const std::string& path, const std::map<std::string, double>& numbers) {
  const VdbContents contents = readVdb(path);
  openvdb::MetaMap metadata = *contents.metadata;
  for (const auto& [name, value] : numbers) {
    metadata.removeMeta(name);
    metadata.insertMeta(name, openvdb::DoubleMetadata(value));
  }
  writeGrids(path, openvdb::GridCPtrVec(contents.grids->begin(), contents.grids->end()), metadata);
}

}  // namespace nephele
