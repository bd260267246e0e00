// The path tracer's pictures against closed forms: single scattering, white furnace path by path, colours,
// placements, glowing media; the noise that it tells; the same picture on any number of threads.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <random>

#include "preview/truth/estimate.h"
#include "preview/truth/path_tracer.h"
#include "scene/blackbody.h"
#include "tests/preview/truth_bench.h"

namespace nephele {
namespace {

using namespace testing_truth;

constexpr double kPi = std::numbers::pi;

/// A slab across z: voxels three times as wide as thick, density 1 for 8 samples.
BrickVolume slab(double voxel) {
  const double wide = 3.0 * voxel;
  const glm::dmat4 transform(wide, 0, 0, 0, 0, wide, 0, 0, 0, 0, voxel, 0, -4 * wide, -4 * wide, 0, 1);
  return volumeOf({9, 9, 8}, {0, 0, 0}, transform, [](const glm::dvec3&) { return 1.0; });
}

TEST(TruthPicture, SingleScatteringInASlabHasItsClosedForms) {
  // With the sun behind the slab, light goes through all of it whatever the place of scattering: E p(1) τ
  // e^(−τ). With the sun behind the camera it goes twice through what lies before the place: E p(−1) (1 −
  // e^(−2τ))/2. Both hold for any density along the ray; eight samples and their ramps to 0 make 8 voxels.
  const BrickVolume bricks = slab(0.25);
  for (const double sigma : {0.01, 0.2, 1.0})
    for (const double g : {0.0, 0.5}) {
      const double depth = sigma * 8.0 * 0.25, albedo = 0.75, irradiance = 3.0;
      ViewedScene view =
          viewFrom({0, 0, -10}, {0, 0, 0}, 1e-4, mediumOf(albedo * sigma, (1.0 - albedo) * sigma, g));
      view.scene.lights = {sunFrom({0, 0, 1}, irradiance)};
      const auto phase = [g](double cosine) {
        return (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
      };
      const PictureRequest request = requestOf(16, 256, 0);
      const double behind = meanOf(plane(renderTruth(bricks, view, request), "R"));
      EXPECT_NEAR(behind / (albedo * irradiance * phase(1.0) * depth * std::exp(-depth)), 1.0, 0.01)
          << sigma << ' ' << g;
      view.scene.lights = {sunFrom({0, 0, -1}, irradiance)};
      const Picture front = renderTruth(bricks, view, request);
      const double expected = albedo * irradiance * phase(-1.0) * 0.5 * -std::expm1(-2.0 * depth);
      EXPECT_NEAR(meanOf(plane(front, "R")) / expected, 1.0, 0.01) << sigma << ' ' << g;
      EXPECT_NEAR(meanOf(plane(front, "A")), -std::expm1(-depth), 0.002) << sigma << ' ' << g;
    }
}

TEST(TruthPicture, SingleScatteringThroughTheSideOfABoxHasItsIntegral) {
  // Camera along +z, sun from +x: scattering at depth z is lit through half of the cube at the density there,
  // E p(0) ∫ σ ρ(z) e^(−σ ∫ρ) e^(−σ ρ(z) a/2) dz with a the edge; ρ is 1 but for the ramps of one voxel at
  // both faces.
  constexpr int kSide = 96;
  const double voxel = 1.0 / kSide, sigma = 4.0;
  const glm::dmat4 transform(voxel, 0, 0, 0, 0, voxel, 0, 0, 0, 0, voxel, 0, 0, 0, 0, 1);
  const BrickVolume bricks =
      volumeOf({kSide, kSide, kSide}, {0, 0, 0}, transform, [](const glm::dvec3&) { return 1.0; });
  const double centre = 0.5 * (kSide - 1) * voxel;
  ViewedScene view = viewFrom({centre, centre, -3}, {centre, centre, 0}, 1e-4, mediumOf(sigma, 0.0, 0.0));
  view.scene.lights = {sunFrom({1, 0, 0}, 2.0)};
  constexpr int kSteps = 100000;
  double expected = 0.0, column = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = (i + 0.5) / kSteps * (kSide + 1),
                 dz = (kSide + 1) * voxel / kSteps;  // voxels; world units
    const double rho = std::min({z, kSide + 1.0 - z, 1.0});
    column += 0.5 * rho * dz;
    expected += 2.0 / (4.0 * kPi) * sigma * rho * std::exp(-sigma * (column + 0.5 * rho)) * dz;
    column += 0.5 * rho * dz;
  }
  EXPECT_NEAR(meanOf(plane(renderTruth(bricks, view, requestOf(16, 256, 0)), "G")) / expected, 1.0, 0.01);
}

TEST(TruthPicture, APointLightFallsWithTheSquareOfItsDistance) {
  const BrickVolume bricks = slab(1e-4);  // of optical depth 8e-4
  const auto radiance = [&](double distance) {
    ViewedScene view = viewFrom({0, 0, -1}, {0, 0, 0}, 1e-6, mediumOf(1.0, 0.0, 0.0));
    view.scene.lights = {PointLight{{0, distance, 0.0}, {5, 5, 5}}};
    return meanOf(plane(renderTruth(bricks, view, requestOf(4, 64, 0)), "B"));
  };
  EXPECT_NEAR(radiance(1.0) / radiance(2.0), 4.0, 0.1);
}

TEST(TruthFurnace, WithoutLightSamplingEveryPathReturnsOne) {
  const BrickVolume bricks = smallCloud();
  ViewedScene view = viewFrom({0, -4, 0}, {0, 0, 0}, 0.5, mediumOf(6.0, 0.0, 0.6));
  view.scene.environment.constant = {1, 1, 1};
  const truth::TrackedMedium medium = [&] {
    truth::TrackedMedium made;
    made.bricks = &bricks;
    made.sigmaS = made.sigmaT = glm::vec3(6.0f);
    made.sigmaMax = 6.0f;
    made.worldFromIndex = glm::mat3(glm::dmat3(bricks.worldFromIndex));
    made.indexFromWorld = glm::inverse(made.worldFromIndex);
    made.grid = truth::buildControlGrid(bricks, 6.0);
    return made;
  }();
  const truth::LightSources lights(view, medium, glm::dvec3(0.0));
  const truth::PathTracer tracer(medium, {0.6f, 0.0f, 0.0f}, lights, {-1, false});
  uint64_t looks = 0;
  truth::Random random(1);
  const glm::vec3 along = glm::normalize(glm::vec3(0.1f, 1.0f, 0.2f));
  const truth::TrackedRay ray{glm::vec3(16.0f, 4.0f, 15.0f), medium.indexFromWorld * along};
  int scattered = 0;
  for (uint32_t i = 0; i < 2000; ++i) {
    const truth::PathSample sample = tracer.trace(ray, along, {i, 1}, random, looks);
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(double{sample.radiance[c] + sample.transmittance[c]}, 1.0, 1e-5) << "path " << i;
    scattered += sample.taken > 0.0f ? 1 : 0;
  }
  EXPECT_GT(scattered, 500);
}

TEST(TruthPicture, ChannelsOfAColouredMediumAreThoseOfGreyOnes) {
  const BrickVolume bricks = smallCloud();
  ViewedScene view = viewFrom({0, -4, 0}, {0, 0, 0}, 0.5, {{6.0, 2.0, 0.5}, {0.0, 1.0, 4.0}, 0.3});
  view.scene.lights = {sunFrom({0.5, -1, 0.5}, 3.0), PointLight{{0, 0, 2}, {1, 2, 3}}};
  view.scene.environment.constant = {0.2, 0.3, 0.4};
  const Picture coloured = renderTruth(bricks, view, requestOf(16, 256, 3));
  for (size_t c = 0; c < 3; ++c) {
    ViewedScene grey = view;
    grey.medium = mediumOf(view.medium.sigmaS[c], view.medium.sigmaA[c], 0.3);
    const Picture one = renderTruth(bricks, grey, requestOf(16, 256, 3));
    EXPECT_NEAR(meanOf(coloured.planes[c]) / meanOf(one.planes[c]), 1.0, 0.01) << "channel " << c;
    EXPECT_NEAR(meanOf(coloured.planes[4 + c]) / meanOf(one.planes[4 + c]), 1.0, 0.003) << "channel " << c;
  }
}

TEST(TruthPicture, PlaceScaleAndTurnOfTheWorldDoNotMatter) {
  const BrickVolume bricks = smallCloud();
  ViewedScene view = viewFrom({1, -4, 1}, {0, 0, 0}, 0.5, mediumOf(6.0, 0.5, 0.3));
  view.scene.lights = {sunFrom({0.5, -1, 0.5}, 3.0), PointLight{{0.2, 0.3, 1.8}, {2, 2, 2}}};
  const Picture expected = renderTruth(bricks, view, requestOf(16, 64, 1));
  const glm::dmat4 one(1.0);
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, 3));
  const std::pair<const char*, glm::dmat4> moves[] = {{"far away", glm::translate(one, {1e7, -2e7, 3e7})},
                                                      {"turned", glm::rotate(one, 1.0, axis)},
                                                      {"small", glm::scale(one, glm::dvec3(1e-6))},
                                                      {"large", glm::scale(one, glm::dvec3(1e6))}};
  for (const auto& [name, matrix] : moves) {
    const glm::dmat4& move = matrix;  // clang 14 captures no structured binding
    const auto place = [&](const glm::dvec3& p) { return glm::dvec3(move * glm::dvec4(p, 1.0)); };
    const auto turn = [&](const glm::dvec3& d) { return glm::normalize(glm::dmat3(move) * d); };
    const double scale = glm::length(glm::dmat3(move) * glm::dvec3(1, 0, 0));
    BrickVolume moved = bricks;
    moved.worldFromIndex = move * bricks.worldFromIndex;
    ViewedScene there = view;
    there.camera = {place(view.camera.position), place(view.camera.target), turn(view.camera.up),
                    view.camera.fov};
    there.medium = mediumOf(6.0 / scale, 0.5 / scale, 0.3);
    there.scene.lights = {
        sunFrom(turn({0.5, -1, 0.5}), 3.0),
        PointLight{place({0.2, 0.3, 1.8}), {2 * scale * scale, 2 * scale * scale, 2 * scale * scale}}};
    const Picture picture = renderTruth(moved, there, requestOf(16, 64, 1));
    for (const char* name_of_plane : {"R", "A"})
      EXPECT_NEAR(meanOf(plane(picture, name_of_plane)) / meanOf(plane(expected, name_of_plane)), 1.0, 0.01)
          << name << ' ' << name_of_plane;
  }
}

TEST(TruthPicture, IsTheSameOnAnyNumberOfThreads) {
  const BrickVolume bricks = smallCloud();
  ViewedScene view = viewFrom({0, -4, 0}, {0, 0, 0}, 0.5, mediumOf(6.0, 0.5, 0.3));
  view.scene.lights = {sunFrom({0.5, -1, 0.5}, 3.0)};
  view.scene.environment.constant = {0.2, 0.3, 0.4};
  const PictureRequest request = requestOf(40, 4, 2);
  const auto renderWith = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return renderTruth(bricks, view, request);
  };
  const Picture one = renderWith(1), many = renderWith(7);
  EXPECT_EQ(one.names, many.names);
  EXPECT_EQ(one.planes, many.planes);
  PictureRequest other = request;
  other.seed = 1;
  EXPECT_NE(renderTruth(bricks, view, other).planes[0], one.planes[0]);
}

TEST(TruthPicture, HalvesAreIndependentAndMakeTheWhole) {
  const BrickVolume bricks = smallCloud();
  ViewedScene view = viewFrom({0, -4, 0}, {0, 0, 0}, 0.4, mediumOf(6.0, 0.5, 0.3));
  view.scene.lights = {sunFrom({0.5, -1, 0.5}, 3.0)};
  const Picture picture = renderTruth(bricks, view, requestOf(16, 64, 1));
  const Picture truth = renderTruth(bricks, view, requestOf(16, 1024, 1));
  double product = 0.0, square = 0.0;
  for (size_t i = 0; i < picture.planes[0].size(); ++i) {
    const double a = double{plane(picture, "half1.R")[i]}, b = double{plane(picture, "half2.R")[i]};
    ASSERT_NEAR(double{picture.planes[0][i]}, 0.5 * (a + b), 1e-5);
    const double r = double{truth.planes[0][i]};
    product += (a - r) * (b - r);
    square += 0.5 * ((a - r) * (a - r) + (b - r) * (b - r));
  }
  // Uncorrelated but for the noise of `truth`, which both share: 1/16 of the halves' variance times two.
  EXPECT_LT(std::abs(product), 0.2 * square);
}

/// A cube of 16³ voxels of side 0.25 and density 2 about the origin, of `kelvin` throughout.
BrickVolume hotCube(double kelvin) {
  glm::dmat4 place(0.25);
  place[3] = glm::dvec4(-1.875, -1.875, -1.875, 1.0);  // samples 0 to 15
  BrickVolume bricks = volumeOf(glm::ivec3(16), glm::ivec3(0), place, [](const glm::dvec3&) { return 2.0; });
  glm::dmat4 hotPlace(0.5);  // coarser, elsewhere in its index, around the whole cube
  hotPlace[3] = glm::dvec4(7.0, -9.0, 2.5, 1.0);
  const glm::ivec3 first(glm::round(glm::dvec3(glm::inverse(hotPlace) * glm::dvec4(-3.0, -3.0, -3.0, 1.0))));
  bricks.temperature = std::make_shared<const BrickVolume>(
      volumeOf(glm::ivec3(13), first, hotPlace, [kelvin](const glm::dvec3&) { return 1e-3 * kelvin; }));
  return bricks;
}

constexpr double kKelvin = 2600.0, kGlow = 3.0;

ViewedScene hotView(const glm::dvec3& from, const Medium& medium) {
  ViewedScene view = viewFrom(from, from + glm::dvec3(0, 1, 0), 0.01, medium);
  view.scene.emission.temperatureScale = 1000.0;
  view.scene.emission.scale = kGlow;
  return view;
}

TEST(TruthPicture, AGlowingBoxHasItsClosedForm) {
  // σ_a B (1 − e^(−σ_t d))/σ_t, without scattering; faces fall off over a voxel each: columns are exact.
  ViewedScene view = hotView({0.1, -30, -0.2}, mediumOf(0.0, 0.0, 0.0));
  view.medium.sigmaA = {0.05, 0.2, 0.6};
  const auto hot = blackbodyRadiance(kKelvin);
  const Picture picture = renderTruth(hotCube(kKelvin), view, requestOf(8, 1024));
  for (size_t c = 0; c < 3; ++c) {
    const double column = 2.0 * 16.0 * 0.25;
    const double expected = kGlow * hot[c] * (1.0 - std::exp(-view.medium.sigmaA[c] * column));
    EXPECT_NEAR(meanOf(picture.planes[c]) / expected, 1.0, 5e-3) << c;
  }
  // One scattering takes σ_s out of the way and brings only light that was emitted elsewhere.
  view.medium = mediumOf(0.0, 0.2, 0.0);
  const double absorbing = meanOf(renderTruth(hotCube(kKelvin), view, requestOf(8, 256)).planes[0]);
  view.scene.emission.on = false;
  EXPECT_EQ(meanOf(renderTruth(hotCube(kKelvin), view, requestOf(8, 16)).planes[0]), 0.0);
  EXPECT_GT(absorbing, 0.0);
}

TEST(TruthPicture, InsideAThickHotMediumAllIsBlackBody) {
  // Kirchhoff: where nothing leaves, radiance is the black body's, whatever is scattered. 60 optical depths.
  const auto hot = blackbodyRadiance(kKelvin);
  for (const double albedo : {0.0, 0.5, 0.9}) {
    const ViewedScene view = hotView({0, 0, 0}, mediumOf(15.0 * albedo, 15.0 * (1.0 - albedo), 0.4));
    const Picture picture = renderTruth(hotCube(kKelvin), view, requestOf(8, 256));
    for (size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(meanOf(picture.planes[c]) / (kGlow * hot[c]), 1.0, 0.01) << albedo;
  }
  const ViewedScene scattering = hotView({0, 0, 0}, mediumOf(7.5, 7.5, 0.4));
  const Picture direct = renderTruth(hotCube(kKelvin), scattering, requestOf(8, 256, 0));
  // No more than one scattering: ½ is emitted at the first place, ¼ before the second.
  EXPECT_NEAR(meanOf(direct.planes[0]) / (kGlow * hot[0]), 0.75, 0.01);
}

TEST(TruthPicture, TheNoisesBoundIsSeldomExceeded) {
  constexpr int kTrials = 2000, kSize = 8;
  constexpr unsigned kBlocks = 8;
  constexpr double kNoise = 0.2;
  std::mt19937_64 numbers(7);
  std::normal_distribution<double> normal(1.0, kNoise);
  int aboveEstimate = 0, aboveBound = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    truth::Estimate estimate(kSize, kSize);
    for (size_t pixel = 0; pixel < size_t{kSize} * kSize; ++pixel)
      for (unsigned block = 0; block < kBlocks; ++block) {
        truth::BlockMean mean;
        for (int c = 0; c < 3; ++c) {
          mean.radiance[c] = static_cast<float>(normal(numbers));
          mean.transmittance[c] = 0.0f;
        }
        estimate.add(pixel, mean);
      }
    const Picture picture = estimate.picture();
    double error = 0.0;
    for (size_t c = 0; c < 3; ++c) {
      double squares = 0.0;
      for (const float value : picture.planes[c]) squares += (double{value} - 1.0) * (double{value} - 1.0);
      error += std::sqrt(squares / (kSize * kSize)) / 3.0;
    }
    aboveEstimate += error > estimate.relativeError() ? 1 : 0;
    aboveBound += error > estimate.relativeErrorBound() ? 1 : 0;
  }
  EXPECT_GT(aboveEstimate, kTrials / 3);
  EXPECT_LT(aboveBound, kTrials / 40);  // 2.5% for one channel; the mean of three scatters less
}

TEST(TruthPicture, StopsAtTheErrorAskedFor) {
  const BrickVolume bricks = smallCloud();
  ViewedScene view = viewFrom({0, -4, 0}, {0, 0, 0}, 0.5, mediumOf(6.0, 0.5, 0.3));
  view.scene.lights = {sunFrom({0.5, -1, 0.5}, 3.0)};
  PictureRequest request = requestOf(16, 1, 0);
  request.error = 0.02;
  const auto method = makeReferenceMethod({});
  method->setVolume(bricks);
  PictureCost cost;
  method->render(view, request, cost);
  EXPECT_LE(cost.relativeError, 0.02);
  EXPECT_GT(cost.relativeError, 0.005);
}

TEST(TruthPicture, EmptyAndClearMediaShowNothing) {
  const BrickVolume empty =
      volumeOf({4, 4, 4}, {0, 0, 0}, glm::dmat4(1.0), [](const glm::dvec3&) { return 0.0; });
  const BrickVolume full =
      volumeOf({4, 4, 4}, {0, 0, 0}, glm::dmat4(1.0), [](const glm::dvec3&) { return 1.0; });
  ViewedScene view = viewFrom({0, -9, 0}, {1, 1, 1}, 0.5, mediumOf(6.0, 0.5, 0.3));
  view.scene.lights = {sunFrom({0.5, -1, 0.5}, 3.0)};
  ViewedScene clear = view;
  clear.medium = mediumOf(0.0, 0.0, 0.0);
  for (const Picture& picture :
       {renderTruth(empty, view, requestOf(4, 4)), renderTruth(full, clear, requestOf(4, 4))}) {
    EXPECT_EQ(meanOf(plane(picture, "R")), 0.0);
    EXPECT_EQ(meanOf(plane(picture, "A")), 0.0);
    EXPECT_EQ(meanOf(plane(picture, "transmittance.G")), 1.0);
  }
}

}  // namespace
}  // namespace nephele
