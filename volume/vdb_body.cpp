// Walks grids as OpenVDB's Archive, Tree and nodes write them, versions 222 to 224; all numbers
// little-endian. Depends on vdb_header.h, base and POSIX.
#include "volume/vdb_body.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <set>

#include "base/error.h"

namespace nephele {
namespace {

constexpr uint32_t kOldestWalked = 222;

/// A type of value by its tree's name.
struct ValueType {
  std::string_view tree;
  size_t bytes, halfBytes;  // halfBytes: as stored with half precision
};
constexpr ValueType kValueTypes[] = {{"Tree_float_5_4_3", 4, 2},  {"Tree_double_5_4_3", 8, 2},
                                     {"Tree_vec3s_5_4_3", 12, 6}, {"Tree_vec3d_5_4_3", 24, 6},
                                     {"Tree_int32_5_4_3", 4, 4},  {"Tree_int64_5_4_3", 8, 8},
                                     {"Tree_vec3i_5_4_3", 12, 12}};

/// Bytes of a transform's map, by name: those of its numbers, none of which has a size of its own.
struct MapType {
  std::string_view name;
  size_t bytes;
};
constexpr MapType kMapTypes[] = {{"AffineMap", 128},
                                 {"UnitaryMap", 128},
                                 {"ScaleMap", 120},
                                 {"UniformScaleMap", 120},
                                 {"TranslationMap", 24},
                                 {"ScaleTranslateMap", 144},
                                 {"UniformScaleTranslateMap", 144}};

/// Bytes of metadata whose type has one size.
struct MetadataType {
  std::string_view name;
  size_t bytes;
};
constexpr MetadataType kMetadataTypes[] = {{"bool", 1},   {"int32", 4},  {"int64", 8},  {"float", 4},
                                           {"double", 8}, {"vec2i", 8},  {"vec2s", 8},  {"vec2d", 16},
                                           {"vec3i", 12}, {"vec3s", 12}, {"vec3d", 24}, {"vec4i", 16},
                                           {"vec4s", 16}, {"vec4d", 32}, {"mat4s", 64}, {"mat4d", 128}};

/// A file in memory for as long as this lives.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path, uint64_t bytes) : bytes_(bytes) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) throw WorldError("cannot open '" + path + "'");
    data_ = ::mmap(nullptr, bytes_, PROT_READ, MAP_PRIVATE, file, 0);
    ::close(file);
    if (data_ == MAP_FAILED) throw WorldError("cannot map '" + path + "' into memory");
  }
  ~MappedFile() { ::munmap(data_, bytes_); }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  const unsigned char* data() const { return static_cast<const unsigned char*>(data_); }

 private:
  uint64_t bytes_;
  void* data_;
};

/// One grid's bytes, read from front to back and never beyond its end.
class GridWalk {
 public:
  GridWalk(const std::string& path, const unsigned char* file, const VdbGridEntry& entry,
           const ValueType& type)
      : path_(path), file_(file), entry_(entry), type_(type), at_(entry.grid) {}

  void walk() {
    compression_ = read<uint32_t>();
    if (compression_ > (kZip | kActiveMask | kBlosc)) fail("its compression is unknown");
    walkMetadata();
    if (!walkTransform()) return;  // a map of no fixed size: what follows cannot be found
    walkTopology();
    if (at_ != entry_.blocks) fail("its topology ends elsewhere than its leaves begin");
    for (uint64_t leaf = 0; leaf < leaves_; ++leaf) {
      const unsigned char* const mask = take(kLeafMask);
      walkValues(mask, kLeafMask);
    }
    if (at_ != entry_.end) fail("its leaves end elsewhere than the grid does");
  }

 private:
  // Bytes of a mask: of 8³ values, 16³ and 32³ children.
  static constexpr size_t kLeafMask = 64, kMiddleMask = 512, kUpperMask = 4096;
  static constexpr int32_t kUpperEdge = 4096;  // voxels

  [[noreturn]] void fail(const std::string& sentence) const {
    throw InputError({path_}, "is damaged: in grid '" + entry_.name + "' at byte " + std::to_string(at_) +
                                  ", " + sentence);
  }

  const unsigned char* take(uint64_t bytes) {
    if (bytes > entry_.end - at_) fail(std::to_string(bytes) + " bytes are asked for beyond its end");
    const unsigned char* const here = file_ + at_;
    at_ += bytes;
    return here;
  }

  template <class T>
  static T numberAt(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  template <class T>
  T read() {
    return numberAt<T>(take(sizeof(T)));
  }
  std::string_view readText() {
    const uint32_t length = read<uint32_t>();
    return {reinterpret_cast<const char*>(take(length)), length};
  }

  void walkMetadata() {
    const int32_t count = read<int32_t>();
    if (count < 0) fail("its metadata is counted as " + std::to_string(count));
    for (int32_t n = 0; n < count; ++n) {
      readText();
      const std::string_view type = readText();
      const uint32_t bytes = read<uint32_t>();
      for (const MetadataType& known : kMetadataTypes)
        if (known.name == type && known.bytes != bytes)
          fail("metadata of type " + std::string(type) + " has a wrong size");
      const uint64_t begin = at_;
      if (type == "__delayedload") walkDelayedLoad(bytes);
      at_ = begin;
      take(bytes);
    }
  }

  /// Nothing where there are no leaves; else their count, then one byte and 8 bytes for each of them, each
  /// list in one block.
  void walkDelayedLoad(uint32_t bytes) {
    if (bytes == 0) return;
    const uint64_t end = at_ + bytes;
    const uint64_t count = read<uint32_t>();
    constexpr uint32_t kNone = ~0u;  // no second list
    for (const uint64_t each : {uint64_t{1}, uint64_t{8}}) {
      const uint32_t compressed = read<uint32_t>();
      if (each == 8 && compressed == kNone) break;
      if (compressed == 0)
        take(count * each);
      else
        // Blosc pads what is shorter than 128 bytes.
        walkBlosc(compressed, std::max<uint64_t>(count * each, 128));
    }
    if (at_ > end) fail("its delayed loading is longer than it says");
  }

  bool walkTransform() {
    const std::string_view map = readText();
    for (const MapType& known : kMapTypes)
      if (known.name == map) return take(known.bytes), true;
    return false;
  }

  void walkTopology() {
    if (read<int32_t>() != 1) fail("its leaves have more buffers than one");
    take(type_.bytes);  // background
    const uint32_t tiles = read<uint32_t>(), children = read<uint32_t>();
    std::set<std::array<int32_t, 3>> origins;
    for (uint32_t n = 0; n < tiles; ++n) {
      walkOrigin(origins);
      take(type_.bytes + 1);  // value and whether it is active
    }
    for (uint32_t n = 0; n < children; ++n) {
      walkOrigin(origins);
      walkNode(kUpperMask, [this] {
        walkNode(kMiddleMask, [this] {
          take(kLeafMask);
          ++leaves_;
        });
      });
    }
  }

  void walkOrigin(std::set<std::array<int32_t, 3>>& origins) {
    std::array<int32_t, 3> origin;
    for (int32_t& c : origin) {
      c = read<int32_t>();
      if (c % kUpperEdge != 0) fail("a node lies at " + std::to_string(c) + ", no multiple of 4096");
    }
    if (!origins.insert(origin).second) fail("two nodes lie in one place");
  }

  template <class Child>
  void walkNode(size_t maskBytes, const Child& child) {
    const unsigned char* const children = take(maskBytes);
    const unsigned char* const active = take(maskBytes);
    walkValues(active, maskBytes);
    for (size_t n = countOf(children, maskBytes); n > 0; --n) child();
  }

  static size_t countOf(const unsigned char* mask, size_t bytes) {
    size_t count = 0;
    for (size_t n = 0; n < bytes; n += sizeof(uint64_t))
      count += size_t(std::popcount(numberAt<uint64_t>(mask + n)));
    return count;
  }

  /// The values of a node or leaf (readCompressedValues): which inactive values there are, then a block.
  void walkValues(const unsigned char* active, size_t maskBytes) {
    // How inactive values are told: 0, 1 by the background; 2 one value; 3, 4, 5 by a mask and none, one or
    // two values; 6 all are stored.
    constexpr uint8_t kOneValue = 2, kMask = 3, kMaskOneValue = 4, kMaskTwoValues = 5, kAllStored = 6;
    const uint8_t kind = read<uint8_t>();
    if (kind > kAllStored) fail("inactive values are told in an unknown way");
    if (kind == kOneValue || kind == kMaskOneValue || kind == kMaskTwoValues) take(type_.bytes);
    if (kind == kMaskTwoValues) take(type_.bytes);
    if (kind == kMask || kind == kMaskOneValue || kind == kMaskTwoValues) take(maskBytes);
    const bool few = (compression_ & kActiveMask) != 0 && kind != kAllStored;
    const size_t count = few ? countOf(active, maskBytes) : maskBytes * 8;
    if (entry_.half && count == 0 && type_.halfBytes != type_.bytes) return;
    walkBlock(count * (entry_.half ? type_.halfBytes : type_.bytes));
  }

  void walkBlock(uint64_t bytes) {
    if ((compression_ & (kBlosc | kZip)) == 0) {
      take(bytes);
      return;
    }
    const int64_t stored = read<int64_t>();
    if (stored <= 0) {
      if (uint64_t{0} - uint64_t(stored) != bytes)  // the negative of its size: stored as it is
        fail("a block does not hold " + std::to_string(bytes) + " bytes");
      take(bytes);
    } else if ((compression_ & kBlosc) != 0) {
      walkBlosc(uint64_t(stored), bytes);
    } else {
      take(uint64_t(stored));
    }
  }

  /// A compressed block of Blosc 1, whose head repeats both sizes.
  void walkBlosc(uint64_t stored, uint64_t bytes) {
    constexpr size_t kHead = 16, kBytesAt = 4, kStoredAt = 12;
    const unsigned char* const block = take(stored);
    if (stored < kHead || numberAt<uint32_t>(block + kStoredAt) != stored ||
        numberAt<uint32_t>(block + kBytesAt) != bytes)
      fail("a compressed block's sizes do not fit");
  }

  const std::string& path_;
  const unsigned char* file_;
  const VdbGridEntry& entry_;
  const ValueType& type_;
  uint64_t at_;
  uint32_t compression_ = 0;
  uint64_t leaves_ = 0;
};

}  // namespace

void checkVdbBody(const std::string& path, const VdbHeader& header) {
  if (header.fileVersion < kOldestWalked || header.grids.empty()) return;
  const MappedFile file(path, header.sizeBytes);
  for (const VdbGridEntry& entry : header.grids)
    for (const ValueType& type : kValueTypes)
      if (type.tree == entry.type && !entry.sharesTree) GridWalk(path, file.data(), entry, type).walk();
}

}  // namespace nephele
