// Where something may be trusted, axis by axis: what the stability maps of both programs share as a table
// and as a heat map. Depends on base/heat_map.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/heat_map.h"

namespace nephele {

/// One place on an axis, and what was found there.
struct TrustPlace {
  std::string value;            // on the axis: "1e-3"
  std::string text;             // of what was found: "1.3%", "refused", "BAD"
  std::optional<double> error;  // none: nothing to hold it against, or no figure
  bool trusted = false;
  bool failed = false;  // refused, or a value that none may be: the colour of the largest error
};

struct TrustAxis {
  std::string name;
  std::vector<TrustPlace> places;  // in order
};

/// The axes of one method. Colours go from green at `low` to red at `high`.
struct TrustMap {
  std::string title;
  double low = 0.01, high = 0.3;
  std::vector<TrustAxis> axes;
};

/// "1e-3 to 10, 1e3": runs of places that may be trusted; "everywhere" or "nowhere".
std::string trustedRange(const TrustAxis& axis);

/// A section of Markdown: the title, and a line an axis with all places and the trusted range.
std::string markdownOf(const TrustMap& map);

HeatMap heatMapOf(const TrustMap& map);

}  // namespace nephele
