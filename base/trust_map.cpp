// Tables and heat maps of what may be trusted. Depends on trust_map.h.
#include "base/trust_map.h"

#include <limits>
#include <sstream>

namespace nephele {

std::string trustedRange(const TrustAxis& axis) {
  const std::vector<TrustPlace>& places = axis.places;
  std::string text;
  for (size_t i = 0; i < places.size();) {
    if (!places[i].trusted) {
      ++i;
      continue;
    }
    size_t last = i;
    while (last + 1 < places.size() && places[last + 1].trusted) ++last;
    if (i == 0 && last + 1 == places.size()) return "everywhere";
    text += text.empty() ? "" : ", ";
    text += places[i].value + (last > i ? " to " + places[last].value : "");
    i = last + 1;
  }
  return text.empty() ? "nowhere" : text;
}

std::string markdownOf(const TrustMap& map) {
  std::ostringstream out;
  out << "\n## " << map.title << "\n\n| axis | error along it | trusted |\n|---|---|---|\n";
  for (const TrustAxis& axis : map.axes) {
    out << "| " << axis.name << " | ";
    for (size_t i = 0; i < axis.places.size(); ++i)
      out << (i > 0 ? ", " : "") << axis.places[i].value << ": " << axis.places[i].text;
    out << " | " << trustedRange(axis) << " |\n";
  }
  return out.str();
}

HeatMap heatMapOf(const TrustMap& map) {
  HeatMap heat{map.title, map.low, map.high, {}};
  for (const TrustAxis& axis : map.axes) {
    HeatRow row{axis.name, {}, {}};
    for (const TrustPlace& place : axis.places) {
      row.values.push_back(place.failed ? map.high
                                        : place.error.value_or(std::numeric_limits<double>::quiet_NaN()));
      row.labels.push_back(place.value + "\n" + place.text);
    }
    heat.rows.push_back(std::move(row));
  }
  return heat;
}

}  // namespace nephele
