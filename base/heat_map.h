// Tables of numbers as coloured cells, drawn by gnuplot. Depends on base/chart.h.
#pragma once

#include <string>
#include <vector>

#include "base/chart.h"

namespace nephele {

/// One row of cells: its name at the left, `labels` in the cells, of one line or more. Rows may differ in
/// length.
struct HeatRow {
  std::string name;
  std::vector<double> values;       // not finite: a cell in grey
  std::vector<std::string> labels;  // one a value
};

/// Coloured by the decimal logarithm, green at `low` and below, yellow between, red at `high` and above.
struct HeatMap {
  std::string title;
  double low = 0.01, high = 0.3;
  std::vector<HeatRow> rows;
};

/// The gnuplot script that draws maps one under another.
std::string heatMapScript(const std::vector<HeatMap>& maps, const std::string& terminal,
                          const std::string& output);

/// Draws FOLDER/STEM.svg and FOLDER/STEM.png; returns as drawChart does.
std::string drawHeatMaps(const std::vector<HeatMap>& maps, const std::string& folder,
                         const std::string& stem);

}  // namespace nephele
