// Charts from the command line. Depends on preview, volume, base.
#include "preview/chart_command.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "base/error.h"
#include "base/files.h"
#include "preview/measure/chart_page.h"
#include "preview/method.h"
#include "preview/render_command.h"
#include "preview/resolve.h"

namespace nephele {
namespace {

constexpr std::string_view kTruth = "reference";
constexpr double kSecondsPerMinute = 60.0;

/// The scene with the look that has truth.
Scene physicalScene(const std::string& path) {
  Scene scene = openScene(path, {});
  if (scene.look == Look::report)
    std::cerr << "chart: the report look has no truth; the physical look is charted\n";
  scene.look = Look::physical;
  scene.powder.on = false;
  scene.lightTransmittance = LightTransmittance::marched;
  scene.march.levelPixels = 0.0;  // the small pictures stand for large ones, which resolve every voxel
  return scene;
}

}  // namespace

int chartCommand(const ChartOptions& options) {
  if (options.out.empty()) throw InputError({}, "chart needs --out FOLDER");
  for (const std::string& name : options.methods) findMethod(name);
  const Scene scene = physicalScene(options.scene);
  const BrickVolume bricks = openVolume(options.file, options.grid);
  if (bricks.empty()) throw InputError({options.file}, "an empty grid has nothing to chart");
  std::error_code failed;
  std::filesystem::create_directories(options.out, failed);
  if (failed) throw WorldError("cannot make the folder '" + options.out + "': " + failed.message());
  removeLeftovers(options.out);
  requireWritable(options.out + "/chart.csv");
  std::string sentence;
  const ViewedScene view =
      resolveScene(scene, bricks, static_cast<double>(options.width) / options.height, sentence);
  std::cerr << sentence << '\n';
  SweepOptions sweeping;
  const std::vector<std::string>& asked = options.methods;
  const auto wanted = [&](std::string_view name) {
    return asked.empty() || std::find(asked.begin(), asked.end(), name) != asked.end();
  };
  for (const MethodRow& row : methods())
    if (row.make != nullptr && (wanted(row.name) || row.name == kTruth)) sweeping.methods.push_back(row);
  sweeping.chartsTruth = wanted(kTruth);
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
  for (const std::string& what : result.leftOut) std::cerr << "left out for want of time: " << what << '\n';
  std::cout << frontAsText(result) << std::flush;
  return kExitDone;
}

}  // namespace nephele
