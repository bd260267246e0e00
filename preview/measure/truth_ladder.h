// Truth of a sparse picture in steps of less and less noise, traced as they are asked for, and whether a
// picture errs by no more than is asked. Depends on preview/method.h, scene and preview/measure alone.
#pragma once

#include <vector>

#include "preview/measure/compare.h"
#include "preview/method.h"

namespace nephele {

/// Samples a pixel at most where truth is asked for a noise: points in the medium have one that no number of
/// samples takes away.
inline constexpr unsigned kMostTruthSamples = 2048;

/// What a picture of truth costs in densities that the march reads on the processor: looks at densities and
/// paths, counted, not timed.
double workOfTruth(double looks, double paths);

/// Used from one thread. The method, its volume set, and the view outlive it.
class TruthLadder {
 public:
  /// `sparse`: the pixels, orders and seed of truth.
  TruthLadder(Method& truth, const ViewedScene& view, const PictureRequest& sparse);

  /// What a picture errs by against step `step` from 0 on, the noisiest.
  NoisyError compared(const Picture& picture, size_t step);
  /// The step that an `error` above 0 is held to: it and those before are asked.
  static size_t stepFor(double error);
  /// What `step` may say of a picture that errs by `error`: at least what it can tell. It never shrinks as
  /// `error` grows, and stepFor never grows, so that what passes for a tight error passes for a looser one.
  static double allowed(double error, size_t step);
  /// Expected of this sparse picture at a noise of `error`: from what the first step took, and no less than
  /// what the least that truth can be asked takes. It never grows with `error`.
  double workFor(double error);          // counted, as workOfTruth has it
  double millisecondsFor(double error);  // by the clock

 private:
  const Picture& at(size_t step);
  double noiseOf(size_t step) const;

  Method& truth_;
  const ViewedScene& view_;
  PictureRequest sparse_;
  double fewPixels_ = 1.0;  // less noise than 8000 pixels need
  std::vector<Picture> steps_;
  struct Cost {
    double work = 0.0, milliseconds = 0.0;
  };
  Cost costOf(const PictureCost& cost) const;
  void measureLeast();

  Cost atOne_;  // at a noise of 1, had it any
  Cost least_;
};

}  // namespace nephele
