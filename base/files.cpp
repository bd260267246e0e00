// Whole-or-not writing by a temporary file and a rename, and the cleaning up after crashes. Depends on base
// and POSIX.
#include "base/files.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "base/error.h"

namespace nephele {
namespace {

constexpr std::string_view kPartialSuffix = ".partial";

std::string folderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

std::string reasonOf(int errorNumber) { return std::generic_category().message(errorNumber); }

/// Closes its descriptor when it goes.
struct Descriptor {
  int number;
  explicit Descriptor(int n) : number(n) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
};

void flushToDisk(const std::string& path, const std::string& finalPath) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number < 0 || ::fsync(file.number) != 0)
    throw WorldError("cannot write '" + finalPath + "': " + reasonOf(errno));
}

/// Removes the temporary file unless it was renamed.
struct TemporaryFile {
  std::string path;
  bool renamed = false;
  explicit TemporaryFile(std::string p) : path(std::move(p)) {}
  ~TemporaryFile() {
    if (!renamed) ::unlink(path.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
};

/// The process id in ".NAME.PID.partial", or 0 where the name is none of ours.
pid_t writerOf(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(kPartialSuffix)) return 0;
  name.remove_suffix(kPartialSuffix.size());
  const size_t dot = name.rfind('.');
  if (dot == 0 || dot == std::string_view::npos) return 0;
  const std::string_view digits = name.substr(dot + 1);
  pid_t pid = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), pid);
  return error == std::errc() && end == digits.data() + digits.size() && pid > 0 ? pid : 0;
}

bool isAlive(pid_t pid) { return ::kill(pid, 0) == 0 || errno != ESRCH; }

}  // namespace

void writeWhole(const std::string& path, const std::function<void(const std::string& temporary)>& write) {
  const std::string folder = folderOf(path);
  const std::string name = std::filesystem::path(path).filename().string();
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw WorldError("cannot write '" + path + "': the folder '" + folder + "': " + reasonOf(errno));
  if (name.empty() || std::filesystem::is_directory(path))
    throw WorldError("cannot write '" + path + "': it is a folder");
  TemporaryFile temporary(folder + "/." + name + "." + std::to_string(::getpid()) +
                          std::string(kPartialSuffix));
  write(temporary.path);
  flushToDisk(temporary.path, path);
  if (::rename(temporary.path.c_str(), path.c_str()) != 0)
    throw WorldError("cannot write '" + path + "': " + reasonOf(errno));
  temporary.renamed = true;
  // The name itself is durable once the folder is flushed; some file systems refuse that, and the file is
  // whole anyway.
  const Descriptor folderFile(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folderFile.number >= 0) ::fsync(folderFile.number);
}

void writeText(const std::string& path, const std::string& text) {
  writeWhole(path, [&](const std::string& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    out.close();
    if (!out) throw WorldError("cannot write '" + path + "'; is the disk full?");
  });
}

void requireWritable(const std::string& path) {
  const std::string place = folderOf(path);
  std::error_code error;
  if (!std::filesystem::is_directory(place, error))
    throw WorldError("cannot write '" + path + "': there is no folder '" + place + "'");
  if (::access(place.c_str(), W_OK | X_OK) != 0)
    throw WorldError("cannot write '" + path + "': " + reasonOf(errno));
}

int removeLeftovers(const std::string& folder) {
  int removed = 0;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const pid_t writer = writerOf(entry->path().filename().string());
    std::error_code ignored;
    if (writer == 0 || isAlive(writer) || !entry->is_regular_file(ignored)) continue;
    if (std::filesystem::remove(entry->path(), ignored)) ++removed;
  }
  return removed;
}

std::string readWhole(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number < 0) {
    const int reason = errno;
    throw InputError({path}, reason == ENOENT ? "no such file" : "cannot be opened: " + reasonOf(reason));
  }
  struct stat status {};
  if (::fstat(file.number, &status) != 0) throw WorldError("cannot read '" + path + "': " + reasonOf(errno));
  if (S_ISDIR(status.st_mode)) throw InputError({path}, "is a folder, not a file");
  constexpr size_t kChunkBytes = 1 << 20;
  std::string content;
  size_t used = 0;
  while (true) {
    // Pipes have no size, so the text grows as it comes.
    content.resize(std::max(used + kChunkBytes, static_cast<size_t>(status.st_size) + 1));
    const ssize_t got = ::read(file.number, content.data() + used, content.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw WorldError("cannot read '" + path + "': " + reasonOf(errno));
    if (got == 0) break;
    used += static_cast<size_t>(got);
  }
  content.resize(used);
  return content;
}

}  // namespace nephele
