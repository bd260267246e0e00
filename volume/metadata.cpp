// Adding metadata. Depends on volume/vdb_file.h and OpenVDB.
#include "volume/metadata.h"

#include "base/error.h"
#include "volume/vdb_file.h"

namespace nephele {

void addMetadata(const std::string& path, const std::map<std::string, std::vector<double>>& numbers) {
  const VdbContents contents = readVdb(path);
  openvdb::MetaMap metadata = *contents.metadata;
  constexpr size_t kVector = 3;
  for (const auto& [name, values] : numbers) {
    metadata.removeMeta(name);
    if (values.size() == kVector) {
      metadata.insertMeta(name, openvdb::Vec3DMetadata({values[0], values[1], values[2]}));
    } else {
      NEPHELE_CHECK_EQ(values.size(), size_t{1});
      metadata.insertMeta(name, openvdb::DoubleMetadata(values[0]));
    }
  }
  writeGrids(path, openvdb::GridCPtrVec(contents.grids->begin(), contents.grids->end()), metadata);
}

}  // namespace nephele
