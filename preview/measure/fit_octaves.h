// The octaves' factors a, b, c, d fitted to all orders of scattering by least squares, for low, middle and
// high suns. Depends on preview/method.h, scene and preview/measure alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "preview/measure/compare.h"
#include "preview/measure/octave_form.h"
#include "preview/method.h"

namespace nephele {

inline constexpr OctaveFactors kUnfittedFactors{0.5, 0.5, 0.5, 0.0};

/// One volume, and a view of it to turn cameras and suns about: its lights are replaced by one sun, its
/// environment by none.
struct FitSubject {
  std::string name;
  const BrickVolume* bricks = nullptr;  // outlives the fit
  ViewedScene view;
};

struct FitOptions {
  std::optional<int> count;     // octaves beyond the first; none: the fewest that do nearly as well as many
  int width = 48, height = 36;  // of each picture, pixels
  unsigned samples = 16;        // of the march, a pixel
  double truthError = 0.2;      // noise of truth, relative RMSE: between halves it cancels
  bool quiet = false;
};

/// One camera and sun of one subject.
struct FitView {
  size_t subject = 0;
  std::string name;
  bool fitted = true;      // false: held back, to check
  double elevation = 0.0;  // of the sun, degrees
  ViewedScene view;
  Picture truth;
  NoisyError before, after;      // with kUnfittedFactors, and with the fitted ones
  std::optional<double> atBest;  // with factors fitted to this view alone; none: a view of a check
};

struct FitResult {
  SunFactors factors{kUnfittedFactors, kUnfittedFactors, kUnfittedFactors};
  int count = 0;
  std::vector<FitView> views;
};

enum class FitStage { before, after, atBest };

/// Root mean square of the views' errors that are known at that stage, of those fitted or of those held back.
double errorOver(const std::vector<FitView>& views, bool fitted, FitStage stage);

/// Whether the fitted factors leave views held back farther from truth than kUnfittedFactors do.
bool worsensHeldBack(const std::vector<FitView>& views);

/// Fits over twelve cameras and suns of each of `subjects`, four at each of kFittedElevations, and measures
/// before and after on them, on eight others of each, and on all twenty of each of `checks`. Throws
/// InputError where a subject scatters nothing.
FitResult fitOctaves(Method& march, Method& truth, const std::vector<FitSubject>& subjects,
                     const std::vector<FitSubject>& checks, const FitOptions& options);

}  // namespace nephele
