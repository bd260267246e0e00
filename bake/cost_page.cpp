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
         (look.densityStep > 0.0 ? ", density_step " + number(look.densityStep) : "") + ", cutoff " +
         number(look.cutoff);
}

std::string nameOf(CostKind kind) {
  return kind == CostKind::file ? "file" : kind == CostKind::seconds ? "seconds" : "memory";
}

std::string nameOf(CostError error) { return error == CostError::depth ? "depth" : "density"; }

std::string nameOf(const CostFront& front) { return nameOf(front.error) + " by " + nameOf(front.cost); }

/// "depth by file (knee), density by memory": the fronts that a point is on.
std::string frontsOf(const CostChart& chart, size_t point) {
  std::string text;
  for (const CostFront& front : chart.fronts)
    if (onFront(front.points, point))
      text += (text.empty() ? "" : ", ") + nameOf(front) +
              (isKnee(front.points, front.knee, point) ? " (knee)" : "");
  return text;
}

bool isMainKnee(const CostChart& chart, size_t point) {
  return !chart.fronts.empty() && isKnee(chart.fronts.front().points, chart.fronts.front().knee, point);
}

Table tableOf(const CostChart& chart) {
  Table table;
  table.header = {"sweep",           "voxel_size",   "precision",     "octaves",    "density_step",
                  "cutoff",          "seconds",      "file_bytes",    "grid_bytes", "voxels_active",
                  "density_largest", "density_rmse", "depth_largest", "depth_rms",  "fronts"};
  for (size_t n = 0; n < chart.points.size(); ++n) {
    const CostPoint& p = chart.points[n];
    table.rows.push_back({p.sweep, number(p.look.voxelSize), precisionOf(p.look), octavesOf(p.look),
                          number(p.look.densityStep), number(p.look.cutoff), number(p.seconds),
                          std::to_string(p.fileBytes), std::to_string(p.gridBytes),
                          std::to_string(p.voxelsActive), number(p.densityLargest), number(p.densityRmse),
                          number(p.depthLargest), number(p.depthRms), frontsOf(chart, n)});
  }
  return table;
}

std::string titleOf(const CostChart& chart) {
  return "Bake of " + chart.asset + (chart.frame ? ", frame " + std::to_string(*chart.frame) : "");
}

/// The cost as the axis and the page have it: megabytes or seconds.
double shownCost(const CostPoint& point, CostKind kind) {
  return costOf(point, kind) / (kind == CostKind::seconds ? 1.0 : kMegabyte);
}

/// One front with all points, a series for each sweep; bars of depths go from their RMS to
/// the largest.
ChartPanel panelOf(const CostChart& chart, const CostFront& front) {
  const bool depth = front.error == CostError::depth;
  ChartPanel panel{titleOf(chart) + (depth ? ": optical depth" : ": density"),
                   front.cost == CostKind::file      ? "file, MB"
                   : front.cost == CostKind::seconds ? "seconds"
                                                     : "grid in memory, MB",
                   depth ? "largest error, bar down to RMS" : "relative RMSE",
                   {},
                   {}};
  const auto pointOf = [&](const CostPoint& p) {
    const double error = errorOf(p, front.error);
    return ChartPoint{shownCost(p, front.cost), error, depth ? p.depthRms : error, error};
  };
  for (const CostPoint& p : chart.points) {
    if (panel.series.empty() || panel.series.back().name != p.sweep)
      panel.series.push_back({p.sweep, {}, false});
    panel.series.back().points.push_back(pointOf(p));
  }
  if (front.points.empty()) return panel;
  ChartSeries line{"Pareto front", {}, true};
  for (const size_t i : front.points) line.points.push_back(pointOf(chart.points[i]));
  const CostPoint& knee = chart.points[front.points[front.knee]];
  panel.series.push_back(line);
  panel.series.push_back({"knee", {pointOf(knee)}, true});
  panel.note = "knee: " + nameOf(knee.look);
  return panel;
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
          "largest<th>RMS<th>density, largest<th>relative RMSE<th>on the fronts of</tr>\n";
  for (size_t n = 0; n < chart.points.size(); ++n) {
    const CostPoint& p = chart.points[n];
    page << (isMainKnee(chart, n) ? "<tr class=\"knee\"><td>" : "<tr><td>") << htmlEscaped(nameOf(p.look))
         << "<td>" << number(p.seconds) << "<td>" << number(double(p.fileBytes) / kMegabyte) << "<td>"
         << number(double(p.gridBytes) / kMegabyte) << "<td>" << percent(p.depthLargest) << "<td>"
         << percent(p.depthRms) << "<td>" << percent(p.densityLargest) << "<td>" << percent(p.densityRmse)
         << "<td>" << frontsOf(chart, n) << "</tr>\n";
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
  std::vector<ChartPanel> panels;
  for (const CostFront& front : chart.fronts) panels.push_back(panelOf(chart, front));
  const std::string sentence = drawChart(panels, folder, "chart");
  writeText(folder + "/index.html", htmlPage(titleOf(chart), pageOf(chart, folder, sentence.empty())));
  return sentence;
}

std::string costFrontAsText(const CostChart& chart) {
  std::ostringstream out;
  for (size_t n = 0; n < chart.fronts.size(); ++n) {
    const CostFront& front = chart.fronts[n];
    for (const size_t i : front.points) {
      const CostPoint& p = chart.points[i];
      const bool knee = isKnee(front.points, front.knee, i);
      if (n == 0)
        out << nameOf(p.look) << ": " << number(double(p.fileBytes) / kMegabyte) << " MB, "
            << number(p.seconds) << " s, optical depth within " << percent(p.depthLargest)
            << (knee ? "  <- knee" : "") << '\n';
      else if (knee)
        out << "knee of " << nameOf(front) << ": " << nameOf(p.look) << '\n';
    }
  }
  return out.str();
}

}  // namespace nephele
