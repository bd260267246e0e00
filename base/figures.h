// Figures as people read them, in pages and sentences. Depends on nothing.
#pragma once

#include <string>

namespace nephele {

/// With so many significant digits.
std::string number(double value, int digits = 5);

/// 0.0234 as "2.34%": three significant digits.
std::string percent(double share);

/// As short as a glance needs: "0.40%", "1.3%", "13%".
std::string shortPercent(double share);

}  // namespace nephele
