// Tables and heat maps of stability. Depends on what its header names.
#include "preview/measure/stability_page.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "base/figures.h"
#include "base/files.h"
#include "base/heat_map.h"
#include "preview/measure/trust.h"

namespace nephele {
namespace {

std::string textOf(const StabilityCell& cell) {
  if (!cell.refused.empty()) return "refused";
  if (cell.bad.any()) return "BAD";
  return cell.error ? shortPercent(cell.error->relativeRmse) : "finite";
}

bool isTrusted(const StabilityCell& cell) {
  if (!cell.refused.empty() || cell.bad.any()) return false;
  return !cell.error || cell.error->relativeRmse <= kTrustedError;
}

/// Runs of cells of one way and one axis.
std::vector<std::vector<const StabilityCell*>> axesOf(const StabilityResult& result, size_t way) {
  std::vector<std::vector<const StabilityCell*>> axes;
  for (const StabilityCell& cell : result.cells) {
    if (cell.way != way) continue;
    if (axes.empty() || axes.back().front()->axis != cell.axis) axes.emplace_back();
    axes.back().push_back(&cell);
  }
  return axes;
}

/// "1e-3 to 10, 1e3": runs of values that may be trusted.
std::string trustedRange(const std::vector<const StabilityCell*>& axis) {
  std::string text;
  for (size_t i = 0; i < axis.size();) {
    if (!isTrusted(*axis[i])) {
      ++i;
      continue;
    }
    size_t last = i;
    while (last + 1 < axis.size() && isTrusted(*axis[last + 1])) ++last;
    text += text.empty() ? "" : ", ";
    if (i == 0 && last + 1 == axis.size()) return "everywhere";
    text += axis[i]->value + (last > i ? " to " + axis[last]->value : "");
    i = last + 1;
  }
  return text.empty() ? "nowhere" : text;
}

void addMethod(std::ostream& out, const StabilityResult& result, size_t way) {
  out << "\n## " << result.ways[way].name << "\n\n| axis | error along it | trusted |\n|---|---|---|\n";
  for (const auto& axis : axesOf(result, way)) {
    out << "| " << axis.front()->axis << " | ";
    for (size_t i = 0; i < axis.size(); ++i)
      out << (i > 0 ? ", " : "") << axis[i]->value << ": " << textOf(*axis[i]);
    out << " | " << trustedRange(axis) << " |\n";
  }
}

std::vector<HeatMap> mapsOf(const StabilityResult& result) {
  std::vector<HeatMap> maps;
  for (size_t way = 0; way < result.ways.size(); ++way) {
    HeatMap map;
    map.title = result.ways[way].name;
    bool measured = false;
    for (const auto& axis : axesOf(result, way)) {
      HeatRow row{axis.front()->axis, {}, {}};
      for (const StabilityCell* cell : axis) {
        const bool wrong = !cell->refused.empty() || cell->bad.any();
        row.values.push_back(wrong         ? map.high
                             : cell->error ? cell->error->relativeRmse
                                           : std::numeric_limits<double>::quiet_NaN());
        row.labels.push_back(cell->value + ": " + textOf(*cell));
        measured = measured || cell->error.has_value();
      }
      map.rows.push_back(std::move(row));
    }
    if (measured) maps.push_back(std::move(map));
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
  for (size_t way = 0; way < result.ways.size(); ++way) addMethod(out, result, way);
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
  return drawHeatMaps(mapsOf(result), folder, "stability");
}

}  // namespace nephele
