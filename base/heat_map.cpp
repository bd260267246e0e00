// Heat maps as gnuplot scripts: rectangles and texts. Depends on base alone.
#include "base/heat_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "base/error.h"

namespace nephele {
namespace {

/// Green over yellow to red by the logarithm of a value; grey where there is none.
std::string colourOf(double value, const HeatMap& map) {
  if (!std::isfinite(value)) return "#c8c8c8";
  const double place = value <= map.low ? 0.0 : std::log(value / map.low) / std::log(map.high / map.low);
  const double x = std::clamp(place, 0.0, 1.0);
  struct Stop {
    double red, green, blue;
  };
  static constexpr Stop kStops[] = {{120, 190, 120}, {250, 232, 130}, {214, 80, 70}};
  const Stop &from = kStops[x < 0.5 ? 0 : 1], &to = kStops[x < 0.5 ? 1 : 2];
  const double part = 2.0 * x - (x < 0.5 ? 0.0 : 1.0);
  const auto mixed = [part](double a, double b) { return static_cast<int>(std::lround(a + part * (b - a))); };
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", mixed(from.red, to.red), mixed(from.green, to.green),
                mixed(from.blue, to.blue));
  return text;
}

void addMap(std::ostream& out, const HeatMap& map) {
  size_t widest = 1;
  for (const HeatRow& row : map.rows) widest = std::max(widest, row.values.size());
  out << "unset object\nunset label\nset title " << gnuplotText(map.title)
      << " noenhanced\nset xrange [0:" << widest << "]\nset yrange [" << map.rows.size()
      << ":0]\nset ytics (";
  for (size_t r = 0; r < map.rows.size(); ++r)
    out << (r > 0 ? ", " : "") << gnuplotText(map.rows[r].name) << ' ' << static_cast<double>(r) + 0.5;
  out << ") scale 0 noenhanced\n";
  size_t object = 0;
  for (size_t r = 0; r < map.rows.size(); ++r) {
    const HeatRow& row = map.rows[r];
    NEPHELE_CHECK_EQ(row.values.size(), row.labels.size());
    for (size_t i = 0; i < row.values.size(); ++i) {
      ++object;
      out << "set object " << object << " rectangle from " << i << ',' << r << " to " << i + 1 << ',' << r + 1
          << " fc rgb '" << colourOf(row.values[i], map) << "' fs solid border rgb '#ffffff'\nset label "
          << object << ' ' << gnuplotText(row.labels[i]) << " at " << static_cast<double>(i) + 0.5 << ','
          << static_cast<double>(r) + 0.5 << " center font ',8' noenhanced\n";
    }
  }
  out << "plot NaN notitle\n";
}

}  // namespace

std::string heatMapScript(const std::vector<HeatMap>& maps, const std::string& terminal,
                          const std::string& output) {
  constexpr int kWidth = 860, kRow = 34, kHead = 90;  // pixels
  size_t most = 1;
  for (const HeatMap& map : maps) most = std::max(most, map.rows.size());
  std::ostringstream out;
  out << "set terminal " << terminal << " size " << kWidth * static_cast<int>(maps.size()) << ','
      << kHead + kRow * static_cast<int>(most) << " background rgb 'white'\nset output "
      << gnuplotText(output)
      << "\nset encoding utf8\nunset key\nunset xtics\nset border 0\nset multiplot layout 1," << maps.size()
      << '\n';
  for (const HeatMap& map : maps) addMap(out, map);
  out << "unset multiplot\nset output\n";
  return out.str();
}

std::string drawHeatMaps(const std::vector<HeatMap>& maps, const std::string& folder,
                         const std::string& stem) {
  return drawByGnuplot(folder, stem, [&](const std::string& terminal, const std::string& output) {
    return heatMapScript(maps, terminal, output);
  });
}

}  // namespace nephele
