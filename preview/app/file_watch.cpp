// Stamps and their changes. Depends on POSIX.
#include "preview/app/file_watch.h"

#include <sys/stat.h>

namespace nephele {

std::optional<FileStamp> stampOf(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  constexpr int64_t kNanoseconds = 1'000'000'000;
  return FileStamp{int64_t{status.st_mtim.tv_sec} * kNanoseconds + status.st_mtim.tv_nsec,
                   static_cast<uint64_t>(status.st_size), static_cast<uint64_t>(status.st_ino)};
}

FileWatch::FileWatch(std::string path, std::optional<FileStamp> known, Stamp stamp)
    : path_(std::move(path)), stamp_(std::move(stamp)), known_(known), last_(known) {}

bool FileWatch::poll() {
  const std::optional<FileStamp> now = stamp_(path_);
  const bool settled = now == last_;
  last_ = now;
  if (!now || !settled || now == known_) return false;
  known_ = now;
  return true;
}

}  // namespace nephele
