// A cost chart as CSV, picture and page. Depends on cost_chart.h, base.
#include <sstream>

#include "bake/cost_chart.h"
#include "base/chart.h"
#include "base/figures.h"
#include "base/files.h"
#include "base/front.h"
#include "base/html.h"

namespace nephele {
namespace {

constexpr double kMegabyte = 1e6;

std::string precisionOf(const Asset& look) { return look.precision == Precision::half ? "half" : "float"; }

std::string octavesOf(const Asset& look) {
  return look.mostOctaves == kAllOctaves ? "all" : std::to_string(look.mostOctaves);
}

std::string nameOf(const Asset& look) {
  return "voxel_size " + number(look.voxelSize) + ", " + precisionOf(look) + ", octaves " + octavesOf(look) +
         ", cutoff " + number(look.cutoff);
}

Table tableOf(const CostChart& chart) {
  Table table;
  table.header = {"sweep",       "voxel_size",    "precision",  "octaves",       "cutoff",
                  "seconds",     "file_bytes",    "grid_bytes", "voxels_active", "density_largest",
                  "density_rms", "depth_largest", "depth_rms",  "front",         "knee"};
  for (size_t n = 0; n < chart.points.size(); ++n) {
    const CostPoint& p = chart.points[n];
    table.rows.push_back({p.sweep, number(p.look.voxelSize), precisionOf(p.look), octavesOf(p.look),
                          number(p.look.cutoff), number(p.seconds), std::to_string(p.fileBytes),
                          std::to_string(p.gridBytes), std::to_string(p.voxelsActive),
                          number(p.densityLargest), number(p.densityRms), number(p.depthLargest),
                          number(p.depthRms), onFront(chart.front, n) ? "1" : "0",
                          isKnee(chart.front, chart.knee, n) ? "1" : "0"});
  }
  return table;
}

/// One kind of error over one cost, a series for each sweep; bars go from the RMS to the largest error.
template <class Cost>
ChartPanel panelOf(const CostChart& chart, const std::string& title, const std::string& xLabel, bool depth,
                   bool withFront, const Cost& costOf) {
  ChartPanel panel{
      title,
      xLabel,
      depth ? "optical depth: largest error, bar down to RMS" : "density: largest error, bar down to RMS",
      {}};
  const auto pointOf = [&](const CostPoint& p) {
    const double largest = depth ? p.depthLargest : p.densityLargest, rms = depth ? p.depthRms : p.densityRms;
    return ChartPoint{costOf(p), largest, rms, largest};
  };
  for (const CostPoint& p : chart.points) {
    if (panel.series.empty() || panel.series.back().name != p.sweep)
      panel.series.push_back({p.sweep, {}, false});
    panel.series.back().points.push_back(pointOf(p));
  }
  if (!withFront || chart.front.empty()) return panel;
  ChartSeries front{"Pareto front", {}, true};
  for (const size_t i : chart.front) front.points.push_back(pointOf(chart.points[i]));
  const CostPoint& knee = chart.points[chart.front[chart.knee]];
  panel.series.push_back(front);
  panel.series.push_back({"knee: " + nameOf(knee.look), {pointOf(knee)}, true});
  return panel;
}

std::string titleOf(const CostChart& chart) {
  return "Bake of " + chart.asset + (chart.frame ? ", frame " + std::to_string(*chart.frame) : "");
}

std::string pageOf(const CostChart& chart, const std::string& folder, bool drawn) {
  std::ostringstream page;
  page << "<p>Each bake against the same recipe at voxel_size " << number(chart.referenceSize) << " ("
       << chart.referenceVoxels
       << " active voxels, float, all octaves, a tenth of the cutoff): densities at all samples, optical "
          "depths along "
       << chart.rays << " random rays.</p>\n";
  if (drawn) page << readWhole(folder + "/chart.svg");
  page << "<h2>All bakes</h2><table><tr><th>bake<th>seconds<th>file MB<th>memory MB<th>depth, "
          "largest<th>RMS<th>density, largest<th>RMS</tr>\n";
  for (size_t n = 0; n < chart.points.size(); ++n) {
    const CostPoint& p = chart.points[n];
    page << (isKnee(chart.front, chart.knee, n) ? "<tr class=\"knee\"><td>" : "<tr><td>")
         << htmlEscaped(nameOf(p.look))
         << (isKnee(chart.front, chart.knee, n) ? " (knee)"
             : onFront(chart.front, n)          ? " (front)"
                                                : "")
         << "<td>" << number(p.seconds) << "<td>" << number(double(p.fileBytes) / kMegabyte) << "<td>"
         << number(double(p.gridBytes) / kMegabyte) << "<td>" << percent(p.depthLargest) << "<td>"
         << percent(p.depthRms) << "<td>" << percent(p.densityLargest) << "<td>" << percent(p.densityRms)
         << "</tr>\n";
  }
  page << "</table>\n";
  if (!chart.leftOut.empty()) {
    page << "<h2>Left out</h2><ul>";
    for (const std::string& what : chart.leftOut) page << "<li>" << htmlEscaped(what);
    page << "</ul>\n";
  }
  return page.str();
}

}  // namespace

std::string writeCostChart(const std::string& folder, const CostChart& chart) {
  writeCsv(folder + "/chart.csv", tableOf(chart));
  const auto seconds = [](const CostPoint& p) { return p.seconds; };
  const auto file = [](const CostPoint& p) { return double(p.fileBytes) / kMegabyte; };
  const auto memory = [](const CostPoint& p) { return double(p.gridBytes) / kMegabyte; };
  const std::vector<ChartPanel> panels = {
      panelOf(chart, titleOf(chart), "file, MB", true, true, file),
      panelOf(chart, "by time", "seconds", true, false, seconds),
      panelOf(chart, "by memory", "grid in memory, MB", true, false, memory),
      panelOf(chart, "density", "file, MB", false, false, file)};
  const std::string sentence = drawChart(panels, folder, "chart");
  writeText(folder + "/index.html", htmlPage(titleOf(chart), pageOf(chart, folder, sentence.empty())));
  return sentence;
}

std::string costFrontAsText(const CostChart& chart) {
  std::ostringstream out;
  for (const size_t i : chart.front) {
    const CostPoint& p = chart.points[i];
    out << nameOf(p.look) << ": " << number(double(p.fileBytes) / kMegabyte) << " MB, " << number(p.seconds)
        << " s, optical depth within " << percent(p.depthLargest)
        << (isKnee(chart.front, chart.knee, i) ? "  <- knee" : "") << '\n';
  }
  return out.str();
}

}  // namespace nephele
