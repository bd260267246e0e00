// Where in its cycle an evolving noise is, and sine and cosine of turns that every machine computes alike.
// Depends on GLM alone.
#pragma once

#include <cmath>
#include <glm/vec4.hpp>
#include <utility>

namespace nephele {

/// Cosine and sine of an angle given in turns, within 1e-15; exact at quarter turns. Any finite angle.
inline std::pair<double, double> cosineAndSine(double turns) {
  constexpr double kTwoPi = 6.283185307179586;
  const double quarter = std::floor(4.0 * turns + 0.5);
  const double x = kTwoPi * (turns - 0.25 * quarter);  // within ± π/4
  // Their series by Horner's rule; the terms left out are below (π/4)^18/18!, 2e-18.
  double cosine = 1.0, sine = 1.0;
  for (int n = 16; n > 0; n -= 2) {
    cosine = 1.0 - x * x / double(n * (n - 1)) * cosine;
    sine = 1.0 - x * x / double(n * (n + 1)) * sine;
  }
  sine *= x;
  switch (int(quarter - 4.0 * std::floor(0.25 * quarter))) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

/// How far the lattice points of a noise have turned (turnOf in the shared text).
struct Turn {
  bool evolves = false;                  // false: the plain noise, whatever `at` says
  glm::vec4 at{1.0f, 0.0f, 1.0f, 0.0f};  // cosine and sine of the cycle's angle, then of twice the angle
};

/// An evolving noise at `turns` cycles; whole cycles make no difference, not even in the last bit where
/// `turns` is below 2^50.
inline Turn turnAt(double turns) {
  const double share = turns - std::floor(turns);
  const auto [c1, s1] = cosineAndSine(share);
  const auto [c2, s2] = cosineAndSine(2.0 * share);
  return {true, {float(c1), float(s1), float(c2), float(s2)}};
}

}  // namespace nephele
