// The octaves' factors a, b, c fitted to all orders of scattering by least squares. Depends on
// preview/method.h, scene and preview/measure alone.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "preview/measure/compare.h"
#include "preview/method.h"

namespace nephele {

using OctaveFactors = std::array<double, 3>;  // a, b, c, each in [0, 1]
inline constexpr OctaveFactors kUnfittedFactors{0.5, 0.5, 0.5};

/// One volume, and a view of it to turn cameras and suns about: its lights are replaced by one sun, its
/// environment by none.
struct FitSubject {
  std::string name;
  const BrickVolume* bricks = nullptr;  // outlives the fit
  ViewedScene view;
};

struct FitOptions {
  int count = 6;                // octaves beyond the first
  int width = 48, height = 36;  // of each picture, pixels
  unsigned samples = 4;         // of the march, a pixel
  double truthError = 0.05;     // noise of truth, relative RMSE
  bool quiet = false;
};

/// One camera and sun of one subject.
struct FitView {
  size_t subject = 0;
  std::string name;
  bool fitted = true;  // false: held back, to check
  ViewedScene view;
  Picture truth;
  NoisyError before, after;  // with kUnfittedFactors, and with the fitted ones
};

struct FitResult {
  OctaveFactors factors = kUnfittedFactors;
  std::vector<FitView> views;
  size_t evaluations = 0;
};

/// Root mean square of the views' errors, of those fitted or of those held back.
double errorOver(const std::vector<FitView>& views, bool fitted, bool after);

/// Fits over six cameras and suns of each of `subjects`, and measures before and after on them, on four
/// others of each, and on all ten of each of `checks`. Throws InputError where a subject scatters nothing.
FitResult fitOctaves(Method& march, Method& truth, const std::vector<FitSubject>& subjects,
                     const std::vector<FitSubject>& checks, const FitOptions& options);

/// The point in [0, 1]³ at which `cost` is least: Nelder and Mead (1965) from `start`, until the simplex is
/// smaller than `tolerance` along each axis or `most` evaluations are spent. What it costs outside is not
/// asked.
OctaveFactors leastOf(const std::function<double(const OctaveFactors&)>& cost, const OctaveFactors& start,
                      double tolerance, size_t most);

}  // namespace nephele
