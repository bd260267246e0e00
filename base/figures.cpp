// Figures as text. Depends on figures.h alone.
#include "base/figures.h"

#include <cstdio>

namespace nephele {
namespace {
constexpr double kPercent = 100.0;
}

std::string number(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string percent(double share) { return number(kPercent * share, 3) + "%"; }

std::string shortPercent(double share) {
  constexpr double kTwoPlaces = 0.01, kOnePlace = 0.1;  // below
  char text[40];
  std::snprintf(text, sizeof text, "%.*f%%",
                share < kTwoPlaces  ? 2
                : share < kOnePlace ? 1
                                    : 0,
                kPercent * share);
  return text;
}

}  // namespace nephele
