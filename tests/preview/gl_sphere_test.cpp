// The homogeneous sphere on the GPU against the exact integral of its grid and against Beer–Lambert along the
// chord.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/preview/gl_bench.h"

namespace nephele::testing_gl {

double exactColumn(const BrickVolume& bricks, const WorldRay& ray) {
  const glm::dmat4 indexFromWorld = glm::inverse(bricks.worldFromIndex);
  const glm::dvec3 o(indexFromWorld * glm::dvec4(ray.origin, 1.0)),
      d(indexFromWorld * glm::dvec4(ray.direction, 0.0));
  double near = 0.0, far = 1e30;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = bricks.activeMin[axis] - 1 - o[axis], hi = bricks.activeMax[axis] - o[axis];
    if (d[axis] == 0.0) {
      if (lo > 0.0 || hi < 0.0) return 0.0;
      continue;
    }
    near = std::max(near, std::min(lo / d[axis], hi / d[axis]));
    far = std::min(far, std::max(lo / d[axis], hi / d[axis]));
  }
  if (!(far > near)) return 0.0;
  std::vector<double> cuts{near, far};
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) continue;
    for (int plane = bricks.activeMin[axis]; plane < bricks.activeMax[axis]; ++plane) {
      const double t = (plane - o[axis]) / d[axis];
      if (t > near && t < far) cuts.push_back(t);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  double column = 0.0;
  for (size_t i = 1; i < cuts.size(); ++i) {
    const double half = 0.5 * (cuts[i] - cuts[i - 1]), middle = 0.5 * (cuts[i] + cuts[i - 1]);
    for (double node : {-1.0, 1.0})
      column += half * densityAt(bricks, o + (middle + node * half / std::sqrt(3.0)) * d);
  }
  return column;
}

namespace {

TEST(GlSphere, TransmittanceIsTheGridsOwnAndTheChordsWithinTheRim) {
  needContext();
  constexpr double kVoxel = 0.01, kRadius = 100.0 * kVoxel, kSigmaT = 4.0 / (2.0 * kRadius);
  constexpr int kSide = 210, kPicture = 160;
  const glm::dvec3 centreIndex(104.3, 104.6, 104.1);
  glm::dmat4 worldFromIndex(kVoxel);
  worldFromIndex[3][3] = 1.0;
  const BrickVolume bricks = volumeOf(
      glm::ivec3(kSide), glm::ivec3(0), worldFromIndex,
      [&](const glm::dvec3& p) { return std::clamp(100.5 - glm::length(p - centreIndex), 0.0, 1.0); });
  const glm::dvec3 centre = kVoxel * centreIndex;
  ViewedScene view;
  view.camera.target = centre;
  view.camera.position = centre + 4.0 * glm::normalize(glm::dvec3(1.5, -4.0, 1.3));
  view.camera.fov = 2.0 * std::asin(1.06 / 4.0);
  view.medium = {{kSigmaT, kSigmaT, kSigmaT}, {0.0, 0.0, 0.0}, 0.0};
  view.scene.lights.clear();
  view.scene.march.adaptive = false;
  MarchPass pass(Filter::exact);
  pass.setParameters(marchParameters(view, bricks, kPicture, kPicture, 0, true));
  const Picture picture = marchOnGpu(pass, bricks, kPicture, kPicture, {0.5f, 0.5f}, 0).picture;
  const std::vector<float>& transmittance =
      picture.planes[static_cast<size_t>(picture.find("transmittance.R"))];

  constexpr int kBins = 22;  // of r/R, 0.05 wide
  std::array<double, kBins> rim{};
  double worstGrid = 0.0, worstChord = 0.0;
  for (int y = 0; y < kPicture; ++y) {
    for (int x = 0; x < kPicture; ++x) {
      const WorldRay ray = cameraRay(view.camera, kPicture, kPicture, x + 0.5, y + 0.5);
      const double actual = double{transmittance[static_cast<size_t>(y * kPicture + x)]};
      worstGrid = std::max(worstGrid, std::abs(actual - std::exp(-kSigmaT * exactColumn(bricks, ray))));
      const double impact = glm::length(glm::cross(centre - ray.origin, ray.direction)) / kRadius;
      const double chord = impact < 1.0 ? 2.0 * kRadius * std::sqrt(1.0 - impact * impact) : 0.0;
      const double error = std::abs(actual - std::exp(-kSigmaT * chord));
      if (impact < 0.9) worstChord = std::max(worstChord, error);
      const size_t bin = static_cast<size_t>(impact / 0.05);
      if (bin < kBins) rim[bin] = std::max(rim[bin], error);
    }
  }
  std::printf("sphere R = 100 voxels, depth 4: against the grid %.3g, against the chord within 0.9 R %.3g\n",
              worstGrid, worstChord);
  std::printf("largest error against the chord by r/R:");
  for (int bin = 0; bin < kBins; ++bin)
    std::printf(" %.2f: %.2g", 0.05 * (bin + 0.5), rim[static_cast<size_t>(bin)]);
  std::printf("\n");
  EXPECT_LT(worstGrid, 1e-3);
  EXPECT_LT(worstChord, 2e-3);
}

}  // namespace
}  // namespace nephele::testing_gl
