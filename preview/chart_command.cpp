// Charts from the command line. Depends on preview, volume, base.
#include "preview/chart_command.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "base/error.h"
#include "base/files.h"
#include "preview/measure/chart_page.h"
#include "preview/measure/stability_page.h"
#include "preview/method.h"
#include "preview/render_command.h"
#include "preview/resolve.h"

namespace nephele {
namespace {

constexpr std::string_view kTruth = "reference";
constexpr double kSecondsPerMinute = 60.0;

/// The scene with what has truth: of `bounces` 0 the first order alone.
Scene physicalScene(const std::string& path, const std::optional<int>& bounces) {
  Scene scene = openScene(path, {});
  if (bounces == 0) {
    if (scene.octaves.count.value_or(0) > 0)
      std::cerr << "chart: single scattering is charted without octaves\n";
    scene.octaves.count = 0;
  }
  if (scene.look == Look::report)
    std::cerr << "chart: the report look has no truth; the physical look is charted\n";
  scene.look = Look::physical;
  scene.powder.on = false;
  if (scene.stage.on) std::cerr << "chart: the stage has no truth and is left out\n";
  scene.stage.on = false;
  scene.lightTransmittance = LightTransmittance::marched;
  scene.march.levelPixels = scene.march.stepPixels =
      0.0;  // the small pictures stand for large ones, which resolve every voxel
  return scene;
}

bool isWanted(const std::vector<std::string>& asked, std::string_view name) {
  return asked.empty() || std::find(asked.begin(), asked.end(), name) != asked.end();
}

/// The built ones of these names (all where there are none), and the reference.
std::vector<MethodRow> methodsFor(const std::vector<std::string>& asked) {
  std::vector<MethodRow> rows;
  for (const MethodRow& row : methods())
    if (row.make != nullptr && (isWanted(asked, row.name) || row.name == kTruth)) rows.push_back(row);
  return rows;
}

/// Makes the folder where it is missing, and sees that files can be written there.
void openFolder(const std::string& folder, const std::string& file) {
  if (folder.empty()) throw InputError({}, "chart needs --out FOLDER");
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw WorldError("cannot make the folder '" + folder + "': " + failed.message());
  removeLeftovers(folder);
  requireWritable(folder + "/" + file);
}

}  // namespace

int stabilityCommand(const ChartOptions& options) {
  for (const std::string& name : options.methods) findMethod(name);
  openFolder(options.out, "stability.csv");
  StabilityOptions asked;
  asked.methods = methodsFor(options.methods);
  asked.quiet = options.quiet;
  const StabilityResult result = runStability(asked);
  const std::string unable = writeStability(options.out, result);
  if (!unable.empty()) std::cerr << unable << '\n';
  const std::vector<std::string> bad = badCells(result);
  for (const std::string& sentence : bad) std::cerr << sentence << '\n';
  return bad.empty() ? kExitDone : kExitNo;
}

int chartCommand(const ChartOptions& options) {
  if (options.stability) return stabilityCommand(options);
  if (options.file.empty()) throw InputError({}, "chart needs a FILE.vdb to measure on, or --stability");
  for (const std::string& name : options.methods) findMethod(name);
  const Scene scene = physicalScene(options.scene, options.bounces);
  const BrickVolume bricks = openVolume(options.file, options.grid);
  if (bricks.empty()) throw InputError({options.file}, "an empty grid has nothing to chart");
  openFolder(options.out, "chart.csv");
  std::string sentence;
  const ViewedScene view =
      resolveScene(scene, bricks, static_cast<double>(options.width) / options.height, sentence);
  std::cerr << sentence << '\n';
  SweepOptions sweeping;
  sweeping.methods = methodsFor(options.methods);
  sweeping.chartsTruth = isWanted(options.methods, kTruth);
  sweeping.width = options.width;
  sweeping.height = options.height;
  sweeping.seconds = kSecondsPerMinute * options.minutes;
  sweeping.bounces = options.bounces;
  sweeping.quiet = options.quiet;
  const SweepResult result = sweep(bricks, view, sweeping);
  if (result.all.empty())
    throw WorldError("nothing could be measured within the minutes given; give more by --minutes");
  const std::string title = "Error against time: " + std::filesystem::path(options.file).filename().string();
  const float exposureEv = static_cast<float>(chooseExposure(result.shots.front().picture));
  const std::string unable = writeChart(options.out, title, result, exposureEv);
  if (!unable.empty()) std::cerr << unable << '\n';
  for (const std::string& what : result.leftOut) std::cerr << "left out: " << what << '\n';
  std::cout << frontAsText(result) << std::flush;
  return kExitDone;
}

}  // namespace nephele
