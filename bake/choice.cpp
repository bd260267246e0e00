// The search behind a tolerance. Depends on choice.h, trial.h, base, volume/chords.h.
#include "bake/choice.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

#include "bake/trial.h"
#include "base/density_step.h"
#include "base/figures.h"
#include "volume/chords.h"

namespace nephele {
namespace {

// The first look has this many voxels along the longest side, and this many along the shortest, so that a
// thin sheet is seen at all.
constexpr double kFirstAlongLongest = 16.0, kFirstAlongShortest = 2.0;
// Each bisection divides the ratio of two sizes by its square root: three leave 2^(1/8), 30% of the voxels.
constexpr int kBisections = 3;
// Of more active voxels nothing is chosen: they take 10 GB in memory.
constexpr double kMostVoxels = 2e9;
// Leaves of particles are held to be measured; a reference of more active voxels takes 3 GB with its bricks.
constexpr double kMostBaked = 2.5e8;
// A reference has as many times the voxels.
constexpr double kEightTimes = 8.0;
constexpr uint64_t kSearchSeed = 0, kConfirmingSeed = 0x636f6e66;
// What confirming makes of voxels that do not hold: 2^(-1/8), one such step.
constexpr double kFiner = 0.9170040432046712;

std::string shown(double value) { return number(value, 4); }

Asset lookOf(const Asset& asset, double voxelSize, Precision precision, int octaves) {
  Asset look = asset;
  look.voxelSize = voxelSize;
  look.precision = precision;
  look.mostOctaves = octaves;
  look.densityStep = 0.0;
  return look;
}

/// What all frames' rays see of one look.
struct Seen {
  std::vector<std::vector<double>> depths;  // by frame
  double voxels = 0.0;                      // of the frame that has most
  double maximum = 0.0;                     // of all frames' densities

  bool nothing() const {
    for (const std::vector<double>& frame : depths)
      for (const double depth : frame)
        if (depth > 0.0) return false;
    return true;
  }
};

/// The largest difference over the largest depth of the reference, both over all frames: a sequence is seen
/// under one light, whatever its first frame holds. More rays than kChoiceRays are judged by as many at a
/// time, since the deepest of many is deeper: the worst of these.
double errorOf(const Seen& reference, const Seen& look) {
  size_t most = 0;
  for (const std::vector<double>& frame : look.depths) most = std::max(most, frame.size());
  double error = 0.0;
  for (size_t first = 0; first < most; first += kChoiceRays) {
    DepthDifference worst;
    for (size_t n = 0; n < look.depths.size(); ++n) {
      const std::span<const double> a(reference.depths[n]), b(look.depths[n]);
      const size_t from = std::min(first, a.size()), count = std::min(size_t(kChoiceRays), a.size() - from);
      const DepthDifference d = differenceOf(a.subspan(from, count), b.subspan(from, count));
      worst.largest = std::max(worst.largest, d.largest);
      worst.largestA = std::max(worst.largestA, d.largestA);
    }
    error = std::max(error, worst.relative());
  }
  return error;
}

/// The same rays for every look of an asset.
class Rays {
 public:
  Rays(const TrialBaker& baker, uint64_t count, uint64_t seed) : baker_(&baker) {
    for (size_t n = 0; n < baker.frameCount(); ++n) chords_.push_back(baker.chords(n, count, seed));
  }

  /// The rays in groups of at most `count`.
  std::vector<Rays> groups(uint64_t count) const {
    std::vector<Rays> all;
    uint64_t most = 0;
    for (const Chords& frame : chords_) most = std::max(most, uint64_t(frame.lines.size()));
    for (uint64_t first = 0; first < most; first += count) {
      Rays group(*this);
      for (Chords& frame : group.chords_) {
        const auto begin = frame.lines.begin(), end = frame.lines.end();
        const auto from = begin + std::min(std::ptrdiff_t(first), end - begin),
                   to = begin + std::min(std::ptrdiff_t(first + count), end - begin);
        frame.lines = std::vector<Chord>(from, to);
      }
      all.push_back(std::move(group));
    }
    return all;
  }

  Seen see(const Asset& look) const {
    Seen seen;
    for (size_t n = 0; n < chords_.size(); ++n) {
      TrialBaker::Depths found = baker_->depths(n, look, chords_[n]);
      seen.depths.push_back(std::move(found.depths));
      seen.voxels = std::max(seen.voxels, found.voxels);
      seen.maximum = std::max(seen.maximum, found.maximum);
    }
    return seen;
  }

 private:
  const TrialBaker* baker_;
  std::vector<Chords> chords_;
};

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
    size_ = firstSize();
    // What rays see of particles costs less than what they weigh, which no number of rays changes: the search
    // then sees all rays at once.
    rays_.emplace(baker_, asset_.particles ? kConfirmingRays : kChoiceRays, kSearchSeed);
    descend();
    bisect();
    choice_.asset = wholeLook(size_);
    if (!(asset_.precisionGiven && asset_.precision == Precision::single)) takeHalf();
    takeFewerOctaves();
    const std::vector<Rays> groups = confirmingRays();
    std::vector<Seen> references;
    if (asset_.particles)
      references.push_back(std::move(reference_));
    else
      confirm(groups, references);
    if (!asset_.densityStepGiven) takeStep(groups, references);
    tellWhatIsLeftOut();
    choice_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(choice_);
  }

 private:
  double limit() const { return kChoiceShare * choice_.asked; }

  Asset wholeLook(double size) const { return lookOf(asset_, size, Precision::single, kAllOctaves); }

  /// Holds a look against a reference, and writes that down.
  double measure(const Asset& look, const Seen& seen, const Seen& reference) {
    const double error = errorOf(reference, seen);
    note(look, error, seen.voxels);
    return error;
  }

  void note(const Asset& look, double error, double voxels) {
    choice_.trials.push_back(
        {look.voxelSize, look.precision, look.mostOctaves, look.densityStep, error, voxels});
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

  bool tooMany(double voxels) const {
    return asset_.particles ? kEightTimes * voxels > kMostBaked : voxels > kMostVoxels;
  }

  /// Halves the voxels until the tolerance holds.
  void descend() {
    Seen coarse = rays_->see(wholeLook(size_));
    coarser_ = 0.0;
    for (;;) {
      if (tooMany(coarse.voxels)) refuse();
      Seen fine = rays_->see(wholeLook(0.5 * size_));
      choice_.measured = measure(wholeLook(size_), coarse, fine);
      const bool asEmptyAsCanBeSeen = coarse.nothing() && fine.nothing() && ++emptyLooks_ > kMostEmptyLooks;
      if ((choice_.measured <= limit() && !coarse.nothing()) || asEmptyAsCanBeSeen) {
        reference_ = std::move(fine);
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
                                       percent(reached) + " was measured): " +
                                       (asset_.particles ? "a reference of more than " + shown(kMostBaked)
                                                         : "more than " + shown(kMostVoxels)) +
                                       " voxels; give 'voxel_size', or a tolerance that is less strict");
  }

  /// Between the size that holds and twice that, which does not.
  void bisect() {
    double fails = coarser_;
    for (int n = 0; n < kBisections && fails > 0.0; ++n) {
      const double middle = std::sqrt(size_ * fails);
      Seen reference = rays_->see(wholeLook(0.5 * middle));
      const double error = measure(wholeLook(middle), rays_->see(wholeLook(middle)), reference);
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
    const double error = measure(look, rays_->see(look), reference_);
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

  /// Rays that had no part in the search; for particles, which are seen by so many from the start, the same.
  std::vector<Rays> confirmingRays() const {
    if (asset_.particles) return {*rays_};
    return Rays(baker_, kConfirmingRays, kConfirmingSeed).groups(kChoiceRays);
  }

  /// Until those rays hold too: octaves back first, then finer voxels.
  void confirm(const std::vector<Rays>& groups, std::vector<Seen>& references) {
    while (!reference_.nothing() && !holdsAlong(groups, choice_.asset, references)) {
      if (choice_.asset.mostOctaves != kAllOctaves) {
        const int more = choice_.asset.mostOctaves + 1;
        choice_.asset.mostOctaves = more < largestOctaves(asset_) ? more : kAllOctaves;
        continue;
      }
      coarser_ = size_;
      size_ *= kFiner;
      choice_.asset.voxelSize = size_;
      references.clear();
    }
  }

  /// Whether all rays hold a look; `references` are what the first groups see of the reference, and grow.
  /// What is too wrong for one group is not shown to the next.
  bool holdsAlong(const std::vector<Rays>& groups, const Asset& look, std::vector<Seen>& references) {
    double worst = 0.0, voxels = 0.0;
    for (size_t n = 0; n < groups.size() && worst <= limit(); ++n) {
      if (n == references.size()) references.push_back(groups[n].see(wholeLook(0.5 * size_)));
      const Seen seen = groups[n].see(look);
      if (tooMany(seen.voxels)) refuse();
      worst = std::max(worst, errorOf(references[n], seen));
      voxels = std::max(voxels, seen.voxels);
    }
    note(look, worst, voxels);
    if (worst <= limit()) choice_.measured = worst;
    return worst <= limit();
  }

  /// From the coarsest step on to the first that holds; none where none does.
  void takeStep(const std::vector<Rays>& groups, std::vector<Seen>& references) {
    double largest = 0.0;
    for (const Seen& reference : references) largest = std::max(largest, reference.maximum);
    if (largest == 0.0) return;
    const double finest = densityStepFor(largest, kMostLevels);
    Asset look = choice_.asset;
    for (look.densityStep = densityStepFor(largest, kFewestLevels); look.densityStep >= finest;
         look.densityStep *= 0.5)
      if (holdsAlong(groups, look, references)) {
        choice_.asset = look;
        return;
      }
    choice_.leftOut.push_back("no step of densities is within the tolerance");
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

  static constexpr int kMostEmptyLooks = 4;

  const Asset& asset_;
  const std::vector<std::optional<int>> frames_;
  const TrialBaker baker_;
  Choice choice_;
  double size_ = 0.0;     // the coarsest that holds so far
  double coarser_ = 0.0;  // twice that, where it was measured and does not hold
  int emptyLooks_ = 0;
  std::optional<Rays> rays_;  // of the search
  Seen reference_;            // of size_
};

}  // namespace

Asset finerThan(const Asset& look) {
  return lookOf(look, 0.5 * look.voxelSize, Precision::single, kAllOctaves);
}

Choice chooseFor(const Pipeline& pipeline, const Asset& asset, const std::string& outFolder) {
  return Search(pipeline, asset, outFolder).run();
}

std::string choiceAsText(const Choice& choice) {
  const Asset& asset = choice.asset;
  std::string text = "tolerance " + percent(choice.asked) + ": voxel_size " + shown(asset.voxelSize) + ", " +
                     (asset.precision == Precision::half ? "half" : "float");
  if (asset.mostOctaves != kAllOctaves) text += ", at most " + std::to_string(asset.mostOctaves) + " octaves";
  if (asset.densityStep > 0.0) text += ", density_step " + number(asset.densityStep);
  text += "; measured " + percent(choice.measured) + " of the largest optical depth along " +
          std::to_string(choice.rays) + " rays against half the voxel size";
  for (size_t n = 0; n < choice.leftOut.size(); ++n)
    text += (n == 0 ? "; left out: " : ", ") + choice.leftOut[n];
  return text;
}

double depthError(const Pipeline& pipeline, const Asset& reference, const Asset& look, uint64_t rays,
                  uint64_t seed, const std::string& outFolder) {
  const TrialBaker baker(pipeline, look, sampledFrames(look), outFolder);
  const Rays chords(baker, rays, seed);
  return errorOf(chords.see(reference), chords.see(look));
}

}  // namespace nephele
