// Interval arithmetic for bounds of fields: closed intervals of double that certainly contain the float
// results. Depends on nothing.
#pragma once

#include <algorithm>
#include <cmath>

namespace nephele {

struct Interval {
  double low = 0.0;
  double high = 0.0;

  bool exact() const { return low == high; }
  /// Whether it is one value, and that a finite float: what float operations make of it is one value too.
  bool isFloat() const { return exact() && double(float(low)) == low && std::isfinite(low); }
};

/// The interval of one float.
inline Interval single(float value) { return {double(value), double(value)}; }

/// Room for the rounding of one float operation whose results lie in the interval: one part in 2^22 of the
/// larger end, four units in the last place. Exact 0 stays exact.
inline Interval rounded(const Interval& a) {
  constexpr double kFloatRoom = 1.0 / 4194304.0;
  if (a.low == 0.0 && a.high == 0.0) return a;
  const double room = kFloatRoom * std::max(std::abs(a.low), std::abs(a.high));
  // A result that underflows may leave the interval by less than the smallest normal float.
  constexpr double kFloatTiny = 1.2e-38;
  return {a.low - room - kFloatTiny, a.high + room + kFloatTiny};
}

inline Interval operator+(const Interval& a, const Interval& b) {
  return rounded({a.low + b.low, a.high + b.high});
}
inline Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
inline Interval operator-(const Interval& a, const Interval& b) { return a + (-b); }
inline Interval operator*(const Interval& a, const Interval& b) {
  // 0 · anything is 0, also where the other end is infinite.
  const auto product = [](double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : x * y; };
  const double p = product(a.low, b.low), q = product(a.low, b.high), r = product(a.high, b.low),
               s = product(a.high, b.high);
  return rounded({std::min({p, q, r, s}), std::max({p, q, r, s})});
}
inline Interval scaled(const Interval& a, double by) { return a * Interval{by, by}; }
inline Interval minimum(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::min(a.high, b.high)};
}
inline Interval maximum(const Interval& a, const Interval& b) {
  return {std::max(a.low, b.low), std::max(a.high, b.high)};
}
inline Interval clamped(const Interval& a, double low, double high) {
  return {std::clamp(a.low, low, high), std::clamp(a.high, low, high)};
}
inline Interval hullOf(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}
/// The part of `a` in `b`, where both are known to hold the same values.
inline Interval both(const Interval& a, const Interval& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}
inline bool containsValue(const Interval& a, double v) { return a.low <= v && v <= a.high; }

}  // namespace nephele
