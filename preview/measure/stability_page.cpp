// Tables and heat maps of stability. Depends on what its header names.
#include "preview/measure/stability_page.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "base/figures.h"
#include "base/files.h"
#include "base/heat_map.h"
#include "base/trust_map.h"
#include "preview/measure/trust.h"

namespace nephele {
namespace {

std::string textOf(const StabilityCell& cell) {
  if (!cell.refused.empty()) return "refused";
  if (cell.bad.any()) return "BAD";
  return cell.error ? shortPercent(cell.error->relativeRmse) : "finite";
}

TrustPlace placeOf(const StabilityCell& cell) {
  TrustPlace place{cell.value, textOf(cell), {}, false, !cell.refused.empty() || cell.bad.any()};
  if (cell.error) place.error = cell.error->relativeRmse;
  place.trusted = !place.failed && place.error.value_or(0.0) <= kTrustedError;
  return place;
}

TrustMap mapOf(const StabilityResult& result, size_t way) {
  TrustMap map;
  map.title = result.ways[way].name;
  for (const StabilityCell& cell : result.cells) {
    if (cell.way != way) continue;
    if (map.axes.empty() || map.axes.back().name != cell.axis) map.axes.push_back({cell.axis, {}});
    map.axes.back().places.push_back(placeOf(cell));
  }
  return map;
}

/// Of the ways that have figures.
std::vector<HeatMap> heatMapsOf(const StabilityResult& result) {
  std::vector<HeatMap> maps;
  for (size_t way = 0; way < result.ways.size(); ++way) {
    const auto measured = [way](const StabilityCell& cell) { return cell.way == way && cell.error; };
    if (std::any_of(result.cells.begin(), result.cells.end(), measured))
      maps.push_back(heatMapOf(mapOf(result, way)));
  }
  return maps;
}

Table tableOf(const StabilityResult& result) {
  Table table{{"method", "axis", "value", "relative_rmse", "low95", "high95", "bias", "not_finite",
               "negative", "above_one", "refused"},
              {}};
  for (const StabilityCell& cell : result.cells) {
    const auto figure = [&](double NoisyError::*member) {
      return cell.error ? std::to_string((*cell.error).*member) : std::string();
    };
    table.rows.push_back({result.ways[cell.way].name, cell.axis, cell.value,
                          figure(&NoisyError::relativeRmse), figure(&NoisyError::low),
                          figure(&NoisyError::high), figure(&NoisyError::bias),
                          std::to_string(cell.bad.notFinite), std::to_string(cell.bad.negative),
                          std::to_string(cell.bad.aboveOne), cell.refused});
  }
  for (const Flicker& f : result.flicker)
    table.rows.push_back(
        {result.ways[f.way].name, "flicker", f.motion, std::to_string(f.error), "", "", "", "", "", "", ""});
  return table;
}

}  // namespace

std::string stabilityPage(const StabilityResult& result) {
  std::ostringstream out;
  out << "# Where each method may be trusted\n\n"
         "Made by `nephele-preview chart --stability --out DIR`; do not edit. One axis at a time leaves the "
         "middle of the\n"
         "table: a bumpy ball of 28 voxels and radius 1, 4 optical depths thick, g 0.5, albedo 1, one sun "
         "from the side,\n"
         "steps of half a voxel, 32×32 pixels, 16 samples a pixel. Figures are relative RMSE against "
         "single-scattering\n"
         "truth, whose noise is taken out. Trusted is what errs by at most "
      << shortPercent(kTrustedError)
      << ". `finite`: without a truth (powder, octaves, what\n"
         "shows no light) and free of NaN, infinity and negative values, as every other cell is too; `BAD` "
         "would mean\n"
         "that it is not. `refused`: the method says so with a sentence. ![map](stability.png)\n";
  for (size_t way = 0; way < result.ways.size(); ++way) out << markdownOf(mapOf(result, way));
  if (!result.flicker.empty()) {
    out << "\n## Flicker\n\nThe error of each frame's change against truth's change, over mean radiance: a "
           "slow orbit (half a\n"
           "degree a frame) and a sequence whose waves move, 48 frames each. The reference's own line is its "
           "noise.\n\n"
           "| method | motion | error of the change | truth's change |\n|---|---|---|---|\n";
    for (const Flicker& f : result.flicker)
      out << "| " << result.ways[f.way].name << " | " << f.motion << " | " << shortPercent(f.error) << " | "
          << shortPercent(f.change) << " |\n";
  }
  return out.str();
}

std::vector<std::string> badCells(const StabilityResult& result) {
  std::vector<std::string> sentences;
  for (const StabilityCell& cell : result.cells) {
    if (!cell.bad.any()) continue;
    sentences.push_back(result.ways[cell.way].name + ", " + cell.axis + " " + cell.value + ": " +
                        std::to_string(cell.bad.notFinite) + " values not finite, " +
                        std::to_string(cell.bad.negative) + " negative, " +
                        std::to_string(cell.bad.aboveOne) + " shares above 1");
  }
  return sentences;
}

std::string writeStability(const std::string& folder, const StabilityResult& result) {
  writeCsv(folder + "/stability.csv", tableOf(result));
  writeText(folder + "/stability.md", stabilityPage(result));
  writeText(folder + "/stability_table.inc", trustRowsAsText(result));
  return drawHeatMaps(heatMapsOf(result), folder, "stability");
}

}  // namespace nephele
