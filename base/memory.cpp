// How much memory there is, from Linux's files. Depends on memory.h.
#include "base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace nephele {
namespace {

constexpr uint64_t kEndless = std::numeric_limits<uint64_t>::max();

/// The number after `key` in a file of Linux; kEndless where there is none. An empty key: the first word.
uint64_t numberIn(const char* file, const std::string& key) {
  std::ifstream in(file);
  std::string word;
  while (!key.empty() && in >> word && word != key) continue;
  uint64_t number = 0;
  return in >> number ? number : kEndless;
}

uint64_t left(uint64_t limit, uint64_t used) {
  return limit == kEndless || used == kEndless ? kEndless : limit - std::min(limit, used);
}

/// What the address space may still grow by.
uint64_t leftOfAddresses() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kEndless;
  const uint64_t pages = numberIn("/proc/self/statm", "");
  return left(limit.rlim_cur, pages == kEndless ? kEndless : pages * uint64_t(sysconf(_SC_PAGESIZE)));
}

}  // namespace

uint64_t availableMemory() {
  const uint64_t kilobytes = numberIn("/proc/meminfo", "MemAvailable:");
  const uint64_t ofMachine = kilobytes == kEndless
                                 ? uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE))
                                 : kilobytes * 1024;
  // Of what the group holds, copies of files that are not in use are given up on demand.
  const uint64_t ofGroup = left(numberIn("/sys/fs/cgroup/memory.max", ""),
                                left(numberIn("/sys/fs/cgroup/memory.current", ""),
                                     numberIn("/sys/fs/cgroup/memory.stat", "inactive_file")));
  return std::min({ofMachine, ofGroup, leftOfAddresses()});
}

}  // namespace nephele
