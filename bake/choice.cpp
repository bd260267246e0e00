// The search behind a tolerance. Depends on choice.h, trial.h, base, volume/difference.h.
#include "bake/choice.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "bake/trial.h"
#include "base/figures.h"
#include "volume/difference.h"

namespace nephele {
namespace {

// The first bake has this many voxels along the longest side, and this many along the shortest, so that a
// thin sheet is seen at all.
constexpr double kFirstAlongLongest = 16.0, kFirstAlongShortest = 2.0;
// Each bisection divides the ratio of two sizes by its square root: three leave 2^(1/8), 30% of the voxels.
constexpr int kBisections = 3;
// A reference of more active voxels is not baked: it and its bricks take 3 GB.
constexpr double kMostVoxels = 2.5e8;
constexpr uint64_t kSearchSeed = 0, kConfirmingSeed = 0x636f6e66;
// What confirming makes of voxels that do not hold: 2^(-1/4), 1.7 times as many.
constexpr double kFiner = 0.8408964152537145;

std::string shown(double value) { return number(value, 4); }

Asset lookOf(const Asset& asset, double voxelSize, Precision precision, int octaves) {
  Asset look = asset;
  look.voxelSize = voxelSize;
  look.precision = precision;
  look.mostOctaves = octaves;
  return look;
}

/// The bakes of all frames.
using Frames = std::vector<TrialBake>;

uint64_t mostActive(const Frames& frames) {
  uint64_t most = 0;
  for (const TrialBake& bake : frames) most = std::max(most, bake.voxelsActive);
  return most;
}

/// Over the largest depth of all frames: a sequence is seen under one light, whatever its first frame holds.
double errorOf(const Frames& reference, const Frames& look, uint64_t rays, uint64_t seed) {
  DepthDifference worst;
  for (size_t n = 0; n < look.size(); ++n) {
    const DepthDifference d = depthDifference(reference[n].bricks, look[n].bricks, rays, seed);
    worst.largest = std::max(worst.largest, d.largest);
    worst.largestA = std::max(worst.largestA, d.largestA);
  }
  return worst.relative();
}

class Search {
 public:
  Search(const Pipeline& pipeline, const Asset& asset, const std::string& outFolder)
      : asset_(asset), frames_(sampledFrames(asset)), baker_(pipeline, asset, frames_, outFolder) {
    choice_.asked = *asset.tolerance;
    choice_.rays = kConfirmingRays;
    choice_.frames = frames_;
  }

  Choice run() {
    const auto start = std::chrono::steady_clock::now();
    descend();
    bisect();
    choice_.asset = lookOf(asset_, size_, Precision::single, kAllOctaves);
    if (!(asset_.precisionGiven && asset_.precision == Precision::single)) takeHalf();
    takeFewerOctaves();
    confirm();
    tellWhatIsLeftOut();
    choice_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(choice_);
  }

 private:
  double limit() const { return kChoiceShare * choice_.asked; }

  Frames bakeAll(const Asset& look) const {
    Frames frames;
    for (size_t n = 0; n < frames_.size(); ++n) frames.push_back(baker_.bake(n, look));
    return frames;
  }
  Frames bakeAt(double size) const { return bakeAll(lookOf(asset_, size, Precision::single, kAllOctaves)); }

  /// Holds a bake against a reference, and writes that down.
  double measure(const Asset& look, const Frames& bakes, const Frames& reference) {
    const double error = errorOf(reference, bakes, kChoiceRays, kSearchSeed);
    choice_.trials.push_back({look.voxelSize, look.precision, look.mostOctaves, error, mostActive(bakes)});
    return error;
  }

  double firstSize() const {
    const TrialBaker::Extent extent = baker_.extent();
    if (!(extent.longest > 0.0))
      throw InputError(asset_.where,
                       "asset '" + asset_.name +
                           "': a tolerance needs a density that ends somewhere and is not empty; "
                           "give 'voxel_size'");
    const double size = extent.longest / kFirstAlongLongest;
    return extent.shortest > 0.0 ? std::min(size, extent.shortest / kFirstAlongShortest) : size;
  }

  /// Halves the voxels until the tolerance holds.
  void descend() {
    size_ = firstSize();
    Frames coarse = bakeAt(size_);
    coarser_ = 0.0;
    for (;;) {
      constexpr double kEightTimes = 8.0;
      if (kEightTimes * double(mostActive(coarse)) > kMostVoxels) refuse();
      Frames fine = bakeAt(0.5 * size_);
      choice_.measured = measure(lookOf(asset_, size_, Precision::single, kAllOctaves), coarse, fine);
      if (choice_.measured <= limit() && mostActive(coarse) > 0) {
        reference_ = std::move(fine);
        return;
      }
      if (mostActive(coarse) == 0 && mostActive(fine) == 0 && ++emptyBakes_ > kMostEmptyBakes) {
        reference_ = std::move(fine);  // as empty as can be seen
        return;
      }
      coarser_ = size_;
      size_ *= 0.5;
      coarse = std::move(fine);
    }
  }

  [[noreturn]] void refuse() const {
    const double reached = choice_.trials.empty() ? 1.0 : choice_.trials.back().error;
    throw InputError(asset_.where, "asset '" + asset_.name + "': a tolerance of " + percent(choice_.asked) +
                                       " needs voxels below " + shown(coarser_) + " (there " +
                                       percent(reached) + " was measured), and a reference of more than " +
                                       shown(kMostVoxels) +
                                       " voxels; give 'voxel_size', or a tolerance that is less strict");
  }

  /// Between the size that holds and twice that, which does not.
  void bisect() {
    double fails = coarser_;
    for (int n = 0; n < kBisections && fails > 0.0; ++n) {
      const double middle = std::sqrt(size_ * fails);
      const Asset look = lookOf(asset_, middle, Precision::single, kAllOctaves);
      Frames reference = bakeAt(0.5 * middle);
      const double error = measure(look, bakeAll(look), reference);
      if (error > limit()) {
        fails = middle;
        continue;
      }
      size_ = middle;
      choice_.measured = error;
      reference_ = std::move(reference);
    }
  }

  /// Takes `look` in place of what was chosen where the tolerance still holds.
  bool take(const Asset& look) {
    const double error = measure(look, bakeAll(look), reference_);
    if (error > limit()) return false;
    choice_.asset = look;
    choice_.measured = error;
    return true;
  }

  void takeHalf() {
    try {
      if (take(lookOf(asset_, size_, Precision::half, kAllOctaves))) return;
      choice_.leftOut.push_back("half precision is not within the tolerance");
    } catch (const InputError&) {
      choice_.leftOut.push_back("half precision cannot hold the densities");
    }
    if (asset_.precisionGiven)
      throw InputError(asset_.where, "asset '" + asset_.name + "': " + choice_.leftOut.back() +
                                         "; ask for 'precision: float'");
  }

  void takeFewerOctaves() {
    for (int most = largestOctaves(asset_) - 1; most >= 1; --most)
      if (!take(lookOf(asset_, size_, choice_.asset.precision, most))) return;
  }

  /// Until rays that had no part in the search hold too: octaves back first, then finer voxels.
  void confirm() {
    for (;;) {
      const double error = errorOf(reference_, bakeAll(choice_.asset), kConfirmingRays, kConfirmingSeed);
      choice_.measured = error;
      if (error <= limit() || mostActive(reference_) == 0) return;
      if (choice_.asset.mostOctaves != kAllOctaves) {
        const int more = choice_.asset.mostOctaves + 1;
        choice_.asset.mostOctaves = more < largestOctaves(asset_) ? more : kAllOctaves;
        continue;
      }
      if (double(mostActive(reference_)) / (kFiner * kFiner * kFiner) > kMostVoxels) refuse();
      coarser_ = size_;
      size_ *= kFiner;
      choice_.asset.voxelSize = size_;
      reference_ = bakeAt(0.5 * size_);
    }
  }

  void tellWhatIsLeftOut() {
    const int asked = largestOctaves(asset_);
    if (choice_.asset.mostOctaves < asked)
      choice_.leftOut.push_back("octaves beyond " + std::to_string(choice_.asset.mostOctaves) + " of " +
                                std::to_string(asked));
    if (coarser_ == 0.0) choice_.leftOut.push_back("voxels larger than " + shown(size_) + " were not tried");
    if (frames_.size() > 1)
      choice_.leftOut.push_back("frames other than first, middle and last were not measured");
  }

  static constexpr int kMostEmptyBakes = 4;

  const Asset& asset_;
  const std::vector<std::optional<int>> frames_;
  const TrialBaker baker_;
  Choice choice_;
  double size_ = 0.0;     // the coarsest that holds so far
  double coarser_ = 0.0;  // twice that, where it was measured and does not hold
  int emptyBakes_ = 0;
  Frames reference_;  // of size_
};

}  // namespace

Choice chooseFor(const Pipeline& pipeline, const Asset& asset, const std::string& outFolder) {
  return Search(pipeline, asset, outFolder).run();
}

std::string choiceAsText(const Choice& choice) {
  const Asset& asset = choice.asset;
  std::string text = "tolerance " + percent(choice.asked) + ": voxel_size " + shown(asset.voxelSize) + ", " +
                     (asset.precision == Precision::half ? "half" : "float");
  if (asset.mostOctaves != kAllOctaves) text += ", at most " + std::to_string(asset.mostOctaves) + " octaves";
  text += "; measured " + percent(choice.measured) + " of the largest optical depth along " +
          std::to_string(choice.rays) + " rays against half the voxel size";
  for (size_t n = 0; n < choice.leftOut.size(); ++n)
    text += (n == 0 ? "; left out: " : ", ") + choice.leftOut[n];
  return text;
}

double depthError(const Pipeline& pipeline, const Asset& reference, const Asset& look, uint64_t rays,
                  uint64_t seed, const std::string& outFolder) {
  const TrialBaker baker(pipeline, look, sampledFrames(look), outFolder);
  Frames fine, coarse;
  for (size_t n = 0; n < baker.frameCount(); ++n) {
    fine.push_back(baker.bake(n, reference));
    coarse.push_back(baker.bake(n, look));
  }
  return errorOf(fine, coarse, rays, seed);
}

}  // namespace nephele
