// How far two things may be apart, as the command lines write it. Depends on base alone.
#pragma once

#include <string>

namespace nephele {

/// "0.03" or "3%" → 0.03. Throws InputError for anything else, a negative number, or one that is not finite.
double parseTolerance(const std::string& text);

}  // namespace nephele
