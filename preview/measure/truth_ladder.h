// Truth of a sparse picture in steps of less and less noise, traced as they are asked for, and whether a
// picture errs by no more than is asked. Depends on preview/method.h, scene and preview/measure alone.
#pragma once

#include <vector>

#include "preview/measure/compare.h"
#include "preview/method.h"

namespace nephele {

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
  /// what the least that truth can be asked takes.
  double millisecondsFor(double error);

 private:
  const Picture& at(size_t step);
  double noiseOf(size_t step) const;

  Method& truth_;
  const ViewedScene& view_;
  PictureRequest sparse_;
  double fewPixels_ = 1.0;  // less noise than 8000 pixels need
  std::vector<Picture> steps_;
  double millisecondsAtOne_ = 0.0;  // at a noise of 1, had it any
  double millisecondsLeast_ = 0.0;
};

}  // namespace nephele
