// Notices that a file has changed and settled. Depends on the file system alone.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace nephele {

/// What tells one state of a file from another: a rename over it changes the inode, a write the rest.
struct FileStamp {
  int64_t modifiedNanoseconds = 0;
  uint64_t sizeBytes = 0;
  uint64_t inode = 0;
  bool operator==(const FileStamp&) const = default;
};

/// nullopt where there is no such file. Folders have stamps too: they change with the names in them.
std::optional<FileStamp> stampOf(const std::string& path);

/// Watches one path. Asked at intervals, it reports a change once it has looked the same twice in a row, so
/// that a file is not read while it is being written; a file that is missing is waited for.
class FileWatch {
 public:
  using Stamp = std::function<std::optional<FileStamp>(const std::string& path)>;
  /// `known`: the state that the watcher's owner has read.
  FileWatch(std::string path, std::optional<FileStamp> known, Stamp stamp = stampOf);

  /// Whether the file is another than the one known or last reported, and has settled.
  bool poll();
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  Stamp stamp_;
  std::optional<FileStamp> known_;
  std::optional<FileStamp> last_;
};

}  // namespace nephele
