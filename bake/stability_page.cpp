// The page of what bakes. Depends on what its header names.
#include "bake/stability_page.h"

#include <cmath>
#include <set>
#include <sstream>

#include "base/figures.h"
#include "base/files.h"

namespace nephele {
namespace {

/// "< 0.01%" below what is shown, two to three digits above.
std::string errorText(double error) {
  constexpr double kUnseen = 1e-4;
  return error < kUnseen ? "< 0.01%" : shortPercent(error);
}

TrustPlace placeOf(const BakeCell& cell) {
  TrustPlace place{cell.value, "empty", cell.error, false, false};
  place.failed = !cell.refused.empty() || cell.bad.any();
  if (cell.bad.any())
    place.text = "BAD";
  else if (!cell.refused.empty())
    place.text = "refused";
  else if (cell.error)
    place.text = errorText(*cell.error);
  const double trusted = cell.measure == BakeMeasure::voxels ? kTrustedVoxels : kTrustedDepths;
  place.trusted = !place.failed && cell.error.value_or(0.0) <= trusted;
  return place;
}

TrustMap mapOf(const BakeStability& result, BakeMeasure measure, const std::string& title, double trusted) {
  // Green at a fifth of what is trusted, red at six times as much, as the previewer's map has it.
  TrustMap map{title, 0.2 * trusted, 6.0 * trusted, {}};
  for (const BakeCell& cell : result.cells) {
    if (cell.measure != measure) continue;
    if (map.axes.empty() || map.axes.back().name != cell.axis) map.axes.push_back({cell.axis, {}});
    map.axes.back().places.push_back(placeOf(cell));
  }
  return map;
}

std::string stepText(double seconds) {
  return seconds < 1.0 ? "1/" + number(1.0 / seconds) + " s" : number(seconds) + " s";
}

TrustPlace placeOf(const IntegratorRow& row) {
  TrustPlace place{stepText(row.stepSeconds), "refused", row.error, false, false};
  place.trusted = row.verdict == IntegratorVerdict::trusted;
  place.failed = row.verdict == IntegratorVerdict::refused || row.verdict == IntegratorVerdict::grows;
  if (row.verdict == IntegratorVerdict::grows)
    place.text = "GROWS";
  else if (row.verdict != IntegratorVerdict::refused)
    place.text = errorText(*row.error);
  return place;
}

TrustMap integratorsOf(const BakeStability& result) {
  TrustMap map{"Particles' motion", 0.2 * kTrustedIntegratorError, 6.0 * kTrustedIntegratorError, {}};
  for (const IntegratorRow& row : result.integrators) {
    const std::string name = row.axis + ": " + number(row.strength);
    if (map.axes.empty() || map.axes.back().name != name) map.axes.push_back({name, {}});
    map.axes.back().places.push_back(placeOf(row));
  }
  return map;
}

const char* nameOf(BakeMeasure measure) {
  return measure == BakeMeasure::voxels ? "voxels" : measure == BakeMeasure::depths ? "depths" : "mass";
}

Table tableOf(const BakeStability& result) {
  Table table{{"measure", "axis", "value", "error", "not_finite", "negative", "outside_bounds", "elsewhere",
               "refused"},
              {}};
  for (const BakeCell& cell : result.cells)
    table.rows.push_back(
        {nameOf(cell.measure), cell.axis, cell.value, cell.error ? number(*cell.error) : std::string(),
         std::to_string(cell.bad.notFinite), std::to_string(cell.bad.negative),
         std::to_string(cell.bad.outsideBounds), std::to_string(cell.bad.elsewhere), cell.refused});
  for (const IntegratorRow& row : result.integrators)
    table.rows.push_back({"motion", row.axis + ": " + number(row.strength), stepText(row.stepSeconds),
                          row.error ? number(*row.error) : std::string(), "0", "0", "0", "0", row.sentence});
  return table;
}

/// The sentences of refusals, each once with the first place that it is of.
void addRefusals(std::ostream& out, const BakeStability& result) {
  std::set<std::string> told;
  out << "\n## What is refused\n\n";
  const auto add = [&](const std::string& place, const std::string& sentence) {
    if (!sentence.empty() && told.insert(sentence).second)
      out << "- " << place << ": \"" << sentence << "\"\n";
  };
  for (const BakeCell& cell : result.cells) add(cell.axis + " " + cell.value, cell.refused);
  std::string last;
  for (const IntegratorRow& row : result.integrators) {
    if (row.sentence.empty() || row.axis == last) continue;
    last = row.axis;
    add(row.axis + " " + number(row.strength) + ", step " + stepText(row.stepSeconds), row.sentence);
  }
}

}  // namespace

std::vector<TrustMap> trustMapsOf(const BakeStability& result) {
  return {
      mapOf(result, BakeMeasure::voxels, "Voxels against what they should hold", kTrustedVoxels),
      mapOf(result, BakeMeasure::depths, "Optical depths against voxels a quarter as large", kTrustedDepths),
      mapOf(result, BakeMeasure::mass, "Mass of thin shapes", kTrustedDepths), integratorsOf(result)};
}

std::string bakeStabilityPage(const BakeStability& result) {
  std::ostringstream out;
  out << "# Where a bake may be trusted\n\n"
         "Made by `nephele-bake chart --stability --out DIR`; do not edit. One axis at a time leaves the "
         "middle "
         "of the table: a\n"
         "ball of 12 voxels about the origin, filled with gradient noise of three octaves and 8 voxels a "
         "cell, "
         "baked as float.\n"
         "`refused`: the recipe or its bake is, with a sentence that stands below. `empty`: no voxel is "
         "above 0. "
         "`BAD` would mean a\n"
         "value that is not finite or negative, or one that its interval leaves out"
      << (badBakes(result).empty() ? "; there is none.\n\n" : ".\n\n")
      << "- **Voxels**: relative RMSE against a formula (remaps), against the same recipe about the origin "
         "or "
         "at scale 1\n"
         "  (distances, scales), else against each voxel evaluated alone, its place in double precision. "
         "Trusted up to "
      << shortPercent(kTrustedVoxels)
      << ".\n"
         "- **Optical depths**: the largest difference along 2000 random rays over the largest depth, as for "
         "a "
         "`tolerance`. What a\n"
         "  voxel a quarter as large does not show either is not counted. Trusted up to "
      << shortPercent(kTrustedDepths)
      << ".\n"
         "- **Mass** against the shape's volume, for shapes with hard edges (`falloff: 0`) and one soft "
         "ball. "
         "Trusted up to "
      << shortPercent(kTrustedDepths)
      << ".\n"
         "- **Motion**: after four seconds, from the closed form or a finely stepped run, in parts of the "
         "farthest that truth gets.\n"
         "  Trusted up to "
      << shortPercent(kTrustedIntegratorError)
      << "; beyond that a place is wrong, yet no farther away than the forces can bring a particle.\n\n"
         "![map](stability.png)\n";
  for (const TrustMap& map : trustMapsOf(result)) out << markdownOf(map);
  addRefusals(out, result);
  return out.str();
}

std::vector<std::string> badBakes(const BakeStability& result) {
  std::vector<std::string> sentences;
  for (const BakeCell& cell : result.cells) {
    if (!cell.bad.any()) continue;
    sentences.push_back(cell.axis + " " + cell.value + ": " + std::to_string(cell.bad.notFinite) +
                        " values not finite, " + std::to_string(cell.bad.negative) + " negative, " +
                        std::to_string(cell.bad.outsideBounds) + " cubes outside their bounds" +
                        (cell.bad.elsewhere > 0 ? ", voxels where none should be" : ""));
  }
  for (const IntegratorRow& row : result.integrators)
    if (row.verdict == IntegratorVerdict::grows)
      sentences.push_back(row.axis + " " + number(row.strength) + ", step " + stepText(row.stepSeconds) +
                          ": farther away than the forces can bring a particle");
  return sentences;
}

std::string writeBakeStability(const std::string& folder, const BakeStability& result) {
  writeCsv(folder + "/stability.csv", tableOf(result));
  writeText(folder + "/stability.md", bakeStabilityPage(result));
  std::vector<HeatMap> maps;
  for (const TrustMap& map : trustMapsOf(result)) maps.push_back(heatMapOf(map));
  return drawHeatMaps(maps, folder, "stability");
}

}  // namespace nephele
