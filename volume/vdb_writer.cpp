// The archive as OpenVDB lays it out (io/Archive): header, metadata, then for each grid its descriptor with
// three places, compression flags, metadata, transform, topology, leaf buffers. Every part but the last is
// written by OpenVDB; leaf buffers are encoded a chunk at a time by many threads and follow in order.
// Depends on OpenVDB, TBB.
#include "volume/vdb_writer.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace nephele {
namespace {

using openvdb::io::GridDescriptor;

constexpr uint32_t kCompression = openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK;
// Leaves of one piece of work: half a megabyte of floats.
constexpr size_t kLeavesPerChunk = 256;

template <class Tree>
std::vector<const typename Tree::LeafNodeType*> leavesOf(const Tree& tree) {
  std::vector<const typename Tree::LeafNodeType*> leaves;
  leaves.reserve(tree.leafCount());
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) leaves.push_back(leaf.getLeaf());
  return leaves;
}

/// The buffers of leaves [begin, end), as LeafNode writes them.
template <class Leaf>
std::string encoded(const std::vector<const Leaf*>& leaves, size_t begin, size_t end,
                    const typename Leaf::ValueType& background, bool half) {
  std::ostringstream chunk;
  openvdb::io::setDataCompression(chunk, kCompression);
  openvdb::io::setGridBackgroundValuePtr(chunk, &background);
  for (size_t n = begin; n < end; ++n) leaves[n]->writeBuffers(chunk, half);
  return std::move(chunk).str();
}

template <class Grid>
void writeLeaves(std::ostream& stream, const Grid& grid) {
  const auto leaves = leavesOf(grid.tree());
  const auto background = grid.background();
  const bool half = grid.saveFloatAsHalf();
  size_t next = 0;
  const auto take = [&](tbb::flow_control& control) {
    const size_t begin = next;
    if (begin >= leaves.size()) control.stop();
    next = std::min(leaves.size(), begin + kLeavesPerChunk);
    return begin;
  };
  const auto encode = [&](size_t begin) {
    return encoded(leaves, begin, std::min(leaves.size(), begin + kLeavesPerChunk), background, half);
  };
  const auto put = [&](const std::string& chunk) {
    stream.write(chunk.data(), static_cast<std::streamsize>(chunk.size()));
  };
  using tbb::filter_mode;
  // Two chunks a thread keep all of them at work while one is written.
  const size_t inFlight = 2 * static_cast<size_t>(tbb::this_task_arena::max_concurrency());
  tbb::parallel_pipeline(inFlight,
                         tbb::make_filter<void, size_t>(filter_mode::serial_in_order, take) &
                             tbb::make_filter<size_t, std::string>(filter_mode::parallel, encode) &
                             tbb::make_filter<std::string, void>(filter_mode::serial_in_order, put));
}

/// Lends the parts of OpenVDB's writer that come before the leaves.
class Writer : public openvdb::io::Archive {
 public:
  Writer() { setCompression(kCompression); }
  Ptr copy() const override { return Ptr(new Writer(*this)); }

  void writeAll(std::ostream& stream, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata) {
    auto settings = std::make_shared<openvdb::io::StreamMetadata>();
    openvdb::io::setStreamMetadataPtr(stream, settings, /*transfer=*/false);
    openvdb::io::setDataCompression(stream, kCompression);
    writeHeader(stream, /*seekable=*/true);
    metadata.writeMeta(stream);
    const auto count = static_cast<int32_t>(grids.size());
    stream.write(reinterpret_cast<const char*>(&count), sizeof count);
    std::map<std::string, int> sameName;
    for (const auto& grid : grids) ++sameName[grid->getName()];
    std::map<std::string, int> used;
    for (const auto& grid : grids) {
      const std::string name = grid->getName();
      writeOne(stream, sameName[name] == 1 ? name : GridDescriptor::addSuffix(name, used[name]++), *grid);
    }
  }

 private:
  void writeOne(std::ostream& stream, const std::string& uniqueName, const openvdb::GridBase& grid) const {
    GridDescriptor descriptor(uniqueName, grid.type(), grid.saveFloatAsHalf());
    descriptor.writeHeader(stream);
    const std::ostream::pos_type places = stream.tellp();
    descriptor.writeStreamPos(stream);  // to be filled in
    descriptor.setGridPos(stream.tellp());
    setGridCompression(stream, grid);
    const openvdb::GridBase::Ptr described = openvdb::ConstPtrCast<openvdb::GridBase>(grid.copyGrid());
    described->addStatsMetadata();
    described->writeMeta(stream);
    grid.writeTransform(stream);
    grid.writeTopology(stream);
    descriptor.setBlockPos(stream.tellp());
    using InParallel = openvdb::TypeList<openvdb::FloatGrid, openvdb::Vec3SGrid>;
    if (!grid.apply<InParallel>([&](const auto& typed) { writeLeaves(stream, typed); }))
      grid.writeBuffers(stream);
    descriptor.setEndPos(stream.tellp());
    stream.seekp(places);
    descriptor.writeStreamPos(stream);
    descriptor.seekToEnd(stream);
  }
};

}  // namespace

void writeVdbTo(std::ostream& stream, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata) {
  Writer().writeAll(stream, grids, metadata);
}

}  // namespace nephele
