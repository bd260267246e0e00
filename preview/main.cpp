// nephele-preview: reads the command line, calls what it asks for, returns the exit code. Depends on preview
// and CLI11.
#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>

#include "base/version.h"
#include "preview/app/app.h"
#include "preview/chart_command.h"
#include "preview/fit_command.h"
#include "preview/measure/compare.h"
#include "preview/render_command.h"

namespace nephele {
namespace {

/// "960x540" → its two numbers, each 1 to 32768. Throws InputError.
void parseSize(const std::string& option, const std::string& text, int& width, int& height) {
  constexpr int kLongest = 32768;
  int used = 0;
  const int read = std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used);
  if (read != 2 || static_cast<size_t>(used) != text.size() || width < 1 || height < 1 || width > kLongest ||
      height > kLongest)
    throw InputError({}, option + " '" + text + "' should be WIDTHxHEIGHT in pixels, as in 960x540");
}

/// "1-48" → its two numbers, at least 0; "7" is "7-7". Throws InputError.
std::pair<int, int> parseFrames(const std::string& text) {
  int first = 0, last = 0, used = 0, usedByOne = 0;
  const int read = std::sscanf(text.c_str(), "%8d%n-%8d%n", &first, &usedByOne, &last, &used);
  const bool one = read == 1 && static_cast<size_t>(usedByOne) == text.size();
  const bool two = read == 2 && static_cast<size_t>(used) == text.size();
  if (one) last = first;
  if (!(one || two) || first < 0 || last < first)
    throw InputError({}, "--frames '" + text + "' should be FIRST-LAST or one frame, as in 1-48 or 7");
  return {first, last};
}

/// The options as typed, before they are understood.
struct Arguments {
  RenderOptions render;
  std::string size = "960x540", windowSize = "1280x720", frames, error, filter = "hardware", tolerance, vram;
  std::string picture, reference, chartSize = "128x72", fitSize = "48x36";
  ChartOptions chart;
  FitCommandOptions fit;
  double step = 0.0, exposure = 0.0;
  bool json = false;
};

/// "512M": a number and K, M or G, powers of 1024; at least a byte.
uint64_t parseBytes(const std::string& option, const std::string& text) {
  constexpr double kKibi = 1024.0, kMost = 1e15;
  size_t used = 0;
  double bytes = 0.0;
  try {
    bytes = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  const std::string unit = text.substr(used);
  const size_t power = unit.empty() ? 0 : std::string("KMG").find(unit[0]) + 1;
  bytes *= std::pow(kKibi, static_cast<double>(power));
  const bool known = unit.empty() || (unit.size() == 1 && power > 0);
  if (used == 0 || !known || !(bytes >= 1.0 && bytes < kMost))
    throw InputError({}, option + " should be a size as in 512M or 2G, found '" + text + "'");
  return static_cast<uint64_t>(bytes);
}

void addRenderOptions(CLI::App& app, Arguments& a) {
  app.add_option("FILE", a.render.file, "The .vdb to show");
  app.add_option("--render", a.render.out, "Render to OUT.exr or OUT.png without a display, and quit");
  app.add_option("--size", a.size, "Size of the rendered picture, pixels")->capture_default_str();
  app.add_option("--window-size", a.windowSize, "Size of the window, pixels")->capture_default_str();
  app.add_option("--method", a.render.method, "How radiance is found")->capture_default_str();
  app.add_option("--scene", a.render.scene,
                 "A scene, any YAML file with a top-level scene:, or a preset: noon, sunset, backlit, "
                 "moonlight, overcast");
  app.add_option("--grid", a.render.grid,
                 "The grid to show (default: density, else the first float fog grid)");
  app.add_option("--spp", a.render.samples, "Samples a pixel (default: 4; 64 for the reference)")
      ->check(CLI::Range(1u, 1u << 20));
  app.add_option("--step", a.step, "Length of a step, voxels (default: the scene's, 0.5)")
      ->check(CLI::Range(0.01, 100.0));
  app.add_option(
         "--bounces", a.render.bounces,
         "Scatterings after the first, for --method reference and --error (default: all, but 0 for --error "
         "where the scene has no octaves; 0 is single scattering)")
      ->check(CLI::Range(0, 1000000));
  app.add_option(
      "--error", a.error,
      "Relative RMSE to reach against the scene's own truth, as in 1%: picks and measures the cheapest "
      "settings (--method reference: traces until its noise is that small)");
  app.add_option("--stats", a.render.stats, "Write time, samples and memory to a JSON file");
  app.add_option("--seed", a.render.seed, "Seed of all random numbers")->capture_default_str();
  app.add_option("--exposure", a.exposure,
                 "Exposure of PNG and window, EV (default: 0 with --scene, chosen from the picture without)")
      ->check(CLI::Range(-64.0, 64.0));
  app.add_flag("--aov", a.render.aov, "Add transmittance and depth to an EXR");
  app.add_option("--filter", a.filter, "How densities are read between samples")
      ->capture_default_str()
      ->check(CLI::IsMember({"exact", "hardware"}));
  app.add_option(
      "--vram", a.vram,
      "Limit of GPU memory for bricks, index, light cache and picture, as in 512M or 2G (default: none); "
      "beyond it bricks come from coarser levels");
  app.add_option("--frames", a.frames, "Render frames A-B, both included, or one frame, to OUT_####");
}

void addChartOptions(CLI::App& app, Arguments& a) {
  app.add_option("FILE", a.chart.file, "The .vdb to measure on (not for --stability)");
  app.add_flag(
      "--stability", a.chart.stability,
      "Map where each method may be trusted: stability.csv, .svg, .png and .md; exit 3 where a picture "
      "holds what none may");
  app.add_option("--out", a.chart.out, "The folder for chart.csv, chart.svg, chart.png and index.html")
      ->required();
  app.add_option("--scene", a.chart.scene, "A scene, or any YAML file with a top-level scene:");
  app.add_option("--grid", a.chart.grid, "The grid (default: density, else the first float fog grid)");
  app.add_option("--methods", a.chart.methods,
                 "Methods to chart, as in march,reference (default: all that are built)")
      ->delimiter(',');
  app.add_option("--minutes", a.chart.minutes, "Time to measure for, minutes")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e4));
  app.add_option("--bounces", a.chart.bounces,
                 "Scatterings after the first in truth (default: 0 where the scene has no octaves, else all)")
      ->check(CLI::Range(0, 1000000));
  app.add_option("--size", a.chartSize, "Size of the pictures that are measured, pixels")
      ->capture_default_str();
}

void addFitOptions(CLI::App& app, Arguments& a) {
  app.add_option("FILE", a.fit.files, "The .vdb to fit to; several get one set of factors")->required();
  app.add_option("--check", a.fit.checks, "Files that are measured and not fitted to");
  app.add_option("--scene", a.fit.scene, "A scene: its medium, camera and number of octaves are taken");
  app.add_option("--grid", a.fit.grid, "The grid (default: density, else the first float fog grid)");
  app.add_option("--out", a.fit.out, "A folder for fit.csv, fit.svg and fit.png");
  app.add_option(
         "--octaves", a.fit.count,
         "Octaves beyond the first (default: the scene's, else the fewest that do nearly as well as 16)")
      ->check(CLI::Range(1, 16));
  app.add_option("--size", a.fitSize, "Size of the pictures that are fitted to, pixels")
      ->capture_default_str();
  app.add_flag("--dry-run", a.fit.dryRun, "Leave the files as they are");
  app.add_flag("--even-if-worse", a.fit.evenIfWorse,
               "Store factors that leave views held back worse than 0.5 does (else: exit code 3)");
}

int renderOrShow(Arguments& a, bool renderGiven, bool stepGiven, bool exposureGiven) {
  if (a.render.file.empty()) throw InputError({}, "no file is given", "try nephele-preview --help");
  // A range lets what is not a number through.
  if (std::isnan(a.step)) throw InputError({}, "--step must be a number of voxels");
  if (std::isnan(a.exposure)) throw InputError({}, "--exposure must be a number of EV");
  if (renderGiven && a.render.out.empty()) throw InputError({}, "--render needs OUT.exr or OUT.png");
  if (!a.error.empty()) {
    a.render.error = parseTolerance(a.error);
    if (!(a.render.error > 0.0)) throw InputError({}, "--error should be greater than 0");
  }
  if (!a.vram.empty()) a.render.vramBytes = parseBytes("--vram", a.vram);
  if (stepGiven) a.render.stepVoxels = a.step;
  if (exposureGiven) a.render.exposureEv = a.exposure;
  a.render.filter = a.filter == "exact" ? Filter::exact : Filter::hardware;
  if (!a.frames.empty()) a.render.frames = parseFrames(a.frames);
  parseSize("--size", a.size, a.render.width, a.render.height);
  if (!a.render.out.empty()) return renderCommand(a.render);
  if (a.render.frames) throw InputError({}, "--frames needs --render");
  AppOptions window;
  window.render = a.render;
  parseSize("--window-size", a.windowSize, window.width, window.height);
  window.folder = std::filesystem::current_path().string();
  return runApp(window);
}

int run(int argc, char** argv) {
  CLI::App app("Shows and renders OpenVDB clouds.", "nephele-preview");
  Arguments a;
  app.set_version_flag("--version", "nephele-preview " + std::string(programVersion()));
  addRenderOptions(app, a);
  CLI::App* compare =
      app.add_subcommand("compare", "Hold a picture against a reference; exit 3 if over the tolerance");
  compare->add_option("A", a.picture, "The picture, .exr")->required();
  compare->add_option("B", a.reference, "The reference, .exr")->required();
  compare->add_option("--tolerance", a.tolerance, "Largest relative RMSE, as in 0.03 or 3%");
  compare->add_flag("--json", a.json, "Print JSON");
  CLI::App* chart = app.add_subcommand("chart", "Chart methods against truth: CSV, SVG, PNG and a page");
  addChartOptions(*chart, a);
  CLI::App* fit = app.add_subcommand("fit",
                                     "Fit the octaves' factors to the reference for three heights of the "
                                     "sun, and store them in the file's metadata");
  addFitOptions(*fit, a);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // --help and --version come this way too.
    if (error.get_exit_code() == 0) return app.exit(error);
    throw InputError({}, error.what(), "try nephele-preview --help");
  }
  if (chart->parsed()) {
    parseSize("--size", a.chartSize, a.chart.width, a.chart.height);
    return chartCommand(a.chart);
  }
  if (fit->parsed()) {
    parseSize("--size", a.fitSize, a.fit.width, a.fit.height);
    return fitCommand(a.fit);
  }
  if (compare->parsed()) {
    std::optional<double> tolerance;
    if (!a.tolerance.empty()) tolerance = parseTolerance(a.tolerance);
    return compareCommand(a.picture, a.reference, tolerance, a.json);
  }
  return renderOrShow(a, app.count("--render") > 0, app.count("--step") > 0, app.count("--exposure") > 0);
}

}  // namespace
}  // namespace nephele

int main(int argc, char** argv) {
  return nephele::runGuarded([&] { return nephele::run(argc, argv); });
}
