// Warnings from the stability map. Depends on what its header names.
#include "preview/measure/trust.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "base/figures.h"
#include "preview/measure/stability_page.h"

namespace nephele {
namespace {

constexpr TrustRow kTable[] = {
#include "preview/measure/stability_table.inc"
};

/// What an axis of the map says of a scene.
struct Rule {
  std::string_view axis, sentence;
  double (*fact)(const SceneFacts&);
  double (*share)(const SceneFacts&);  // of the medium that is so; the map's cases are so throughout
  bool yesOrNo;                        // inside or outside: places of the same side count, the worst of them
  int about;                           // of the rules about one thing the worst one speaks
};

// Somewhat beyond what is trusted: the map is a coarse ball's, and between its places it is guessed.
constexpr double kWarnedError = 1.2 * kTrustedError;

double whole(const SceneFacts&) { return 1.0; }
double sheets(const SceneFacts& f) { return f.sheetShare; }
/// Steps shorter than a voxel do not miss a voxel.
double steppedOver(const SceneFacts& f) { return f.stepVoxels >= 1.0 ? f.sheetShare : 0.0; }
double step(const SceneFacts& f) { return f.stepVoxels; }

enum About { kVoxels, kSteps, kSheets, kGrains, kPeak, kCamera, kLight };

constexpr Rule kRules[] = {
    {"optical depth", "voxels are optically thick", [](const SceneFacts& f) { return f.voxelDepth; }, whole,
     false, kVoxels},
    {"step, voxels", "steps are too long", step, whole, false, kSteps},
    {"sheet of a voxel, optical depth", "sheets as thin as a voxel",
     [](const SceneFacts& f) { return f.sheetDepth; }, sheets, false, kSheets},
    {"sheet of a voxel, step in voxels", "sheet thinner than a step", step, steppedOver, false, kSheets},
    {"checkerboard, optical depth of a voxel", "density that changes from voxel to voxel",
     [](const SceneFacts& f) { return f.grainDepth; }, [](const SceneFacts& f) { return f.grainShare; },
     false, kGrains},
    {"one voxel of this density beside 0", "a lone dense voxel", [](const SceneFacts& f) { return f.peak; },
     whole, false, kPeak},
    {"camera", "camera inside the medium", [](const SceneFacts& f) { return f.cameraDepth; }, whole, true,
     kCamera},
    {"point light, distance from the middle", "point light inside the medium",
     [](const SceneFacts& f) { return f.lightDepth; }, whole, true, kLight},
};

/// The map's error at `fact`: linear over the fact's logarithm between two places, the end's beyond an end.
double errorBetween(const std::map<double, double>& places, double fact) {
  const auto above = places.lower_bound(fact);
  if (above == places.begin()) return above->second;
  const auto below = std::prev(above);
  if (above == places.end() || !(below->first > 0.0)) return below->second;
  const double share = std::log(fact / below->first) / std::log(above->first / below->first);
  return below->second + share * (above->second - below->second);
}

double errorOf(const Rule& rule, const std::string& way, const SceneFacts& facts,
               std::span<const TrustRow> table) {
  const double fact = rule.fact(facts);
  if (rule.yesOrNo && !(fact > 0.0)) return 0.0;
  std::map<double, double> places;
  for (const TrustRow& row : table) {
    if (row.way != way || row.axis != rule.axis || (rule.yesOrNo && !(row.fact > 0.0))) continue;
    const double key = rule.yesOrNo ? 1.0 : row.fact;
    places[key] = std::max(places[key], row.error);
  }
  if (places.empty()) return 0.0;
  return rule.share(facts) * errorBetween(places, rule.yesOrNo ? 1.0 : fact);
}

}  // namespace

std::span<const TrustRow> trustTable() { return kTable; }

std::string wayFor(std::string_view method, const SceneFacts& facts, const ViewedScene& view) {
  if (method == "reference") return {};
  if (method != "march") return std::string(method);
  const MarchSettings& march = view.scene.march;
  return march.lightCache && facts.voxelDepth <= march.cacheDepth ? "march, light cached"
                                                                  : "march, light marched";
}

std::vector<std::string> trustWarnings(std::string_view method, const SceneFacts& facts,
                                       const ViewedScene& view, std::span<const TrustRow> table) {
  const std::string way = wayFor(method, facts, view);
  std::map<int, std::pair<double, std::string_view>> worst;
  for (const Rule& rule : kRules) {
    const double error = errorOf(rule, way, facts, table);
    if (error > kWarnedError && error > worst[rule.about].first) worst[rule.about] = {error, rule.sentence};
  }
  std::vector<std::string> sentences;
  for (const auto& [about, found] : worst)
    if (found.first > 0.0)
      sentences.push_back(std::string(method) + ": " + std::string(found.second) + "; error up to " +
                          shortPercent(found.first));
  return sentences;
}

double factOf(const std::string& axis, const SceneFacts& facts) {
  for (const Rule& rule : kRules)
    if (rule.axis == axis) return rule.fact(facts);
  return std::numeric_limits<double>::quiet_NaN();
}

std::string trustRowsAsText(const StabilityResult& result) {
  std::ostringstream out;
  out << "// Made by `nephele-preview chart --stability --out DIR`; do not edit. Way, axis, fact, relative "
         "RMSE.\n";
  for (const StabilityCell& cell : result.cells) {
    const double fact = factOf(cell.axis, cell.facts);
    if (!cell.error || std::isnan(fact)) continue;
    out << "{\"" << result.ways[cell.way].name << "\", \"" << cell.axis << "\", " << number(fact) << ", "
        << number(cell.error->relativeRmse, 3) << "},\n";
  }
  return out.str();
}

}  // namespace nephele
