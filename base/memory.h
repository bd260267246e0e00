// How much memory there is. Depends on nothing.
#pragma once

#include <cstdint>

namespace nephele {

/// Bytes that the process may still take: what Linux calls available, less where a limit of the process
/// (RLIMIT_AS) or of the control group that it sees as the root, as in a container (version 2), is nearer.
uint64_t availableMemory();

}  // namespace nephele
