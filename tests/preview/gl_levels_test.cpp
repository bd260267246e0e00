// Pictures from coarser levels: what they err by against the finest, that both languages read them alike,
// that memory keeps to its limits, and that cost follows what is seen.
#include <gtest/gtest.h>

#include "preview/gpu/moving.h"
#include "preview/gpu/seen_volume.h"
#include "preview/gpu/sub_pixels.h"
#include "preview/measure/compare.h"
#include "preview/twin/march_picture.h"
#include "tests/preview/gl_bench.h"

namespace nephele::testing_gl {
namespace {

constexpr int kWidth = 64, kHeight = 64;

/// The same cloud of diameter 2 in the world by voxels of 2 / `across`.
BrickVolume cloudOf(int across) {
  glm::dmat4 worldFromIndex(1.0);
  for (int axis = 0; axis < 3; ++axis) worldFromIndex[axis] *= 2.0 / across;
  constexpr double kUnits = 64.0;  // of the formula across the cloud
  return volumeOf(glm::ivec3(across), glm::ivec3(-across / 2), worldFromIndex, [&](const glm::dvec3& p) {
    return cloudDensity(p * (kUnits / across), glm::dvec3(0.0), 0.49 * kUnits);
  });
}

ViewedScene viewFrom(double distance) {
  ViewedScene view;
  view.camera.target = glm::dvec3(0.0);
  view.camera.position = distance * glm::normalize(glm::dvec3(0.7, -1.0, 0.4));
  view.camera.fov = 2.0 * std::atan(1.1 / distance);  // it fills the picture
  view.medium = {{12.0, 12.0, 12.0}, {0.0, 0.0, 0.0}, 0.4};
  view.scene.environment.constant = {0.3, 0.4, 0.5};
  return view;
}

struct Rendered {
  FilmPicture film;
  double densities = 0.0;
};

Rendered render(MarchPass& pass, const BrickVolume& bricks, const BrickAtlas& atlas, const ViewedScene& view,
                unsigned samples = 4) {
  pass.setParameters(marchParameters(view, bricks, atlas.layout().frame, kWidth, kHeight, 5, true));
  const Film film(kWidth, kHeight);
  for (unsigned i = 0; i < samples; ++i)
    pass.draw(atlas, film, subPixelOffset(i, 5), i, {0, 0, kWidth, kHeight});
  Rendered rendered{film.read(), 0.0};
  rendered.densities = rendered.film.densitySamples + pass.takeCacheDensities();
  return rendered;
}

TEST(GlLevels, WhatAPictureCannotResolveChangesItLittle) {
  needContext();
  MarchPass pass(Filter::hardware);
  // 1: voxels of a third of a pixel, read from the level above. 2: of a sixth.
  for (const auto& [across, level, most] : {std::tuple(192, 1, 0.08), std::tuple(384, 2, 0.09)}) {
    const BrickVolume bricks = cloudOf(across);
    ViewedScene view = viewFrom(40.0);
    view.scene.march.levelPixels = 1.0;
    view.scene.march.stepPixels = 0.0;
    const BrickAtlas finest(bricks, Filter::hardware, Texel::r16f);
    SeenVolume seen(bricks, Filter::hardware);
    const BrickAtlas& chosen = seen.atlasFor(0, view, kWidth, kHeight, false);
    EXPECT_EQ(chosen.layout().frame.level, level);
    constexpr unsigned kSamples = 16;
    const Rendered fine = render(pass, bricks, finest, view, kSamples);
    const Rendered coarse = render(pass, bricks, chosen, view, kSamples);
    const Comparison error = comparePictures(coarse.film.picture, "level", fine.film.picture, "finest");
    std::printf("level %d: relative RMSE %.3g, bias %.3g, %.3g times fewer densities\n", level,
                error.relativeRmse, error.bias, fine.densities / coarse.densities);
    ViewedScene marched = view;
    marched.scene.march.lightCache = false;
    const Rendered fineMarched = render(pass, bricks, finest, marched, kSamples);
    const Rendered coarseMarched = render(pass, bricks, chosen, marched, kSamples);
    const Comparison alone =
        comparePictures(coarseMarched.film.picture, "level", fineMarched.film.picture, "finest");
    std::printf("  without the light cache: relative RMSE %.3g, bias %.3g, %.3g times fewer densities\n",
                alone.relativeRmse, alone.bias, fineMarched.densities / coarseMarched.densities);
    EXPECT_LT(error.relativeRmse, most);
    EXPECT_LT(alone.relativeRmse, 0.06);
    // Steps follow the optical depth and thin voxels have a coarse light cache, at the finest level as well.
    EXPECT_GT(fine.densities, coarse.densities);
    EXPECT_GT(fineMarched.densities, 1.1 * coarseMarched.densities);
  }
}

TEST(GlLevels, VoxelsOfAThirdAndASixthOfAPixelAreReadAsTheyAreByDefault) {
  needContext();
  // Means over half a pixel would err by the percents above, and by more where a cloud is uneven.
  for (const int across : {192, 384}) {
    const BrickVolume bricks = cloudOf(across);
    SeenVolume seen(bricks, Filter::hardware);
    const int level = seen.atlasFor(0, viewFrom(40.0), kWidth, kHeight, false).layout().frame.level;
    EXPECT_EQ(level, 0) << across;
  }
}

TEST(GlLevels, StepsOfAPixelChangeThePictureLittleWhereVoxelsAreSmaller) {
  needContext();
  MarchPass pass(Filter::hardware);
  const BrickVolume bricks = cloudOf(132);  // a voxel covers half a pixel
  const BrickAtlas atlas(bricks, Filter::hardware, Texel::r16f);
  for (const bool cached : {false, true}) {
    ViewedScene byVoxels = viewFrom(40.0), byPixels = byVoxels;
    byVoxels.scene.environment.constant = byPixels.scene.environment.constant = {0.0, 0.0, 0.0};
    byVoxels.scene.march.stepPixels = 0.0;
    byVoxels.scene.march.lightCache = false;
    byPixels.scene.march.lightCache = cached;
    constexpr unsigned kSamples = 16;
    const Rendered fine = render(pass, bricks, atlas, byVoxels, kSamples);
    const Rendered quick = render(pass, bricks, atlas, byPixels, kSamples);
    const Comparison error = comparePictures(quick.film.picture, "by pixels", fine.film.picture, "by voxels");
    std::printf("steps of a pixel, light %s: relative RMSE %.3g, bias %.3g, %.3g times fewer densities\n",
                cached ? "cached" : "marched", error.relativeRmse, error.bias,
                fine.densities / quick.densities);
    EXPECT_LT(error.relativeRmse, 0.03);
    EXPECT_LT(std::abs(error.bias), 0.01);
    EXPECT_GT(fine.densities, 1.1 * quick.densities);
  }
}

TEST(GlLevels, DenseVoxelsSmallerThanAPixelAreSteppedThroughOneByOne) {
  needContext();
  MarchPass pass(Filter::hardware);
  const BrickVolume bricks = cloudOf(264);  // a voxel covers a quarter of a pixel
  const BrickAtlas atlas(bricks, Filter::hardware, Texel::r16f);
  ViewedScene byVoxels = viewFrom(40.0);
  constexpr double kSigma = 300.0;  // a pixel is up to nine optical depths
  byVoxels.medium.sigmaS = {kSigma, kSigma, kSigma};
  byVoxels.scene.environment.constant = {0.0, 0.0, 0.0};
  byVoxels.scene.march.lightCache = false;
  byVoxels.scene.march.stepPixels = 0.0;
  ViewedScene byPixels = byVoxels;
  byPixels.scene.march.stepPixels = 1.0;
  constexpr unsigned kSamples = 64;
  const Rendered fine = render(pass, bricks, atlas, byVoxels, kSamples);
  const Rendered quick = render(pass, bricks, atlas, byPixels, kSamples);
  const Comparison error = comparePictures(quick.film.picture, "by pixels", fine.film.picture, "by voxels");
  std::printf("dense: relative RMSE %.3g, bias %.3g, %.3g times fewer densities\n", error.relativeRmse,
              error.bias, fine.densities / quick.densities);
  EXPECT_LT(error.relativeRmse, 0.02);
  EXPECT_LT(std::abs(error.bias), 0.003);
  EXPECT_GT(fine.densities, 1.05 * quick.densities);
}

TEST(GlLevels, CostGrowsWithWhatIsSeen) {
  needContext();
  MarchPass pass(Filter::hardware);
  const ViewedScene view = viewFrom(40.0);
  const auto densities = [&](int across) {
    const BrickVolume bricks = cloudOf(across);
    SeenVolume seen(bricks, Filter::hardware);
    return render(pass, bricks, seen.atlasFor(0, view, kWidth, kHeight, false), view).densities;
  };
  // At 66 voxels across, each covers a pixel or a little less.
  const double base = densities(66), doubled = densities(132), again = densities(264);
  std::printf(
      "densities read at a voxel a pixel: %.3g; at twice the resolution %.3f times that, at four times "
      "%.3f\n",
      base, doubled / base, again / base);
  EXPECT_LT(doubled, 1.4 * base);
  EXPECT_LT(again, 1.4 * doubled);
}

TEST(GlLevels, CpuAndGpuAgreeOnMixedLevels) {
  needContext();
  const BrickVolume bricks = cloudOf(160);
  ViewedScene view = viewFrom(4.0);
  view.camera.position = glm::dvec3(1.3, -0.2, 0.3);  // near its edge: far parts are coarser
  view.camera.fov = 1.5;
  const BrickLevels levels(bricks);
  LayoutOptions options;
  options.resolution = resolutionOf(view.camera, bricks, kHeight);
  for (const bool cached : {false, true}) {
    view.scene.march.lightCache = cached;
    const BrickLayout layout = layOut(levels, options);
    ASSERT_GE(layout.mostRise, 2);
    const BrickAtlas atlas(layout, nullptr, Filter::exact);
    const auto parity = [&](const std::vector<TextChange>& changes) {
      MarchPass pass(Filter::exact, changes);
      const auto parameters = marchParameters(view, bricks, layout.frame, kWidth, kHeight, 5, true);
      pass.setParameters(parameters);
      const Film film(kWidth, kHeight);
      pass.draw(atlas, film, {0.3f, 0.6f}, 2, {0, 0, kWidth, kHeight});
      const Picture gpu = film.read().picture;
      const auto cpu = marchPicture(layout, nullptr, parameters, kWidth, kHeight, {0.3f, 0.6f}, 2);
      std::vector<double> errors;
      for (size_t i = 0; i < cpu.size(); ++i) {
        if (cpu[i].transmittance.x == 1.0f && gpu.planes[4][i] == 1.0f) continue;
        const double a = double{cpu[i].radiance.y}, b = double{gpu.planes[1][i]};
        errors.push_back(std::abs(a - b) / std::max({a, b, 1e-3}));
      }
      EXPECT_GT(errors.size(), 1000u);
      std::sort(errors.begin(), errors.end());
      return errors[errors.size() * 99 / 100];
    };
    constexpr double kGate = 1e-4;
    const double error = parity({});
    std::printf("mixed levels: p99 of radiance %.3g\n", error);
    EXPECT_LE(error, kGate);
    EXPECT_GT(
        parity({{"shared/walk.glsl", "return wordIsEmpty(word) ? least : max(least, float(wordEdge(word)));",
                 "return least;"}}),
        kGate)
        << "steps are in voxels of the level being read";
    EXPECT_GT(parity({{"shared/march.glsl", "s.size = float(edge);", "s.size = 1.0f;"}}), kGate);
  }
}

TEST(GlLevels, MemoryKeepsToItsLimit) {
  needContext();
  const BrickVolume bricks = cloudOf(192);
  const ViewedScene view = viewFrom(3.0);
  MarchPass pass(Filter::hardware);
  constexpr int kLarge = 512;  // pixels, so that every voxel can be seen
  SeenVolume all(bricks, Filter::hardware);
  const BrickAtlas& whole = all.atlasFor(0, view, kLarge, kLarge, false);
  EXPECT_EQ(whole.layout().frame.level, 0);
  const Picture finest = render(pass, bricks, whole, view, 8).film.picture;
  const uint64_t needed = all.gpuBytes() + pass.gpuBytes();
  for (const uint64_t share : {2, 6}) {
    const GpuLimits limits{Film::bytesFor(kLarge, kLarge) + needed / share, 0};
    SeenVolume seen(bricks, Filter::hardware, limits);
    const BrickAtlas& atlas = seen.atlasFor(0, view, kLarge, kLarge, false);
    MarchPass less(Filter::hardware);
    const Picture picture = render(less, bricks, atlas, view, 8).film.picture;
    const Comparison error = comparePictures(picture, "limited", finest, "finest");
    std::printf("1/%d of the memory: voxels of up to %.3g pixels, %.3g of the bytes, relative RMSE %.3g\n",
                static_cast<int>(share), atlas.layout().pixels,
                static_cast<double>(seen.gpuBytes() + less.gpuBytes()) / static_cast<double>(needed),
                error.relativeRmse);
    EXPECT_LE(seen.gpuBytes() + less.gpuBytes(), needed / share + needed / 50)
        << "the sky's table and the jitter";
    EXPECT_GT(atlas.layout().pixels, 1.0);
    EXPECT_LT(error.relativeRmse, 0.15);
  }
  // Textures of 256 texels a side hold no light cache of such a grid at its finest.
  SeenVolume small(bricks, Filter::hardware, {0, 256});
  const BrickAtlas& atlas = small.atlasFor(0, view, kLarge, kLarge, false);
  EXPECT_GT(atlas.layout().pixels, 1.0);
  const Comparison error =
      comparePictures(render(pass, bricks, atlas, view, 8).film.picture, "small", finest, "finest");
  std::printf("textures of 256 texels: voxels of up to %.3g pixels, relative RMSE %.3g\n",
              atlas.layout().pixels, error.relativeRmse);
  EXPECT_LT(error.relativeRmse, 0.2);
  SeenVolume none(bricks, Filter::hardware, {1000, 0});
  EXPECT_THROW(none.atlasFor(0, view, kLarge, kLarge, false), InputError);
}

/// So dense that pictures at rest march for their light.
ViewedScene denseView() {
  ViewedScene view = viewFrom(3.0);
  view.medium.sigmaS = {300.0, 300.0, 300.0};
  return view;
}

TEST(GlLevels, MemoryKeepsToItsLimitWhileMoving) {
  needContext();
  const BrickVolume bricks = cloudOf(192);
  const ViewedScene view = denseView();
  ViewedScene moving = view;
  moving.scene.march = movingMarch(moving.scene.march, 1.0);
  constexpr int kLarge = 512;
  const auto bytesUnder = [&](uint64_t limit, bool moves) {
    SeenVolume seen(bricks, Filter::hardware, {limit, 0}, moves);
    MarchPass pass(Filter::hardware);
    const BrickAtlas& atlas = seen.atlasFor(0, view, kLarge, kLarge, false);
    if (moves) render(pass, bricks, atlas, moving, 1);
    render(pass, bricks, atlas, view, 1);
    return seen.gpuBytes() + pass.gpuBytes();
  };
  const uint64_t resting = bytesUnder(0, false), films = 2 * Film::bytesFor(kLarge, kLarge);
  EXPECT_GT(bytesUnder(0, true), resting) << "there was nothing to count";
  EXPECT_LE(bytesUnder(films + resting, true), resting);
}

TEST(GlLevels, ColumnsInBytesDifferLittleFromHalves) {
  needContext();
  const BrickVolume bricks = cloudOf(96);
  const BrickAtlas atlas(bricks, Filter::hardware, Texel::r16f);
  ViewedScene bytes = denseView(), halves = bytes;
  bytes.scene.octaves.count = halves.scene.octaves.count = 5;  // which see deeper
  bytes.scene.march = movingMarch(bytes.scene.march, 1.0);
  halves.scene.march = bytes.scene.march;
  halves.scene.march.cacheDepth = 1e3;  // the cache is good enough for all
  MarchPass inBytes(Filter::hardware), inHalves(Filter::hardware);
  const Picture a = render(inBytes, bricks, atlas, bytes).film.picture;
  const Picture b = render(inHalves, bricks, atlas, halves).film.picture;
  const Comparison error = comparePictures(a, "bytes", b, "halves");
  std::printf("columns in bytes: relative RMSE %.3g, bias %.3g, %.3g of the pass's memory\n",
              error.relativeRmse, error.bias,
              static_cast<double>(inBytes.gpuBytes()) / static_cast<double>(inHalves.gpuBytes()));
  EXPECT_LT(inBytes.gpuBytes(), inHalves.gpuBytes());
  EXPECT_LT(error.relativeRmse, 0.01);
  EXPECT_LT(std::abs(error.bias), 0.002);
}

TEST(GlLevels, AOneInAHundredGridTakesAFewPercentOfItsDenseTexture) {
  needContext();
  constexpr int kEdge = 320, kBalls = 5;
  // Four balls in corners and one in the middle hold 1% together.
  const double radius = kEdge * std::cbrt(0.01 / (kBalls * 4.18879020478639));  // 4π/3
  const BrickVolume bricks =
      volumeOf(glm::ivec3(kEdge), glm::ivec3(0), glm::dmat4(1.0), [&](const glm::dvec3& p) {
        for (const glm::dvec3& at : {glm::dvec3(0, 0, 0), {1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}) {
          const glm::dvec3 centre = 0.5 * kEdge + at * (0.5 * kEdge - radius - 1.0);
          const double depth = radius - glm::length(p - centre);
          if (depth > 0.0) return 0.3 + 0.7 * std::abs(std::sin(0.2 * p.x + 0.3 * p.y + 0.1 * p.z));
        }
        return 0.0;
      });
  ViewedScene view = viewFrom(3.0);
  view.camera.target = glm::dvec3(0.5 * kEdge);
  view.camera.position = glm::dvec3(0.5 * kEdge, -0.3 * kEdge, 0.5 * kEdge);
  for (const Texel texel : {Texel::r16f, Texel::r32f}) {
    MarchPass pass(Filter::hardware);
    const BrickAtlas atlas(bricks, Filter::hardware, texel);
    render(pass, bricks, atlas, view, 1);
    const double dense = std::pow(double{kEdge}, 3.0) * static_cast<double>(bytesOf(texel));
    const double share = static_cast<double>(atlas.gpuBytes() + pass.gpuBytes()) / dense;
    std::printf("1%% full, %s: %.3g%% of the dense texture\n", std::string(nameOf(texel)).c_str(),
                100.0 * share);
    EXPECT_LT(share, 0.05);
  }
}

}  // namespace
}  // namespace nephele::testing_gl
