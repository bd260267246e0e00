// The cheapest way to a picture that errs by no more than is asked: settings of the march and the reference
// itself, measured on a sparse grid of the picture's pixels. Depends on preview/method.h, scene and
// preview/measure alone.
#pragma once

#include <optional>
#include <vector>

#include "preview/measure/sweep.h"

namespace nephele {

/// How a picture is to be made. `setting.method` is "march", or "reference" where no march gets there or
/// truth is cheaper.
struct ErrorPick {
  Setting setting;
  double error = 0.0;         // expected, relative RMSE: the upper end of what was measured
  double milliseconds = 0.0;  // expected for the whole picture
};

/// A way that was measured.
struct ErrorRung {
  Setting setting;
  double milliseconds = 0.0;        // of the whole picture, from one sample a pixel
  double preparing = 0.0;           // of these, whatever the samples
  std::optional<NoisyError> error;  // none: not looked at
};

/// Scatterings after the first in a scene's own truth: `given`; where none is, 0 if its octaves are none,
/// else all.
std::optional<int> bouncesOfTruth(const ViewedScene& view, std::optional<int> given);

/// Throws InputError with one sentence where a scene has no truth to err from: the `report` look.
void requireTruth(const ViewedScene& view);

/// The march's settings that are tried, without samples: steps from 4 voxels to 1/4, light cached and
/// marched. What they do not set is the scene's.
std::vector<Setting> marchCandidates(const Scene& scene);

/// Holds what was measured for one volume, camera, light and size. Methods have their volume set, and with
/// the view outlive the search. Used from one thread.
class ErrorSearch {
 public:
  /// Traces truth and one sample of each candidate on about 8000 of the pixels; `whole` is the picture asked
  /// for, its samples not looked at. `error` is the smallest that will be asked for: below 2% truth is
  /// traced longer.
  ErrorSearch(Method& march, Method& truth, const ViewedScene& view, const PictureRequest& whole,
              double error);

  /// Goes up by expected cost until a setting's error, the upper end of its 95% interval, is at most `error`;
  /// the reference where its expected cost comes first. So a larger `error` is never expected to cost more.
  ErrorPick pick(double error);
  /// What a whole picture errs by, against truth of its own on the same pixels.
  NoisyError measure(const Picture& picture);

  const std::vector<ErrorRung>& rungs() const { return rungs_; }  // by cost
  int stride() const { return sparse_.stride; }
  size_t measuredRungs() const;

 private:
  void calibrate();
  Picture renderSparse(const Setting& setting, PictureCost& cost);
  bool canReach(const ErrorRung& rung, double error) const;

  Method &march_, &truth_;
  const ViewedScene& view_;
  PictureRequest sparse_;
  double truthNoise_;
  Picture sparseTruth_;
  double truthCost_ = 0.0;  // milliseconds of the whole picture at a noise of 1
  std::vector<ErrorRung> rungs_;
};

}  // namespace nephele
