// The program's version, in one place. Depends on nothing.
#pragma once

#include <string_view>

namespace nephele {

/// "0.1.0", from CMakeLists.txt.
std::string_view programVersion();

}  // namespace nephele
