// Fitting factors. Depends on what its header names.
#include "preview/measure/fit_octaves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "base/error.h"
#include "base/progress.h"
#include "preview/measure/fit_stations.h"
#include "preview/measure/least_point.h"
#include "preview/measure/truth_ladder.h"

namespace nephele {
namespace {

constexpr unsigned kTruthSeed = 0x4669u;

void setFactors(ViewedScene& view, const OctaveFactors& factors, int count) {
  view.scene.octaves.count = count;
  view.scene.octaves.a = factors[0];
  view.scene.octaves.b = factors[1];
  view.scene.octaves.c = factors[2];
  view.scene.octaves.d = factors[kOpenness];
}

/// The fit at work.
class Fit {
 public:
  Fit(Method& march, Method& truth, std::vector<FitSubject> subjects, const FitOptions& options)
      : march_(march), truth_(truth), subjects_(std::move(subjects)), options_(options) {}

  void addViews(size_t checksFrom) {
    Progress progress("tracing truth", subjects_.size() * fitStations().size(), options_.quiet);
    for (size_t s = 0; s < subjects_.size(); ++s) {
      truth_.setVolume(*subjects_[s].bricks);
      for (const FitStation& station : fitStations()) {
        FitView view{s,
                     subjects_[s].name,
                     station.fitted && s < checksFrom,
                     station.sunUp,
                     viewFrom(subjects_[s].view, station),
                     {},
                     {},
                     {},
                     std::nullopt};
        view.name += " camera " + std::to_string(static_cast<int>(station.camera)) + ", sun " +
                     std::to_string(static_cast<int>(station.sun)) + "/" +
                     std::to_string(static_cast<int>(station.sunUp));
        PictureRequest request = requestOf();
        request.error = options_.truthError;
        request.mostSamples = kMostTruthSamples;
        request.seed = kTruthSeed;
        PictureCost cost;
        view.truth = truth_.render(view.view, request, cost);
        if (isDark(view.truth))
          throw InputError({view.name}, "scatters no light, so there is nothing to fit to");
        views.push_back(std::move(view));
        progress.advance();
      }
    }
  }

  NoisyError errorOf(FitView& view, const OctaveFactors& factors, int count) {
    take(view.subject);
    setFactors(view.view, factors, count);
    PictureCost cost;
    return compareWithHalves(march_.render(view.view, requestOf(), cost), view.truth);
  }

  /// The squared errors of each view of the subjects before `checksFrom`, for any factors.
  std::vector<OctaveForm> forms(size_t checksFrom) {
    Progress progress("orders", checksFrom * fitStations().size(), options_.quiet);
    std::vector<OctaveForm> each;
    for (const FitView& view : views) {
      if (view.subject >= checksFrom) break;  // they come last
      take(view.subject);
      each.push_back(OctaveForm::of(march_, view.view, requestOf(), view.truth));
      progress.advance();
    }
    return each;
  }

  std::vector<FitView> views;

 private:
  PictureRequest requestOf() const {
    PictureRequest request;
    request.width = options_.width;
    request.height = options_.height;
    request.samples = options_.samples;
    request.quiet = true;
    return request;
  }
  void take(size_t subject) {
    if (loaded_ != subject) march_.setVolume(*subjects_[subject].bricks);
    loaded_ = subject;
  }
  static bool isDark(const Picture& picture) {
    return std::all_of(picture.planes[0].begin(), picture.planes[0].end(),
                       [](float value) { return value <= 0.0f; });
  }

  Method &march_, &truth_;
  std::vector<FitSubject> subjects_;
  const FitOptions& options_;
  size_t loaded_ = std::numeric_limits<size_t>::max();
};

/// Sums over the views that are fitted to: of all suns, and of those at each of kFittedElevations.
struct FittedForms {
  OctaveForm all;
  std::array<OctaveForm, kFittedElevations.size()> at;
  std::array<double, kFittedElevations.size()> views{};
};

FittedForms sumOf(const std::vector<FitView>& views, const std::vector<OctaveForm>& forms) {
  FittedForms sum;
  for (size_t i = 0; i < forms.size(); ++i) {
    if (!views[i].fitted) continue;
    sum.all.add(forms[i]);
    const size_t node = static_cast<size_t>(
        std::find(kFittedElevations.begin(), kFittedElevations.end(), views[i].elevation) -
        kFittedElevations.begin());
    NEPHELE_CHECK_EQ(node < kFittedElevations.size(), true);
    sum.at[node].add(forms[i]);
    sum.views[node] += 1.0;
  }
  return sum;
}

constexpr double kTolerance = 1e-3;
constexpr size_t kMostTries = 400;

OctaveFactors leastFactors(const std::function<double(const OctaveFactors&)>& cost) {
  constexpr int kSide = 5;
  return leastOfCube(cost, kSide, kTolerance, kMostTries);
}

struct Fitted {
  SunFactors factors;
  int count;
  double square = 0.0;  // the sum over the views
};

Fitted fittedTo(const FittedForms& forms, int count) {
  // Valleys are long and flat: so that factors between two heights are good ones too, those of each height
  // keep near those of all. An apartness of 1 counts as a squared error of kTie.
  constexpr double kTie = 0.03;
  const OctaveFactors all =
      leastFactors([&](const OctaveFactors& factors) { return forms.all.at(factors, count); });
  Fitted fitted{{}, count, 0.0};
  for (size_t node = 0; node < fitted.factors.size(); ++node) {
    const auto cost = [&](const OctaveFactors& factors) {
      double apart = 0.0;
      for (size_t i = 0; i < all.size(); ++i) apart += (factors[i] - all[i]) * (factors[i] - all[i]);
      return forms.at[node].at(factors, count) + kTie * forms.views[node] * apart;
    };
    fitted.factors[node] = leastOf(cost, all, kTolerance, kMostTries);
    fitted.square += forms.at[node].at(fitted.factors[node], count);
  }
  return fitted;
}

/// The fewest octaves whose error is within a share of the least.
Fitted fewestFittedTo(const FittedForms& forms) {
  constexpr double kNearly = 1.03;
  std::vector<Fitted> all;
  double least = std::numeric_limits<double>::infinity();
  for (int count = 1; count <= kMostOctaveCount; ++count) {
    all.push_back(fittedTo(forms, count));
    least = std::min(least, all.back().square);
  }
  return *std::find_if(all.begin(), all.end(),
                       [&](const Fitted& f) { return f.square <= kNearly * kNearly * std::max(least, 0.0); });
}

double bestOf(const OctaveForm& form, int count) {
  const auto cost = [&](const OctaveFactors& factors) { return form.at(factors, count); };
  return std::sqrt(std::max(cost(leastFactors(cost)), 0.0));
}

std::optional<double> errorAt(const FitView& view, FitStage stage) {
  if (stage == FitStage::atBest) return view.atBest;
  return (stage == FitStage::after ? view.after : view.before).relativeRmse;
}

}  // namespace

double errorOver(const std::vector<FitView>& views, bool fitted, FitStage stage) {
  double sum = 0.0, count = 0.0;
  for (const FitView& view : views) {
    const std::optional<double> error = errorAt(view, stage);
    if (view.fitted != fitted || !error) continue;
    sum += *error * *error;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

bool worsensHeldBack(const std::vector<FitView>& views) {
  return errorOver(views, false, FitStage::after) > errorOver(views, false, FitStage::before);
}

FitResult fitOctaves(Method& march, Method& truth, const std::vector<FitSubject>& subjects,
                     const std::vector<FitSubject>& checks, const FitOptions& options) {
  std::vector<FitSubject> all = subjects;
  all.insert(all.end(), checks.begin(), checks.end());
  Fit fit(march, truth, std::move(all), options);
  fit.addViews(subjects.size());
  const std::vector<OctaveForm> forms = fit.forms(subjects.size());
  const FittedForms sum = sumOf(fit.views, forms);
  const Fitted fitted = options.count ? fittedTo(sum, *options.count) : fewestFittedTo(sum);
  FitResult result;
  result.factors = fitted.factors;
  result.count = fitted.count;
  for (size_t i = 0; i < fit.views.size(); ++i) {
    FitView& view = fit.views[i];
    view.before = fit.errorOf(view, kUnfittedFactors, result.count);
    view.after = fit.errorOf(view, factorsAt(result.factors, view.elevation), result.count);
    if (i < forms.size()) view.atBest = bestOf(forms[i], result.count);
  }
  result.views = std::move(fit.views);
  return result;
}

}  // namespace nephele
