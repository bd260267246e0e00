// Figures as text. Depends on figures.h alone.
#include "base/figures.h"

#include <cstdio>

namespace nephele {

std::string number(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string percent(double share) {
  constexpr double kPercent = 100.0;
  return number(kPercent * share, 3) + "%";
}

}  // namespace nephele
