// A sweep as files: chart.csv, chart.svg, chart.png and an index.html that stands alone. Depends on
// preview/measure and base.
#pragma once

#include <string>

#include "preview/measure/sweep.h"

namespace nephele {

/// Writes the four files into `folder`, which exists. `title` names what was measured. Where gnuplot is
/// missing, CSV and page are written without charts, and the sentence on it is returned; otherwise an empty
/// text. Throws WorldError.
std::string writeChart(const std::string& folder, const std::string& title, const SweepResult& result,
                       float exposureEv);

/// The front as text, one line a point, the knee marked.
std::string frontAsText(const SweepResult& result);

}  // namespace nephele
