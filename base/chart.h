// Tables as CSV, and charts of them as SVG and PNG by gnuplot, which is looked for when a chart is drawn.
// Depends on base alone.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace nephele {

/// A table of texts; every row has as many cells as the header.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// RFC 4180: a cell with a comma, a quote or a line break is quoted. The last line ends too.
std::string csvText(const Table& table);
/// Writes it whole or not at all. Throws WorldError.
void writeCsv(const std::string& path, const Table& table);

/// One mark with the ends of its vertical bar.
struct ChartPoint {
  double x = 0.0, y = 0.0, low = 0.0, high = 0.0;
};

/// Marks of one colour, named in the key; `line` joins them in order of x (one point alone is marked large).
struct ChartSeries {
  std::string name;
  std::vector<ChartPoint> points;
  bool line = false;
};

/// One panel with logarithmic axes; `note` is a second line of its title. Points that are not above 0 on both
/// axes are left out by gnuplot.
struct ChartPanel {
  std::string title, xLabel, yLabel;
  std::vector<ChartSeries> series;
  std::string note{};
};

/// The gnuplot script that draws the panels, two in a row, into `output` with a terminal ("svg" or
/// "pngcairo").
std::string gnuplotScript(const std::vector<ChartPanel>& panels, const std::string& terminal,
                          const std::string& output);

/// The script that draws one picture into `output` with a terminal ("svg" or "pngcairo").
using GnuplotScript = std::function<std::string(const std::string& terminal, const std::string& output)>;

/// Draws FOLDER/STEM.svg and FOLDER/STEM.png by a script. Returns as drawChart does.
std::string drawByGnuplot(const std::string& folder, const std::string& stem, const GnuplotScript& scriptOf);

/// A text as gnuplot's single-quoted string, with no line break in it.
std::string gnuplotText(const std::string& text);

/// Draws the panels as FOLDER/STEM.svg and FOLDER/STEM.png. Returns an empty text, or one sentence on why
/// there is no chart: gnuplot is missing or failed.
std::string drawChart(const std::vector<ChartPanel>& panels, const std::string& folder,
                      const std::string& stem);

}  // namespace nephele
