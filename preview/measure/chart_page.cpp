// Tables, charts and the page of a sweep. Depends on preview/measure and base.
#include "preview/measure/chart_page.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>

#include "base/chart.h"
#include "base/figures.h"
#include "base/files.h"
#include "base/front.h"
#include "base/html.h"

namespace nephele {
namespace {

/// The setting of that name on the front, as an index into `all`.
std::optional<size_t> frontNamed(const SweepResult& result, const std::string& name) {
  for (const size_t i : result.front)
    if (result.settings[result.all[i].setting].name == name) return i;
  return {};
}

Table tableOf(const SweepResult& result) {
  Table table;
  table.header = {"method",
                  "setting",
                  "view",
                  "ms",
                  "samples_per_pixel",
                  "densities_per_pixel",
                  "relative_rmse",
                  "low95",
                  "high95",
                  "bias",
                  "p99",
                  "front",
                  "knee"};
  const auto add = [&](const Measured& m, bool front, bool knee) {
    const Setting& setting = result.settings[m.setting];
    table.rows.push_back({setting.method, setting.name, m.view, number(m.milliseconds),
                          std::to_string(setting.samples), number(m.densitiesPerPixel),
                          number(m.error.relativeRmse), number(m.error.low), number(m.error.high),
                          number(m.error.bias), number(m.error.p99), front ? "1" : "0", knee ? "1" : "0"});
  };
  for (size_t i = 0; i < result.all.size(); ++i)
    add(result.all[i], onFront(result.front, i), isKnee(result.front, result.knee, i));
  for (const Measured& m : result.single) add(m, false, false);
  return table;
}

// A bar that reaches 0 would have no end on a logarithmic axis: it stops at this share of the error.
constexpr double kShortestBar = 0.2;

/// Error over what `xOf` gives, a series for each method; with the front and the knee where x is time.
template <class X>
ChartPanel panelOf(const SweepResult& result, const std::string& title, const std::string& xLabel,
                   bool withFront, X&& xOf) {
  ChartPanel panel{title, xLabel, "relative RMSE, with 95% interval", {}};
  const auto pointOf = [&](const Measured& m) {
    return ChartPoint{xOf(m), m.error.relativeRmse,
                      std::max(m.error.low, kShortestBar * m.error.relativeRmse), m.error.high};
  };
  std::map<std::string, ChartSeries> series;
  for (const Measured& m : result.all) {
    ChartSeries& one = series[result.settings[m.setting].method];
    one.name = result.settings[m.setting].method;
    one.points.push_back(pointOf(m));
  }
  for (auto& [name, one] : series) panel.series.push_back(std::move(one));
  if (!withFront || result.front.empty()) return panel;
  ChartSeries front{"Pareto front", {}, true};
  for (const size_t i : result.front) front.points.push_back(pointOf(result.all[i]));
  const Measured& knee = result.all[result.front[result.knee]];
  panel.series.push_back(front);
  panel.series.push_back({"knee", {pointOf(knee)}, true});
  panel.note = "knee: " + result.settings[knee.setting].name;
  return panel;
}

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t three = 0;
    for (size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63u] : '=';  // six bits a digit
  }
  return out;
}

/// An <img> that holds the picture.
std::string imageOf(const std::string& folder, const Picture& picture, float exposureEv) {
  const std::string path = folder + "/.shot.png";
  writePng(path, picture, exposureEv, {});
  const std::string bytes = readWhole(path);
  std::filesystem::remove(path);
  return "<img src=\"data:image/png;base64," + base64(bytes) + "\">";
}

/// Too bright in red, too dark in blue, over the truth's mean radiance: full colour from a tenth of it on.
Picture differenceOf(const Picture& picture, const Picture& truth) {
  Picture difference;
  difference.width = picture.width;
  difference.height = picture.height;
  for (const char* name : {"R", "G", "B", "A"}) difference.add(name);
  const size_t count = truth.planes[0].size();
  double mean = 0.0, seen = 0.0;
  for (size_t i = 0; i < count; ++i) {
    if (!(truth.planes[3][i] > 1e-3f)) continue;
    for (size_t c = 0; c < 3; ++c) mean += double{truth.planes[c][i]} / 3.0;
    seen += 1.0;
  }
  mean /= std::max(seen, 1.0);
  constexpr double kFull = 10.0;
  for (size_t i = 0; i < count; ++i) {
    double apart = 0.0;
    for (size_t c = 0; c < 3; ++c) apart += (double{picture.planes[c][i]} - double{truth.planes[c][i]}) / 3.0;
    const double shown = mean > 0.0 ? kFull * apart / mean : 0.0;
    difference.planes[0][i] = static_cast<float>(std::max(shown, 0.0));
    difference.planes[2][i] = static_cast<float>(std::max(-shown, 0.0));
    difference.planes[3][i] = 1.0f;
  }
  return difference;
}

std::string pageOf(const std::string& folder, const std::string& title, const SweepResult& result,
                   float exposureEv, bool drawn) {
  std::ostringstream page;
  if (drawn) page << readWhole(folder + "/chart.svg");
  page << "<h2>The Pareto front</h2><table><tr><th>setting<th>ms<th>relative RMSE<th>95% "
          "interval<th>bias<th>p99</tr>\n";
  for (const size_t i : result.front) {
    const Measured& m = result.all[i];
    const bool knee = isKnee(result.front, result.knee, i);
    page << (knee ? "<tr class=\"knee\"><td>" : "<tr><td>") << htmlEscaped(result.settings[m.setting].name)
         << (knee ? " (knee)" : "") << "<td>" << number(m.milliseconds) << "<td>"
         << percent(m.error.relativeRmse) << "<td>" << percent(m.error.low) << " to " << percent(m.error.high)
         << "<td>" << percent(m.error.bias) << "<td>" << percent(m.error.p99) << "</tr>\n";
  }
  page << "</table>\n<h2>Pictures</h2><p>Below each picture its difference from truth: red where too bright, "
          "blue where too "
          "dark, over the mean radiance.</p>\n";
  const Picture& truth = result.shots.front().picture;
  page << "<figure>" << imageOf(folder, truth, exposureEv) << "<figcaption>truth</figcaption></figure>\n";
  for (const auto& shot : result.shots) {
    if (!frontNamed(result, shot.name)) continue;
    page << "<figure>" << imageOf(folder, shot.picture, exposureEv) << "<br>"
         << imageOf(folder, differenceOf(shot.picture, truth), 0.0f) << "<figcaption>"
         << htmlEscaped(shot.name) << "</figcaption></figure>\n";
  }
  if (!result.leftOut.empty()) {
    page << "<h2>Left out</h2><ul>";
    for (const std::string& what : result.leftOut) page << "<li>" << htmlEscaped(what);
    page << "</ul>\n";
  }
  return htmlPage(title, page.str());
}

}  // namespace

std::string frontAsText(const SweepResult& result) {
  std::ostringstream out;
  for (const size_t i : result.front) {
    const Measured& m = result.all[i];
    out << result.settings[m.setting].name << ": " << number(m.milliseconds) << " ms, relative RMSE "
        << percent(m.error.relativeRmse) << (isKnee(result.front, result.knee, i) ? "  <- knee" : "") << '\n';
  }
  return out.str();
}

std::string writeChart(const std::string& folder, const std::string& title, const SweepResult& result,
                       float exposureEv) {
  writeCsv(folder + "/chart.csv", tableOf(result));
  const std::vector<ChartPanel> panels = {
      panelOf(result, title, "milliseconds a picture", true,
              [](const Measured& m) { return m.milliseconds; }),
      panelOf(result, "by samples", "samples a pixel", false,
              [&](const Measured& m) { return static_cast<double>(result.settings[m.setting].samples); })};
  const std::string sentence = drawChart(panels, folder, "chart");
  writeText(folder + "/index.html", pageOf(folder, title, result, exposureEv, sentence.empty()));
  return sentence;
}

}  // namespace nephele
