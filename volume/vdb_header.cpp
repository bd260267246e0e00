// Walks a .vdb's head byte by byte. Layout as OpenVDB's Archive, File and GridDescriptor write it, versions
// 220 to 224; all numbers little-endian. Depends on base alone.
#include "volume/vdb_header.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "base/error.h"

namespace nephele {
namespace {

constexpr int64_t kMagic = 0x56444220;  // " BDV" in the file
constexpr uint32_t kOldestVersion = 220;
constexpr uint32_t kNoCompressionFlagSince =
    222;  // before, one flag for the whole file; since, one for each grid
constexpr size_t kUuidCharacters = 36;
constexpr std::string_view kHalfSuffix = "_HalfFloat";
constexpr char kNameSeparator = '\x1e';  // before the number that tells repeated names apart

/// A file that knows its size and refuses to be read beyond it.
class BoundedReader {
 public:
  explicit BoundedReader(const std::string& path) : path_(path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) fail("no such file");
    if (std::filesystem::is_directory(status)) fail("is a folder, not a file");
    sizeBytes_ = std::filesystem::file_size(path, error);
    if (error) fail("is no regular file");
    stream_.open(path, std::ios::binary);
    if (!stream_) fail("cannot be opened");
  }

  uint64_t sizeBytes() const { return sizeBytes_; }
  uint64_t position() const { return position_; }
  uint64_t remaining() const { return sizeBytes_ - position_; }

  template <class T>
  T read() {
    T value{};
    take(&value, sizeof value);
    return value;
  }

  std::string readText(uint64_t length) {
    demand(length);  // before the memory is asked for
    std::string text(length, '\0');
    take(text.data(), length);
    return text;
  }

  /// A length in four bytes, then the characters.
  std::string readText() { return readText(read<uint32_t>()); }

  void skip(uint64_t bytes) {
    demand(bytes);
    seek(position_ + bytes);
  }

  void seek(uint64_t position) {
    if (position > sizeBytes_)
      fail("is cut short: its grids reach to byte " + std::to_string(position) + ", but the file has " +
           std::to_string(sizeBytes_) + " bytes");
    stream_.seekg(static_cast<std::streamoff>(position));
    position_ = position;
  }

  [[noreturn]] void fail(const std::string& sentence) const { throw InputError({path_}, sentence); }

 private:
  void demand(uint64_t bytes) const {
    if (bytes > remaining())
      fail("is cut short or damaged: its head asks for " + std::to_string(bytes) + " bytes at byte " +
           std::to_string(position_) + ", but the file has " + std::to_string(sizeBytes_) + " bytes");
  }

  void take(void* destination, uint64_t bytes) {
    demand(bytes);
    stream_.read(static_cast<char*>(destination), static_cast<std::streamsize>(bytes));
    if (!stream_) throw WorldError("cannot read '" + path_ + "'");
    position_ += bytes;
  }

  std::string path_;
  std::ifstream stream_;
  uint64_t sizeBytes_ = 0;
  uint64_t position_ = 0;
};

std::map<std::string, std::string> readMetadata(BoundedReader& file) {
  const int32_t count = file.read<int32_t>();
  if (count < 0) file.fail("is damaged: it counts " + std::to_string(count) + " entries of metadata");
  std::map<std::string, std::string> metadata;
  for (int32_t i = 0; i < count; ++i) {
    const std::string name = file.readText();
    const std::string type = file.readText();
    const uint32_t sizeBytes = file.read<uint32_t>();
    if (type == "string")
      metadata[name] = file.readText(sizeBytes);
    else
      file.skip(sizeBytes);
  }
  return metadata;
}

VdbGridEntry readEntry(BoundedReader& file) {
  VdbGridEntry entry;
  entry.begin = file.position();
  entry.name = file.readText();
  entry.name = entry.name.substr(0, entry.name.find(kNameSeparator));
  entry.type = file.readText();
  if (entry.type.ends_with(kHalfSuffix)) {
    entry.half = true;
    entry.type.resize(entry.type.size() - kHalfSuffix.size());
  }
  entry.sharesTree = !file.readText().empty();
  const int64_t gridPosition = file.read<int64_t>();
  const int64_t blockPosition = file.read<int64_t>();
  const int64_t end = file.read<int64_t>();
  const int64_t here = static_cast<int64_t>(file.position());
  // A grid without a tree of its own has no leaves, and 0 for their place.
  const bool inOrder =
      entry.sharesTree ? gridPosition <= end : gridPosition <= blockPosition && blockPosition <= end;
  if (gridPosition < here || !inOrder)
    file.fail("is damaged: the places of grid '" + entry.name + "' make no sense");
  entry.grid = static_cast<uint64_t>(gridPosition);
  entry.blocks = static_cast<uint64_t>(blockPosition);
  entry.end = static_cast<uint64_t>(end);
  return entry;
}

}  // namespace

VdbHeader readVdbHeader(const std::string& path) {
  BoundedReader file(path);
  VdbHeader header;
  header.sizeBytes = file.sizeBytes();
  if (file.sizeBytes() < sizeof kMagic || file.read<int64_t>() != kMagic) file.fail("is no .vdb file");
  header.fileVersion = file.read<uint32_t>();
  if (header.fileVersion < kOldestVersion)
    file.fail("is of .vdb version " + std::to_string(header.fileVersion) + "; versions from " +
              std::to_string(kOldestVersion) + " on are read");
  file.skip(2 * sizeof(uint32_t));  // version of the library that wrote it
  const bool hasPlaces = file.read<char>() != 0;
  if (header.fileVersion < kNoCompressionFlagSince) file.skip(1);
  file.skip(kUuidCharacters);
  header.metadata = readMetadata(file);
  if (!hasPlaces) file.fail("was written as a stream, without the places of its grids, and is not read");
  const int32_t count = file.read<int32_t>();
  if (count < 0) file.fail("is damaged: it counts " + std::to_string(count) + " grids");
  for (int32_t i = 0; i < count; ++i) {
    header.grids.push_back(readEntry(file));
    VdbGridEntry& entry = header.grids.back();
    if (header.fileVersion >= kNoCompressionFlagSince && entry.end - entry.grid >= sizeof(uint32_t)) {
      file.seek(entry.grid);
      entry.compression = file.read<uint32_t>();
    }
    file.seek(entry.end);
  }
  return header;
}

}  // namespace nephele
