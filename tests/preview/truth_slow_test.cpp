// What must be exactly true of the path tracer and takes some seconds to show: the white furnace with light
// sampling, and Chandrasekhar's half-space.
#include <gtest/gtest.h>

#include "scene/sky.h"
#include "tests/preview/truth_bench.h"

namespace nephele {
namespace {

using namespace testing_truth;

constexpr double kPi = std::numbers::pi;

TEST(TruthSlow, WhiteFurnaceWithLightSampling) {
  const BrickVolume bricks = smallCloud();
  ViewedScene view = viewFrom({0, -4, 0}, {0, 0, 0}, 0.5, mediumOf(6.0, 0.0, 0.6));
  view.scene.lights.clear();
  view.scene.environment.constant = {1, 1, 1};
  const Picture picture = renderTruth(bricks, view, requestOf(64, 256));
  double sum = 0.0;
  int inside = 0, outside = 0;
  for (size_t i = 0; i < picture.planes[0].size(); ++i) {
    // Where no sample met the medium the interval has no width and the sum is exactly 1.
    const double shown = double{plane(picture, "R")[i]} + double{plane(picture, "transmittance.R")[i]};
    const double alpha = double{plane(picture, "A")[i]};
    sum += shown / static_cast<double>(picture.planes[0].size());
    if (!(alpha > 0.0)) continue;
    ++inside;
    // The interval is of the radiance; in a furnace radiance equals alpha, which has noise of its own.
    outside += std::abs(shown - 1.0) > double{plane(picture, "interval.R")[i]} ? 1 : 0;
  }
  std::printf("white furnace: mean %.5f, %d of %d pixels outside their interval\n", sum, outside, inside);
  EXPECT_NEAR(sum, 1.0, 1e-3);
  EXPECT_GT(inside, 1000);
  EXPECT_LE(outside, 0.07 * inside);
}

TEST(TruthSlow, FurnaceUnderARampIsTheMeanOfBothSamplings) {
  // Under an uneven sky the two ways to find it must agree: with multiple importance sampling, and by chance
  // alone (radiance through an almost clear medium is then the sky's mean over the phase function).
  const BrickVolume bricks = smallCloud();
  ViewedScene view = viewFrom({0, -4, 0}, {0, 0, 0}, 0.5, mediumOf(1e-3, 0.0, 0.0));
  view.scene.environment.kind = Environment::Kind::ramp;
  const Picture picture = renderTruth(bricks, view, requestOf(32, 256));
  constexpr int kRows = 4000;
  glm::dvec3 mean(0.0);
  for (int i = 0; i < kRows; ++i) {
    const double sine = (2.0 * i + 1.0) / kRows - 1.0;
    mean += skyRadiance(view.scene.environment, nullptr, view.up, {std::sqrt(1.0 - sine * sine), 0.0, sine}) /
            double{kRows};
  }
  for (int c = 0; c < 3; ++c) {
    const double alpha = meanOf(plane(picture, "A")), light = meanOf(picture.planes[static_cast<size_t>(c)]);
    EXPECT_NEAR(light / alpha / mean[c], 1.0, 0.01) << "channel " << c;
  }
}

/// Chandrasekhar's H for isotropic scattering of albedo w, at `mu`: 1/H(μ) = √(1 − w) + w/2 ∫ μ' H(μ')/(μ +
/// μ') dμ', solved by iteration on midpoints.
class ChandrasekharH {
 public:
  explicit ChandrasekharH(double albedo) : albedo_(albedo), values_(kNodes, 1.0) {
    for (int iteration = 0; iteration < 500; ++iteration) {
      std::vector<double> next(kNodes);
      for (int i = 0; i < kNodes; ++i) next[static_cast<size_t>(i)] = at(node(i));
      values_ = std::move(next);
    }
  }
  double at(double mu) const {
    double integral = 0.0;
    for (int i = 0; i < kNodes; ++i)
      integral += node(i) * values_[static_cast<size_t>(i)] / (mu + node(i)) / kNodes;
    return 1.0 / (std::sqrt(1.0 - albedo_) + 0.5 * albedo_ * integral);
  }

 private:
  static constexpr int kNodes = 400;
  static double node(int i) { return (i + 0.5) / kNodes; }
  double albedo_;
  std::vector<double> values_;
};

TEST(TruthSlow, ChandrasekharsHalfSpace) {
  // 40 optical depths deep and 480 wide, in tiles of constant density: what leaves at the far sides does not
  // come back.
  constexpr int kWide = 240, kDeep = 40;
  const glm::dmat4 transform(2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, -kWide, -kWide, -kDeep, 1);
  const BrickVolume bricks =
      volumeOf({kWide, kWide, kDeep}, {0, 0, 0}, transform, [](const glm::dvec3&) { return 1.0; });
  const double irradiance = 2.0;
  for (const double albedo : {0.5, 0.9, 0.99}) {
    const ChandrasekharH h(albedo);
    for (const auto& [mu0, mu] : {std::pair(1.0, 1.0), std::pair(0.5, 0.8), std::pair(0.8, 0.35)}) {
      const glm::dvec3 toEye(std::sqrt(1.0 - mu * mu), 0.0, mu), toSun(0.0, std::sqrt(1.0 - mu0 * mu0), mu0);
      ViewedScene view = viewFrom(50.0 * toEye, {0, 0, 0}, 1e-3, mediumOf(albedo, 1.0 - albedo, 0.0));
      view.scene.lights = {sunFrom(toSun, irradiance)};
      const double found = meanOf(plane(renderTruth(bricks, view, requestOf(32, 256)), "R"));
      const double expected = irradiance * albedo / (4.0 * kPi) * mu0 / (mu + mu0) * h.at(mu) * h.at(mu0);
      std::printf("half-space, albedo %.2f, sun %.2f, eye %.2f: %.4f of Chandrasekhar's\n", albedo, mu0, mu,
                  found / expected);
      EXPECT_NEAR(found / expected, 1.0, 5e-3) << "albedo " << albedo << " mu0 " << mu0 << " mu " << mu;
    }
  }
}

}  // namespace
}  // namespace nephele
