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

// Pixels: of a row, of a title with what stands beside it, of a character in names and in cells, of what
// stays free beside them.
constexpr int kRow = 34, kHead = 46, kNameCharacter = 9, kCellCharacter = 6, kFree = 10;

struct Layout {
  int left = 0, cell = 0, width = 0, height = 0;  // pixels; cells are equally wide in all maps
};

std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

Layout layoutOf(const std::vector<HeatMap>& maps) {
  size_t name = 0, label = 0, widest = 1;
  Layout layout;
  for (const HeatMap& map : maps) {
    layout.height += kHead + kRow * static_cast<int>(map.rows.size());
    for (const HeatRow& row : map.rows) {
      name = std::max(name, row.name.size());
      widest = std::max(widest, row.values.size());
      for (const std::string& text : row.labels)
        for (const std::string& line : linesOf(text)) label = std::max(label, line.size());
    }
  }
  layout.left = kFree + kNameCharacter * static_cast<int>(name);
  layout.cell = kFree + kCellCharacter * static_cast<int>(label);
  layout.width = layout.left + layout.cell * static_cast<int>(widest) + kFree;
  layout.height += kFree;
  return layout;
}

/// The lines of a text one under another in the middle of a cell.
void addLabel(std::ostream& out, const std::string& text, size_t column, size_t row, size_t& label) {
  constexpr double kFirst = 0.1, kLast = 0.9;  // of the row's height
  const std::vector<std::string> lines = linesOf(text);
  const double line = (kLast - kFirst) / static_cast<double>(lines.size());
  for (size_t n = 0; n < lines.size(); ++n)
    out << "set label " << ++label << ' ' << gnuplotText(lines[n]) << " at "
        << static_cast<double>(column) + 0.5 << ','
        << static_cast<double>(row) + kFirst + line * (static_cast<double>(n) + 0.5)
        << " center font ',8' noenhanced\n";
}

/// The map with its first row `top` pixels below the picture's upper edge.
void addMap(std::ostream& out, const HeatMap& map, const Layout& layout, int top) {
  size_t widest = 1;
  for (const HeatRow& row : map.rows) widest = std::max(widest, row.values.size());
  const auto acrossAt = [&](int pixels) { return static_cast<double>(pixels) / layout.width; };
  const auto upAt = [&](int pixels) { return 1.0 - static_cast<double>(pixels) / layout.height; };
  out << "unset object\nunset label\nset title " << gnuplotText(map.title)
      << " noenhanced\nset lmargin at screen " << acrossAt(layout.left) << "\nset rmargin at screen "
      << acrossAt(layout.left + layout.cell * static_cast<int>(widest)) << "\nset tmargin at screen "
      << upAt(top) << "\nset bmargin at screen " << upAt(top + kRow * static_cast<int>(map.rows.size()))
      << "\nset xrange [0:" << widest << "]\nset yrange [" << map.rows.size() << ":0]\nset ytics (";
  for (size_t r = 0; r < map.rows.size(); ++r)
    out << (r > 0 ? ", " : "") << gnuplotText(map.rows[r].name) << ' ' << static_cast<double>(r) + 0.5;
  out << ") scale 0 noenhanced\n";
  size_t object = 0, label = 0;
  for (size_t r = 0; r < map.rows.size(); ++r) {
    const HeatRow& row = map.rows[r];
    NEPHELE_CHECK_EQ(row.values.size(), row.labels.size());
    for (size_t i = 0; i < row.values.size(); ++i) {
      out << "set object " << ++object << " rectangle from " << i << ',' << r << " to " << i + 1 << ','
          << r + 1 << " fc rgb '" << colourOf(row.values[i], map) << "' fs solid border rgb '#ffffff'\n";
      addLabel(out, row.labels[i], i, r, label);
    }
  }
  out << "plot NaN notitle\n";
}

}  // namespace

std::string heatMapScript(const std::vector<HeatMap>& maps, const std::string& terminal,
                          const std::string& output) {
  const Layout layout = layoutOf(maps);
  std::ostringstream out;
  out << "set terminal " << terminal << " size " << layout.width << ',' << layout.height
      << " background rgb 'white'\nset output " << gnuplotText(output)
      << "\nset encoding utf8\nunset key\nunset xtics\nset border 0\nset multiplot\n";
  int top = 0;
  for (const HeatMap& map : maps) {
    addMap(out, map, layout, top + kHead);
    top += kHead + kRow * static_cast<int>(map.rows.size());
  }
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
