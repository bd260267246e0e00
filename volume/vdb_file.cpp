// Reads and writes .vdb files. Depends on base and OpenVDB.
#include "volume/vdb_file.h"

#include <charconv>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "base/error.h"
#include "base/files.h"
#include "volume/vdb_body.h"
#include "volume/vdb_header.h"
#include "volume/vdb_writer.h"

namespace nephele {
namespace {

openvdb::MetaMap metadataOf(const Provenance& provenance) {
  openvdb::MetaMap metadata;
  metadata.insertMeta("creator", openvdb::StringMetadata(creatorName()));
  metadata.insertMeta("up_axis", openvdb::StringMetadata(std::string(1, provenance.upAxis)));
  if (!provenance.recipeHash.empty())
    metadata.insertMeta("recipe_hash", openvdb::StringMetadata(provenance.recipeHash));
  metadata.insertMeta("seed", openvdb::Int64Metadata(provenance.seed));
  if (provenance.frame) metadata.insertMeta("frame", openvdb::Int32Metadata(*provenance.frame));
  if (!provenance.particles.empty())
    metadata.insertMeta("particles", openvdb::StringMetadata(provenance.particles));
  if (provenance.fps) metadata.insertMeta("fps", openvdb::DoubleMetadata(*provenance.fps));
  if (provenance.cutoff) metadata.insertMeta("cutoff", openvdb::DoubleMetadata(*provenance.cutoff));
  if (provenance.densityStep)
    metadata.insertMeta("density_step", openvdb::DoubleMetadata(*provenance.densityStep));
  if (!provenance.tolerance.empty())
    metadata.insertMeta("tolerance", openvdb::StringMetadata(provenance.tolerance));
  if (provenance.mass) metadata.insertMeta("mass", openvdb::DoubleMetadata(*provenance.mass));
  if (provenance.hasMedium) {
    const auto vector = [](const std::array<double, 3>& a) { return openvdb::Vec3d(a[0], a[1], a[2]); };
    metadata.insertMeta("sigma_s", openvdb::Vec3DMetadata(vector(provenance.sigmaS)));
    metadata.insertMeta("sigma_a", openvdb::Vec3DMetadata(vector(provenance.sigmaA)));
    metadata.insertMeta("g", openvdb::DoubleMetadata(provenance.g));
  }
  return metadata;
}

/// Runs a reading and blames the file for what OpenVDB throws: readVdbHeader has seen that it is there and
/// whole.
template <class Body>
void readGuarded(const std::string& path, const Body& body) {
  try {
    body();
  } catch (const openvdb::Exception& error) {
    throw InputError({path}, std::string("is damaged or of a kind that is not read: ") + error.what());
  } catch (const std::length_error&) {
    throw InputError({path}, "is damaged: it asks for more memory than there can be");
  } catch (const std::bad_alloc&) {
    throw InputError({path}, "is damaged, or larger than the memory: reading it asks for more than there is");
  } catch (const std::ios_base::failure& error) {
    throw InputError({path}, std::string("is damaged: ") + error.what());
  }
}

/// The shortest text that reads back to the same number.
template <class T>
std::string shortest(T value) {
  char text[32];  // the longest double takes 24 characters
  const auto result = std::to_chars(text, text + sizeof text, value);
  return std::string(text, result.ptr);
}

template <class V>
std::string listOf(const V& v) {
  return std::string("[") + shortest(v[0]) + ", " + shortest(v[1]) + ", " + shortest(v[2]) + "]";
}

/// Numbers in full, since OpenVDB's own str() keeps six digits; lists in brackets.
std::string textOf(const openvdb::Metadata& value) {
  if (const auto* d = dynamic_cast<const openvdb::DoubleMetadata*>(&value)) return shortest(d->value());
  if (const auto* f = dynamic_cast<const openvdb::FloatMetadata*>(&value)) return shortest(f->value());
  if (const auto* v = dynamic_cast<const openvdb::Vec3DMetadata*>(&value)) return listOf(v->value());
  if (const auto* v = dynamic_cast<const openvdb::Vec3SMetadata*>(&value)) return listOf(v->value());
  if (const auto* v = dynamic_cast<const openvdb::Vec3IMetadata*>(&value)) return listOf(v->value());
  return value.str();
}

}  // namespace

void initializeOpenVdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

uint64_t writeVdb(const std::string& path, const openvdb::GridCPtrVec& grids, const Provenance& provenance) {
  return writeGrids(path, grids, metadataOf(provenance));
}

uint64_t writeGrids(const std::string& path, const openvdb::GridCPtrVec& grids,
                    const openvdb::MetaMap& metadata) {
  initializeOpenVdb();
  writeWhole(path, [&](const std::string& temporary) {
    try {
      std::ofstream file;
      file.exceptions(std::ios::failbit | std::ios::badbit);
      file.open(temporary, std::ios::binary | std::ios::trunc);
      writeVdbTo(file, grids, metadata);
      file.close();
      readVdbHeader(temporary);  // a full disk is not always told otherwise
    } catch (const openvdb::Exception& error) {
      throw WorldError("cannot write '" + path + "': " + error.what());
    } catch (const std::ios_base::failure& error) {
      throw WorldError("cannot write '" + path + "': " + error.what());
    } catch (const InputError&) {
      throw WorldError("cannot write '" + path + "': the file came out short; is the disk full?");
    }
  });
  return std::filesystem::file_size(path);
}

void withVdbFile(const std::string& path, const std::function<void(openvdb::io::File&)>& body) {
  initializeOpenVdb();
  checkVdbBody(path, readVdbHeader(path));
  readGuarded(path, [&] {
    openvdb::io::File file(path);
    constexpr bool kDelayedLoad = false;
    file.open(kDelayedLoad);
    body(file);
  });
}

VdbContents readVdb(const std::string& path) {
  VdbContents contents;
  withVdbFile(path, [&](openvdb::io::File& file) {
    contents = {file.getGrids(), file.getMetadata()};
    // It describes how this file lies on the disk, nothing that a grid in memory is.
    for (const auto& grid : *contents.grids) grid->removeMeta(openvdb::GridBase::META_FILE_DELAYED_LOAD);
  });
  return contents;
}

std::map<std::string, std::string> metadataAsText(const openvdb::MetaMap& metadata) {
  std::map<std::string, std::string> result;
  for (auto item = metadata.beginMeta(); item != metadata.endMeta(); ++item)
    result[item->first] = textOf(*item->second);
  return result;
}

}  // namespace nephele
