// Totals of frames and their file. Depends on preview/measure, scene, base and nlohmann_json.
#include "preview/render_stats.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/files.h"
#include "scene/light_model.h"

namespace nephele {
namespace {

nlohmann::ordered_json jsonOf(const ErrorReport& report, double asked) {
  nlohmann::ordered_json json{{"asked", asked},
                              {"method", report.pick.setting.method},
                              {"setting", report.pick.setting.name},
                              {"expected", report.pick.error},
                              {"expected_ms", report.pick.milliseconds},
                              {"expected_work", report.pick.work},
                              {"processor_ms", report.processorMilliseconds},
                              {"measured", report.measured.relativeRmse},
                              {"low95", report.measured.low},
                              {"high95", report.measured.high},
                              {"every_pixel_of", report.stride},
                              {"seconds_choosing", report.secondsChoosing},
                              {"seconds_measuring", report.secondsMeasuring},
                              {"ways_measured", report.waysMeasured}};
  json["bounces"] = report.bounces ? nlohmann::ordered_json(*report.bounces) : nlohmann::ordered_json("all");
  return json;
}

std::vector<std::string> unphysicalTerms(const LightModel& light) {
  std::vector<std::string> names;
  for (const LightTerm& term : termsOf(light))
    if (term.on && !term.physical) names.emplace_back(term.name);
  return names;
}

}  // namespace

void RenderTotals::add(const PictureCost& picture) {
  ++frames;
  cost.milliseconds += picture.milliseconds;
  cost.millisecondsPreparing += picture.millisecondsPreparing;
  cost.millisecondsUpload += picture.millisecondsUpload;
  cost.densitySamplesPerPixel += picture.densitySamplesPerPixel;
  cost.gpuBytes = std::max(cost.gpuBytes, picture.gpuBytes);
  cost.volumeBytes = std::max(cost.volumeBytes, picture.volumeBytes);
  cost.texel = picture.texel;
  cost.bricksOfLevel = picture.bricksOfLevel;
  cost.voxelPixels = picture.voxelPixels;
  cost.skipsChecked += picture.skipsChecked;
  cost.skipsWrong += picture.skipsWrong;
}

void writeRenderStats(const std::string& path, const RenderTotals& totals, const Method& method,
                      const ViewedScene& view, double asked) {
  const double frames = totals.frames, preparing = totals.cost.millisecondsPreparing;
  const LightModel light = lightModelOf(view.scene, view.medium);
  nlohmann::ordered_json stats{{"seconds_load", totals.secondsLoad / frames},
                               {"seconds_to_last_pixel", totals.secondsToLastPixel / frames},
                               {"ms_per_frame", totals.cost.milliseconds / frames},
                               {"samples_per_pixel", totals.cost.densitySamplesPerPixel / frames},
                               {"gpu_bytes", totals.cost.gpuBytes},
                               {"gpu_volume_bytes", totals.cost.volumeBytes},
                               {"gpu_texel", totals.cost.texel},
                               {"bricks_of_level", totals.cost.bricksOfLevel},
                               {"voxel_pixels", totals.cost.voxelPixels},
                               {"skips_checked", totals.cost.skipsChecked},
                               {"skips_wrong", totals.cost.skipsWrong},
                               {"gl_renderer", method.renderer},
                               {"seconds_driver", method.secondsDriver},
                               {"seconds_shaders", method.secondsShaders},
                               {"look", nameOf(light.look)},
                               {"not_physical", unphysicalTerms(light)},
                               {"white_furnace", furnaceValue(light.octaveCount, light.a, light.b, light.d)}};
  if (totals.cost.volumeBytes > 0) {  // the reference uploads nothing and keeps no light
    stats["ms_upload"] = totals.cost.millisecondsUpload / frames;
    stats["ms_light_cache"] = (preparing - totals.cost.millisecondsUpload) / frames;
    stats["ms_march"] = (totals.cost.milliseconds - preparing) / frames;
  }
  if (totals.error) stats["error"] = jsonOf(*totals.error, asked);
  const std::string text = stats.dump(2) + "\n";
  writeText(path, text);
}

}  // namespace nephele
