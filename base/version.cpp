// The program's version, handed over by CMake.
#include "base/version.h"

namespace nephele {

std::string_view programVersion() { return NEPHELE_VERSION; }

}  // namespace nephele
