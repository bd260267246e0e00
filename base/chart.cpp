// CSV, and gnuplot through a pipe. Depends on base alone.
#include "base/chart.h"

#include <cstdio>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "base/error.h"
#include "base/files.h"

namespace nephele {
namespace {

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

void addPanel(std::ostream& out, const ChartPanel& panel) {
  for (size_t i = 0; i < panel.series.size(); ++i) {
    out << "$data" << i << " << EOD\n";
    for (const ChartPoint& p : panel.series[i].points)
      out << p.x << ' ' << p.y << ' ' << p.low << ' ' << p.high << '\n';
    out << "EOD\n";
  }
  out << "set title " << gnuplotText(panel.title);
  if (!panel.note.empty()) out << ".\"\\n\"." << gnuplotText(panel.note);
  out << " noenhanced\nset xlabel " << gnuplotText(panel.xLabel) << " offset 0,0.6"
      << "\nset ylabel " << gnuplotText(panel.yLabel) << "\nplot ";
  for (size_t i = 0; i < panel.series.size(); ++i) {
    const ChartSeries& series = panel.series[i];
    const std::string title = " title " + gnuplotText(series.name) + " noenhanced";
    out << (i > 0 ? ", " : "") << "$data" << i;
    if (series.line)
      out << (series.points.size() > 1 ? " using 1:2 with linespoints lw 2 pt 6 ps 1.2 lc rgb '#202020'"
                                       : " using 1:2 with points lw 2 pt 12 ps 3 lc rgb '#c02020'")
          << title;
    else
      out << " using 1:2:3:4 with yerrorbars pt 7 ps 0.6" << title;
  }
  out << "\n";
}

/// Runs gnuplot on a script. Returns its exit status, or −1 where it could not be started.
int runGnuplot(const std::string& script) {
  std::FILE* pipe = popen("gnuplot - 2>/dev/null", "w");
  if (pipe == nullptr) return -1;
  std::fwrite(script.data(), 1, script.size(), pipe);
  return pclose(pipe);
}

}  // namespace

// In gnuplot's single quotes only the quote itself is special.
std::string gnuplotText(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += '\'';
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted + "'";
}

std::string csvText(const Table& table) {
  std::ostringstream out;
  const auto add = [&](const std::vector<std::string>& row) {
    NEPHELE_CHECK_EQ(row.size(), table.header.size());
    for (size_t i = 0; i < row.size(); ++i) out << (i > 0 ? "," : "") << csvCell(row[i]);
    out << '\n';
  };
  add(table.header);
  for (const auto& row : table.rows) add(row);
  return out.str();
}

void writeCsv(const std::string& path, const Table& table) {
  const std::string text = csvText(table);
  writeWhole(path, [&](const std::string& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    out.close();
    if (!out) throw WorldError("cannot write '" + path + "'");
  });
}

std::string gnuplotScript(const std::vector<ChartPanel>& panels, const std::string& terminal,
                          const std::string& output) {
  constexpr int kPanelWidth = 640, kPanelHeight = 480;  // pixels
  const int columns = panels.size() > 1 ? 2 : 1,
            rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  std::ostringstream out;
  out << std::setprecision(9) << "set terminal " << terminal << " size " << kPanelWidth * columns << ','
      << kPanelHeight * rows << " background rgb 'white'\nset output " << gnuplotText(output)
      << "\nset encoding utf8\nset logscale xy\nset grid\nset key below\nset linetype 5 lc rgb "
         "'#8c564b'\nset format y '%g'\nset format x "
         "'%g'\n"
      << "set multiplot layout " << rows << ',' << columns << '\n';
  for (const ChartPanel& panel : panels) addPanel(out, panel);
  out << "unset multiplot\nset output\n";
  return out.str();
}

std::string drawChart(const std::vector<ChartPanel>& panels, const std::string& folder,
                      const std::string& stem) {
  return drawByGnuplot(folder, stem, [&](const std::string& terminal, const std::string& output) {
    return gnuplotScript(panels, terminal, output);
  });
}

std::string drawByGnuplot(const std::string& folder, const std::string& stem, const GnuplotScript& scriptOf) {
  const std::pair<const char*, const char*> kinds[] = {{"svg", ".svg"}, {"pngcairo", ".png"}};
  for (const auto& [terminal, ending] : kinds) {
    const std::string path = folder + "/" + stem + ending;
    int status = 0;
    // Named anew: clang 14 captures no structured binding.
    writeWhole(path, [&, kind = terminal](const std::string& temporary) {
      std::ofstream(temporary, std::ios::binary);  // stays empty where gnuplot fails
      status = runGnuplot(scriptOf(kind, temporary));
    });
    if (status != 0) {
      std::remove(path.c_str());
      return "no chart is drawn: gnuplot is missing or failed (on Debian: apt install gnuplot-nox); the "
             "figures are in the CSV";
    }
  }
  return {};
}

}  // namespace nephele
