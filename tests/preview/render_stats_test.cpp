// What --stats writes: means over frames, the largest of memory, and what is apart from what.
#include "preview/render_stats.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "tests/scratch_folder.h"

namespace nephele {
namespace {

class NoMethod : public Method {
 public:
  NoMethod() {
    renderer = "none";
    secondsDriver = 0.25;
    secondsShaders = 0.75;
  }
  void setVolume(const BrickVolume&) override {}
  Picture render(const ViewedScene&, const PictureRequest&, PictureCost&) override { return {}; }
};

nlohmann::json statsOf(const RenderTotals& totals) {
  const ScratchFolder folder;
  writeRenderStats(folder.file("stats.json"), totals, NoMethod(), {}, 0.0);
  return nlohmann::json::parse(readWhole(folder.file("stats.json")));
}

/// A picture of 12 ms, of which 7 prepare it, of which 4 upload it.
PictureCost pictureOf(double times) {
  PictureCost cost;
  cost.milliseconds = 12.0 * times;
  cost.millisecondsPreparing = 7.0 * times;
  cost.millisecondsUpload = 4.0 * times;
  cost.volumeBytes = 100;
  return cost;
}

TEST(RenderStats, PartsOfAPictureAreApartAndMeansOverFrames) {
  RenderTotals totals;
  totals.secondsLoad = 2.0;
  totals.secondsToLastPixel = 6.0;
  totals.add(pictureOf(1.0));
  totals.add(pictureOf(3.0));
  const nlohmann::json stats = statsOf(totals);
  EXPECT_EQ(stats.at("seconds_load"), 1.0);
  EXPECT_EQ(stats.at("seconds_to_last_pixel"), 3.0);
  EXPECT_EQ(stats.at("ms_per_frame"), 24.0);
  EXPECT_EQ(stats.at("ms_upload"), 8.0);
  EXPECT_EQ(stats.at("ms_light_cache"), 6.0);
  EXPECT_EQ(stats.at("ms_march"), 10.0);
  EXPECT_EQ(stats.at("seconds_driver"), 0.25);
  EXPECT_EQ(stats.at("seconds_shaders"), 0.75);
  EXPECT_EQ(stats.at("gl_renderer"), "none");
}

TEST(RenderStats, WhatUploadsNothingHasNoSuchParts) {
  RenderTotals totals;
  PictureCost reference = pictureOf(1.0);
  reference.volumeBytes = 0;
  totals.add(reference);
  const nlohmann::json stats = statsOf(totals);
  EXPECT_EQ(stats.at("ms_per_frame"), 12.0);
  for (const char* part : {"ms_upload", "ms_light_cache", "ms_march"})
    EXPECT_FALSE(stats.contains(part)) << part;
}

}  // namespace
}  // namespace nephele
