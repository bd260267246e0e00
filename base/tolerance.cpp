// Tolerances as text. Depends on base alone.
#include "base/tolerance.h"

#include <charconv>
#include <cmath>

#include "base/error.h"

namespace nephele {

double parseTolerance(const std::string& text) {
  char* end = nullptr;
  double value = std::strtod(text.c_str(), &end);
  std::string rest = text.empty() ? "empty" : end;
  if (rest == "%") {
    constexpr double kPercent = 100.0;
    value /= kPercent;
    rest.clear();
  }
  if (end == text.c_str() || !rest.empty() || !std::isfinite(value) || value < 0.0)
    throw InputError({}, "'" + text + "' is no tolerance; write 0.03 or 3%");
  return value;
}

}  // namespace nephele
