// Choosing settings by measured error. Depends on what its header names.
#include "preview/measure/error_request.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "base/error.h"
#include "scene/light_model.h"

namespace nephele {
namespace {

constexpr const char *kMarch = "march", *kTruth = "reference";
// Apart from the seeds of the settings that are measured, and from each other.
constexpr unsigned kChoosingSeed = 0x43686f6fu, kMeasuringSeed = 0x4d656173u;

/// So large that about kPixels are left, and small enough to leave one.
int strideFor(const PictureRequest& whole) {
  constexpr double kPixels = 8000.0;
  const double pixels = static_cast<double>(whole.width) * whole.height;
  const int stride = static_cast<int>(std::lround(std::sqrt(pixels / kPixels)));
  return std::clamp(stride, 1, std::min(whole.width, whole.height));
}

/// The pixels of a whole picture that a sparse one has.
Picture everyStride(const Picture& whole, int stride) {
  Picture sparse;
  sparse.width = strided(whole.width, stride);
  sparse.height = strided(whole.height, stride);
  for (size_t plane = 0; plane < whole.names.size(); ++plane) {
    sparse.add(whole.names[plane]);
    size_t to = 0;
    for (int y = stride / 2; y < whole.height; y += stride)
      for (int x = stride / 2; x < whole.width; x += stride)
        sparse.planes[plane][to++] =
            whole.planes[plane]
                        [static_cast<size_t>(y) * static_cast<size_t>(whole.width) + static_cast<size_t>(x)];
  }
  return sparse;
}

double pixelsOf(const PictureRequest& request, int stride) {
  return static_cast<double>(strided(request.width, stride)) * strided(request.height, stride);
}

PictureRequest sparseRequest(const ViewedScene& view, const PictureRequest& whole) {
  PictureRequest sparse = whole;
  sparse.stride = strideFor(whole);
  sparse.quiet = true;
  sparse.bounces = bouncesOfTruth(view, whole.bounces);
  return sparse;
}

/// What a unit of the march's work counts for beside truth's, which the processor does.
double unitOn(const std::string& renderer) {
  // A graphics processor is taken to read densities 100 times as fast as llvmpipe does. Which one it is does
  // not count: the order of picks must not depend on the clock.
  constexpr double kHardware = 0.01;
  constexpr std::string_view kSoftware[] = {"llvmpipe", "softpipe", "swrast"};
  const bool software =
      renderer.empty() || std::any_of(std::begin(kSoftware), std::end(kSoftware),
                                      [&](auto name) { return renderer.find(name) != std::string::npos; });
  return software ? 1.0 : kHardware;
}

PictureRequest withSeed(PictureRequest request, unsigned seed) {
  request.seed ^= seed;
  return request;
}

}  // namespace

std::optional<int> bouncesOfTruth(const ViewedScene& view, std::optional<int> given) {
  if (given) return given;
  if (lightModelOf(view.scene, view.medium).octaveCount == 0) return 0;
  return {};
}

void requireTruth(const ViewedScene& view) {
  if (view.scene.look == Look::report)
    throw InputError({}, "--error needs a truth, and the report look has none: it is a picture by design",
                     "give a scene with look: physical by --scene");
}

std::vector<MarchCandidate> marchCandidates(const Scene& scene) {
  std::vector<MarchCandidate> candidates;
  const auto add = [&](double step, unsigned least, unsigned most) -> MarchSettings& {
    // Coarse steps may read coarse levels; beside fine ones levels are the larger error.
    constexpr double kCoarseStep = 2.0;
    Setting setting;
    setting.method = kMarch;
    setting.march = scene.march;
    setting.march.stepVoxels = step;
    setting.march.adaptive = true;
    setting.march.lightCache = false;
    setting.march.cacheDepth = std::numeric_limits<double>::max();
    setting.march.stepPixels = 0.0;  // steps are as long as they say
    if (step < kCoarseStep) setting.march.levelPixels = 0.0;
    return candidates.emplace_back(MarchCandidate{setting, least, most}).setting.march;
  };
  struct Cached {
    double step, n;  // the cache's cells are kCells/n voxels: each another, so that each is prepared anew
    unsigned least, most;
  };
  constexpr double kCells = 16.0;
  for (const Cached& c :
       {Cached{4.0, 3.0, 1, 16}, {2.0, 4.0, 1, 32}, {1.0, 5.0, 2, 64}, {0.5, 8.0, 4, 256}}) {
    MarchSettings& march = add(c.step, c.least, c.most);
    march.lightCache = true;
    march.cacheVoxels = kCells / c.n;
  }
  struct Marched {
    double step, shadow, growth;
    unsigned least, most;
  };
  for (const Marched& m : {Marched{2.0, 2.0, 1.2, 1, 32}, Marched{1.0, 1.0, 1.15, 1, 256},
                           Marched{0.5, 0.5, 1.1, 16, 256}, Marched{0.25, 0.5, 1.05, 64, 256}}) {
    MarchSettings& march = add(m.step, m.least, m.most);
    march.shadowStepVoxels = m.shadow;
    march.shadowGrowth = m.growth;
  }
  return candidates;
}

double workOf(const Setting& setting, double densitiesPreparing, double densities, double rays) {
  // Of the processor's time on llvmpipe: a density beside the cache takes half as long again, and a ray as
  // long as 30 densities. Between clouds and steps that tells time within a fifth.
  constexpr double kWithCache = 1.5, kRay = 30.0;
  return densitiesPreparing + (setting.march.lightCache ? kWithCache : 1.0) * densities + kRay * rays;
}

ErrorSearch::ErrorSearch(Method& march, Method& truth, const ViewedScene& view, const PictureRequest& whole)
    : march_(march),
      view_(view),
      sparse_(sparseRequest(view, whole)),
      share_(pixelsOf(whole, 1) / pixelsOf(whole, sparse_.stride)),
      unit_(unitOn(march.renderer)),
      choosing_(truth, view, withSeed(sparse_, kChoosingSeed)),
      measuring_(truth, view, withSeed(sparse_, kMeasuringSeed)) {
  const std::vector<MarchCandidate> candidates = marchCandidates(view.scene);
  // Drivers finish programs when they first draw. The cache is left with another cell than the first one's.
  for (const bool cached : {false, true})
    for (auto last = candidates.rbegin(); last != candidates.rend(); ++last)
      if (last->setting.march.lightCache == cached) {
        PictureCost cost;
        renderSparse(last->setting, cost);
        break;
      }
  Spent spent;
  for (size_t i = 0; i < candidates.size(); ++i) addRungs(candidates[i], i, spent);
  std::stable_sort(rungs_.begin(), rungs_.end(),
                   [](const ErrorRung& a, const ErrorRung& b) { return a.work < b.work; });
  tellTimes(spent);
}

void ErrorSearch::addRungs(const MarchCandidate& candidate, size_t index, Spent& spent) {
  PictureCost cost;
  Picture picture = renderSparse(candidate.setting, cost);
  const double pixels = pixelsOf(sparse_, sparse_.stride);
  const double preparing = workOf(candidate.setting, cost.densitiesPreparing, 0.0, 0.0);
  const double each =
      workOf(candidate.setting, 0.0, cost.densitySamplesPerPixel * pixels - cost.densitiesPreparing, pixels);
  spent.millisecondsPreparing += cost.millisecondsPreparing;
  spent.workPreparing += preparing;
  spent.milliseconds += cost.milliseconds - cost.millisecondsPreparing;
  spent.work += each;
  for (unsigned samples = candidate.least; samples <= candidate.most; samples *= 2) {
    ErrorRung rung;
    rung.setting = candidate.setting;
    rung.setting.samples = samples;
    rung.setting.name = nameOf(rung.setting);
    rung.candidate = index;
    rung.preparing = preparing;
    rung.work = preparing + share_ * samples * each;
    if (samples == 1) rung.picture = std::move(picture);
    rungs_.push_back(std::move(rung));
  }
}

void ErrorSearch::tellTimes(const Spent& spent) {
  double rate = spent.milliseconds / spent.work;
  const double ratePreparing =
      spent.workPreparing > 0.0 ? spent.millisecondsPreparing / spent.workPreparing : 0.0;
  if (sparse_.stride > 1) {
    // Small pictures may not keep a machine busy: a whole one of one sample does.
    const ErrorRung& first = rungs_.front();
    PictureRequest whole = sparse_;
    whole.stride = 1;
    whole.samples = first.setting.samples;
    PictureCost cost;
    march_.render(withSetting(view_, first.setting), whole, cost);
    rate = (cost.milliseconds - cost.millisecondsPreparing) / (first.work - first.preparing);
  }
  for (ErrorRung& rung : rungs_)
    rung.milliseconds = ratePreparing * rung.preparing + rate * (rung.work - rung.preparing);
}

Picture ErrorSearch::renderSparse(const Setting& setting, PictureCost& cost) {
  PictureRequest request = sparse_;
  request.samples = setting.samples;
  return march_.render(withSetting(view_, setting), request, cost);
}

bool ErrorSearch::passes(ErrorRung& rung, double error) {
  if (rung.picture.names.empty()) {
    PictureCost cost;
    rung.picture = renderSparse(rung.setting, cost);
  }
  for (size_t step = 0; step <= TruthLadder::stepFor(error); ++step) {
    if (rung.errors.size() <= step) rung.errors.push_back(choosing_.compared(rung.picture, step));
    if (rung.errors[step].high > TruthLadder::allowed(error, step)) return false;
  }
  return true;
}

ErrorPick ErrorSearch::pick(double error, size_t from) {
  // Where twice the samples brought less than this share, what is left is no noise. It goes by the noisiest
  // truth and by all samples before, whatever is asked.
  constexpr double kStill = 0.93;
  std::map<size_t, double> reached;  // by candidate: with the most samples so far
  std::set<size_t> still;
  const double truthWork = share_ * choosing_.workFor(error);
  for (size_t i = 0; i < rungs_.size(); ++i) {
    ErrorRung& rung = rungs_[i];
    if (still.contains(rung.candidate)) continue;
    if (rung.work * unit_ >= truthWork) break;  // and so do all after it
    const bool good = passes(rung, error);
    if (good && i >= from)
      return {rung.setting, rung.errors.back().high, rung.milliseconds, unit_ * rung.work, i};
    const double found = rung.errors.front().relativeRmse;
    const auto [before, first] = reached.try_emplace(rung.candidate, found);
    if (!first && found > kStill * before->second) still.insert(rung.candidate);
    before->second = found;
  }
  ErrorPick truth;
  truth.setting.method = truth.setting.name = kTruth;
  truth.error = error;
  truth.milliseconds = share_ * choosing_.millisecondsFor(error);
  truth.work = truthWork;
  return truth;
}

ErrorSearch::Verdict ErrorSearch::measure(const Picture& picture, double error) {
  const Picture sparse = everyStride(picture, sparse_.stride);
  Verdict verdict;
  for (size_t step = 0; step <= TruthLadder::stepFor(error); ++step) {
    verdict.error = measuring_.compared(sparse, step);
    verdict.kept = verdict.error.relativeRmse <= TruthLadder::allowed(error, step);
    if (!verdict.kept) break;
  }
  return verdict;
}

size_t ErrorSearch::measuredRungs() const {
  return static_cast<size_t>(std::count_if(
      rungs_.begin(), rungs_.end(), [](const ErrorRung& rung) { return !rung.picture.names.empty(); }));
}

}  // namespace nephele
