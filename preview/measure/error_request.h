// The cheapest way to a picture that errs by no more than is asked: settings of the march and the reference
// itself, measured on a sparse grid of the picture's pixels. Depends on preview/method.h, scene and
// preview/measure alone.
#pragma once

#include <optional>
#include <vector>

#include "preview/measure/sweep.h"
#include "preview/measure/truth_ladder.h"

namespace nephele {

/// How a picture is to be made. `setting.method` is "march", or "reference" where no march gets there or
/// truth is cheaper.
struct ErrorPick {
  Setting setting;
  double error = 0.0;         // expected, relative RMSE: the upper end of what was measured
  double milliseconds = 0.0;  // expected for the whole picture
  double work = 0.0;          // expected of the whole picture, as workOf and workOfTruth
  size_t rung = 0;            // its place by work
};

/// A way to be measured.
struct ErrorRung {
  Setting setting;
  size_t candidate = 0;            // which of marchCandidates
  double work = 0.0;               // of the whole picture, from one sample a pixel
  double preparing = 0.0;          // of it, whatever the samples
  double milliseconds = 0.0;       // of the whole picture, from the work
  Picture picture;                 // sparse; empty: not looked at
  std::vector<NoisyError> errors;  // by the steps of truth that were asked
};

/// Scatterings after the first in a scene's own truth: `given`; where none is, 0 if its octaves are none,
/// else all.
std::optional<int> bouncesOfTruth(const ViewedScene& view, std::optional<int> given);

/// Throws InputError with one sentence where a scene has no truth to err from: the `report` look.
void requireTruth(const ViewedScene& view);

/// A setting of the march, its samples aside, and how many of them are tried: doubled from the least to the
/// most.
struct MarchCandidate {
  Setting setting;
  unsigned least = 1, most = 1;
};

/// What is tried: steps from 4 voxels to 1/4, light cached and marched. What they do not set is the scene's.
std::vector<MarchCandidate> marchCandidates(const Scene& scene);

/// What a march costs, in densities read: these themselves, more where each asks the light cache as well, and
/// each ray's way through the index. Counted, not timed: the same under any load.
double workOf(const Setting& setting, double densitiesPreparing, double densities, double rays);

/// Holds what was measured for one volume, camera, light and size. Methods have their volume set, and with
/// the view outlive the search. Used from one thread.
class ErrorSearch {
 public:
  /// Renders one sample of each candidate on about 8000 of the pixels; `whole` is the picture asked for, its
  /// samples not looked at.
  ErrorSearch(Method& march, Method& truth, const ViewedScene& view, const PictureRequest& whole);

  /// Goes up by work, from the rung `from` on, until a setting's error, the upper end of its 95% interval, is
  /// at most `error`; the reference where none is that is expected to take less work. Seeds, truth and order
  /// do not depend on `error`, what passes for a tight one passes for a looser one, and truth's work never
  /// grows with `error`: so a looser one never picks more work, whatever the clock says.
  ErrorPick pick(double error, size_t from = 0);

  struct Verdict {
    NoisyError error;  // against the least noisy truth that was asked
    bool kept = false;
  };
  /// Whether a whole picture errs by at most `error`, against truth of its own on the same pixels. One that
  /// does keeps any looser one too.
  Verdict measure(const Picture& picture, double error);

  int stride() const { return sparse_.stride; }
  size_t measuredRungs() const;

 private:
  /// Sparse pictures of one sample: what they took, and their work, without and for what is prepared.
  struct Spent {
    double milliseconds = 0.0, work = 0.0;
    double millisecondsPreparing = 0.0, workPreparing = 0.0;
  };
  void addRungs(const MarchCandidate& candidate, size_t index, Spent& spent);
  void tellTimes(const Spent& spent);
  Picture renderSparse(const Setting& setting, PictureCost& cost);
  bool passes(ErrorRung& rung, double error);

  Method& march_;
  const ViewedScene& view_;
  PictureRequest sparse_;
  double share_;  // pixels of the whole picture over those of the sparse one
  double unit_;   // of the march's work, in truth's
  TruthLadder choosing_, measuring_;
  std::vector<ErrorRung> rungs_;  // by work
};

}  // namespace nephele
