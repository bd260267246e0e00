// Running the table. Depends on what its header names.
#include "preview/measure/stability.h"

#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "base/error.h"
#include "base/progress.h"

namespace nephele {
namespace {

constexpr const char *kTruth = "reference", *kMarch = "march";
constexpr unsigned kTruthSeed = 0x5374u;

/// The methods' objects, one of each row.
class Makers {
 public:
  Method& at(const MethodRow& row) {
    std::unique_ptr<Method>& method = made_[std::string(row.name)];
    if (!method) method = row.make({});
    return *method;
  }

 private:
  std::map<std::string, std::unique_ptr<Method>> made_;
};

PictureRequest requestOf(const StabilityOptions& options, const StabilityWay& way) {
  PictureRequest request;
  request.width = request.height = options.size;
  request.samples = options.samples;
  request.quiet = true;
  if (way.row.name == kTruth) request.bounces = 0;
  return request;
}

ViewedScene viewFor(const StabilityWay& way, const StabilityCase& on) {
  ViewedScene view = on.view;
  // Steps are as long as the case says, and read what it holds.
  view.scene.march.stepPixels = view.scene.march.levelPixels = 0.0;
  if (way.lightCache) {
    view.scene.march.lightCache = *way.lightCache;
    view.scene.march.cacheDepth = std::numeric_limits<double>::max();
  }
  return view;
}

Picture truthOf(Method& truth, const StabilityCase& on, const StabilityOptions& options) {
  PictureRequest request;
  request.width = request.height = options.size;
  request.bounces = 0;
  request.samples = options.truthSamples;
  request.seed = kTruthSeed;
  request.quiet = true;
  PictureCost cost;
  return truth.render(on.view, request, cost);
}

bool isDark(const Picture& picture) {
  for (size_t plane = 0; plane < 3; ++plane)
    for (const float value : picture.planes[plane])
      if (value > 0.0f) return false;
  return true;
}

StabilityCell cellOf(Method& method, const StabilityWay& way, const StabilityCase& on, const Picture* truth,
                     const StabilityOptions& options) {
  StabilityCell cell;
  cell.axis = on.axis;
  cell.value = on.value;
  try {
    PictureCost cost;
    const Picture picture = method.render(viewFor(way, on), requestOf(options, way), cost);
    cell.bad = badValuesIn(picture);
    // Ratio tracking estimates transmittance without bias, at times above 1.
    if (way.row.name == kTruth) cell.bad.aboveOne = 0;
    if (truth != nullptr && cell.bad.notFinite == 0 && way.row.name != kTruth && !isDark(*truth))
      cell.error = compareWithHalves(picture, *truth);
  } catch (const InputError& refusal) {
    cell.refused = refusal.what();
  }
  return cell;
}

/// Sums (Δx − Δr1)(Δx − Δr2) over pixels and channels, so that truth's noise cancels.
struct ChangeSums {
  double errors = 0.0, changes = 0.0, radiance = 0.0, count = 0.0;

  void add(const Picture& now, const Picture& before, const Picture& truthNow, const Picture& truthBefore) {
    static constexpr const char* kHalves[2][3] = {{"half1.R", "half1.G", "half1.B"},
                                                  {"half2.R", "half2.G", "half2.B"}};
    for (size_t c = 0; c < 3; ++c) {
      const auto half = [c](const Picture& picture, size_t which) -> const std::vector<float>& {
        return picture.planes[static_cast<size_t>(picture.find(kHalves[which][c]))];
      };
      const std::vector<float>&a1 = half(truthNow, 0), &a2 = half(truthNow, 1);
      const std::vector<float>&b1 = half(truthBefore, 0), &b2 = half(truthBefore, 1);
      for (size_t i = 0; i < a1.size(); ++i) {
        const double change = double{now.planes[c][i]} - double{before.planes[c][i]};
        const double one = double{a1[i]} - double{b1[i]}, two = double{a2[i]} - double{b2[i]};
        errors += (change - one) * (change - two);
        changes += one * two;
        radiance += 0.5 * (double{a1[i]} + double{a2[i]});
        count += 1.0;
      }
    }
  }
  double relative(double squares) const {
    return std::sqrt(std::max(squares, 0.0) / count) / (radiance / count);
  }
};

void addFlicker(StabilityResult& result, Makers& makers, const MethodRow& truthRow,
                const StabilityOptions& options, const std::string& motion, StabilityCase (*frameOf)(int)) {
  std::vector<ChangeSums> sums(result.ways.size());
  std::vector<Picture> before(result.ways.size());
  Picture truthBefore;
  Progress progress(motion, static_cast<uint64_t>(options.frames), options.quiet);
  for (int frame = 0; frame < options.frames; ++frame, progress.advance()) {
    const StabilityCase on = frameOf(frame);
    const BrickVolume bricks = on.volume();
    Method& truthMethod = makers.at(truthRow);
    truthMethod.setVolume(bricks);
    const Picture truth = truthOf(truthMethod, on, options);
    for (size_t way = 0; way < result.ways.size(); ++way) {
      Method& method = makers.at(result.ways[way].row);
      method.setVolume(bricks);
      PictureCost cost;
      Picture picture =
          method.render(viewFor(result.ways[way], on), requestOf(options, result.ways[way]), cost);
      if (frame > 0) sums[way].add(picture, before[way], truth, truthBefore);
      before[way] = std::move(picture);
    }
    truthBefore = truth;
  }
  for (size_t way = 0; way < result.ways.size(); ++way)
    result.flicker.push_back(
        {way, motion, sums[way].relative(sums[way].errors), sums[way].relative(sums[way].changes)});
}

}  // namespace

BadValues badValuesIn(const Picture& picture) {
  // Transmittance is a mean of estimates that are each at most 1 for the march, and on the mean for the
  // reference's ratio tracking.
  constexpr float kAboveOne = 1.0f + 1e-3f;
  constexpr size_t kRadiance = 3, kShares = 7;  // R, G, B; then A and transmittance
  BadValues bad;
  for (size_t plane = 0; plane < std::min(kShares, picture.planes.size()); ++plane)
    for (const float value : picture.planes[plane]) {
      if (!std::isfinite(value)) ++bad.notFinite;
      if (value < 0.0f) ++bad.negative;
      if (plane >= kRadiance && value > kAboveOne) ++bad.aboveOne;
    }
  return bad;
}

std::vector<StabilityWay> waysOf(const std::vector<MethodRow>& methods) {
  std::vector<StabilityWay> ways;
  for (const MethodRow& row : methods) {
    if (row.make == nullptr) continue;
    if (row.name == kMarch) {
      ways.push_back({"march, light cached", row, true});
      ways.push_back({"march, light marched", row, false});
    } else {
      ways.push_back({std::string(row.name), row});
    }
  }
  return ways;
}

StabilityResult runStability(const StabilityOptions& options) {
  StabilityResult result;
  result.ways = waysOf(options.methods);
  const MethodRow* truthRow = nullptr;
  for (const MethodRow& row : options.methods)
    if (row.name == kTruth) truthRow = &row;
  NEPHELE_CHECK_EQ(truthRow != nullptr, true);
  const std::vector<StabilityCase> cases = stabilityCases();
  Makers makers;
  std::vector<std::vector<StabilityCell>> byWay(result.ways.size());
  {
    Progress progress("cases", cases.size(), options.quiet);
    for (const StabilityCase& on : cases) {
      const BrickVolume bricks = on.volume();
      std::optional<Picture> truth;
      if (on.hasTruth) {
        Method& method = makers.at(*truthRow);
        method.setVolume(bricks);
        truth = truthOf(method, on, options);
      }
      const SceneFacts facts = sceneFactsOf(brickFactsOf(bricks), bricks, on.view);
      for (size_t way = 0; way < result.ways.size(); ++way) {
        Method& method = makers.at(result.ways[way].row);
        method.setVolume(bricks);
        byWay[way].push_back(cellOf(method, result.ways[way], on, truth ? &*truth : nullptr, options));
        byWay[way].back().way = way;
        byWay[way].back().facts = facts;
      }
      progress.advance();
    }
  }
  for (std::vector<StabilityCell>& cells : byWay)
    result.cells.insert(result.cells.end(), cells.begin(), cells.end());
  if (options.frames < 2) return result;
  addFlicker(result, makers, *truthRow, options, "orbit", orbitFrame);
  addFlicker(result, makers, *truthRow, options, "sequence", sequenceFrame);
  return result;
}

}  // namespace nephele
