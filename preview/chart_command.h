// The command `chart`: methods against truth for one file. Depends on preview, volume, base.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace nephele {

struct ChartOptions {
  std::string file, out, scene, grid;
  std::vector<std::string> methods;  // empty: all that are built
  double minutes = 5.0;
  std::optional<int> bounces;
  int width = 128, height = 72;
  bool quiet = false;
  bool stability = false;  // the map of stability in place of a chart; needs no file
};

/// Measures and writes chart.csv, chart.svg, chart.png and index.html into `out`; the front goes to stdout,
/// what was left out to stderr. The report look is charted as physical, since its terms have no truth. Throws
/// InputError or WorldError. Returns the exit code 0.
int chartCommand(const ChartOptions& options);

/// Writes stability.csv, .svg, .png and .md into `out`. Returns 0, or 3 where a picture holds what none may:
/// each such cell is told of on stderr. Throws as chartCommand does.
int stabilityCommand(const ChartOptions& options);

}  // namespace nephele
