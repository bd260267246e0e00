// Files of every kind, from .vdb to picture: one voxel, tiles alone, half floats, five grids, rotated with
// unequal sides far from the origin. Depths along an axis through the middle are closed forms: samples that
// are trilinear between each other hold their sum.
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "base/error.h"
#include "preview/resolve.h"
#include "tests/preview/gl_bench.h"
#include "tests/scratch_folder.h"
#include "volume/vdb_file.h"

namespace nephele::testing_gl {
namespace {

constexpr double kVoxel = 0.25;
constexpr double kSigmaT = 1.5;

/// Writes one file of these grids and reads one of them back.
BrickVolume throughAFile(const openvdb::GridCPtrVec& grids, const std::string& name = {}) {
  const ScratchFolder folder;
  const std::string path = folder.file("kind.vdb");
  writeVdb(path, grids, {});
  return loadBricks(path, name);
}

/// A box of `edge` voxels from index 0 on, each of that density.
openvdb::FloatGrid::Ptr boxGrid(const char* name, int edge, float density) {
  auto grid = makeFogGrid(name, kVoxel, false);
  auto accessor = grid->getAccessor();
  for (int z = 0; z < edge; ++z)
    for (int y = 0; y < edge; ++y)
      for (int x = 0; x < edge; ++x) accessor.setValue({x, y, z}, density);
  return grid;
}

/// Optical depth that the picture's only pixel sees along the axis through the point `index`, the camera
/// `way` voxels before it. `worldFromIndex` is the test's own, not the file's.
double depthAlong(const BrickVolume& bricks, const glm::dmat4& worldFromIndex, const glm::dvec3& index,
                  int axis, double way) {
  glm::dvec3 start = index, aside(0.0);
  start[axis] -= way;
  aside[(axis + 1) % 3] = 1.0;
  Camera camera;
  camera.position = glm::dvec3(worldFromIndex * glm::dvec4(start, 1.0));
  camera.target = glm::dvec3(worldFromIndex * glm::dvec4(index, 1.0));
  camera.up = glm::dvec3(worldFromIndex * glm::dvec4(aside, 0.0));
  return -std::log(double{transmittanceOnGpu(bricks, camera, kSigmaT, 1, 1)[0]});
}

/// The same along all three axes, against σ Σρ times the voxel's side along each.
void expectDepths(const BrickVolume& bricks, const glm::dmat4& worldFromIndex, const glm::dvec3& index,
                  double sum, double way) {
  for (int axis = 0; axis < 3; ++axis) {
    const double exact = kSigmaT * sum * glm::length(glm::dvec3(worldFromIndex[axis]));
    EXPECT_NEAR(depthAlong(bricks, worldFromIndex, index, axis, way), exact, 2e-3 * exact) << axis;
  }
}

/// The whole picture as it is framed, against the integral along each ray: largest difference of
/// transmittance. A twentieth of the picture at least sees the medium.
double worstFramed(const BrickVolume& bricks) {
  constexpr int kWidth = 48, kHeight = 36, kLeastSeen = kWidth * kHeight / 20;
  constexpr double kSeen = 0.99;
  const Camera camera = frameCamera(bricks, {0.0, 0.0, 1.0}, 0.6, double{kWidth} / kHeight);
  const std::vector<float> marched = transmittanceOnGpu(bricks, camera, kSigmaT, kWidth, kHeight);
  double worst = 0.0;
  int seen = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double exact =
          std::exp(-kSigmaT * exactColumn(bricks, cameraRay(camera, kWidth, kHeight, x + 0.5, y + 0.5)));
      seen += exact < kSeen;
      worst = std::max(worst, std::abs(exact - double{marched[static_cast<size_t>(y * kWidth + x)]}));
    }
  EXPECT_GE(seen, kLeastSeen);
  return worst;
}

glm::dmat4 voxels() {
  glm::dmat4 result(kVoxel);
  result[3][3] = 1.0;
  return result;
}

TEST(GlFileKinds, OneVoxelHoldsItsDensity) {
  needContext();
  constexpr float kDensity = 4.0f;
  auto grid = makeFogGrid("density", kVoxel, false);
  grid->getAccessor().setValue({-3, 70, 11}, kDensity);
  const BrickVolume bricks = throughAFile({grid});
  EXPECT_EQ(bricks.activeVoxels, 1u);
  expectDepths(bricks, voxels(), {-3.0, 70.0, 11.0}, double{kDensity}, 20.0);
  // A quarter of a voxel beside it the tent stands at three quarters.
  const double beside = 0.75 * kSigmaT * double{kDensity} * kVoxel;
  EXPECT_NEAR(depthAlong(bricks, voxels(), {-2.75, 70.0, 11.0}, 1, 20.0), beside, 2e-3 * beside);
  EXPECT_LT(worstFramed(bricks), 1e-3);
}

TEST(GlFileKinds, TilesAloneCountThroughout) {
  needContext();
  constexpr float kDensity = 0.25f;
  constexpr int kTile = 8;
  auto grid = makeFogGrid("density", kVoxel, false);
  grid->fill(openvdb::CoordBBox({16, -8, 0}, {16 + kTile - 1, -1, kTile - 1}), kDensity);
  ASSERT_EQ(grid->tree().leafCount(), 0u);
  const BrickVolume bricks = throughAFile({grid});
  expectDepths(bricks, voxels(), {19.5, -4.5, 3.5}, double{kDensity} * kTile, 40.0);
  EXPECT_LT(worstFramed(bricks), 1e-3);
}

TEST(GlFileKinds, RotatedWithUnequalSidesFarFromTheOrigin) {
  needContext();
  constexpr int kEdge = 11;
  constexpr float kDensity = 0.5f;
  constexpr double kFar = 1e6;
  const double c = std::cos(0.7), s = std::sin(0.7);
  const glm::dmat4 worldFromIndex{{0.2 * c, 0.2 * s * 0.6, 0.2 * s * 0.8, 0.0},
                                  {-0.5 * s, 0.5 * c * 0.6, 0.5 * c * 0.8, 0.0},
                                  {0.0, -0.1 * 0.8, 0.1 * 0.6, 0.0},
                                  {kFar, -kFar, 2.0 * kFar, 1.0}};
  openvdb::Mat4d rows;  // OpenVDB multiplies from the left
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k) rows[i][k] = worldFromIndex[i][k];
  auto grid = boxGrid("density", kEdge, kDensity);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(rows));
  const BrickVolume bricks = throughAFile({grid});
  expectDepths(bricks, worldFromIndex, glm::dvec3(0.5 * (kEdge - 1)), double{kDensity} * kEdge, 40.0);
  EXPECT_LT(worstFramed(bricks), 1e-3);
}

TEST(GlFileKinds, HalfFloatsLookLikeTheirFloatSibling) {
  needContext();
  constexpr int kWidth = 64, kHeight = 48;
  const glm::dvec3 middle(15.5);
  std::array<Picture, 2> pictures;
  std::array<std::vector<float>, 2> samples;
  for (const bool half : {false, true}) {
    auto grid = makeFogGrid("density", kVoxel, half);
    auto accessor = grid->getAccessor();
    for (int z = 0; z < 32; ++z)
      for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
          if (const double value = cloudDensity(glm::dvec3(x, y, z), middle, 15.0); value > 0.0)
            accessor.setValue({x, y, z}, static_cast<float>(value));
    const BrickVolume bricks = throughAFile({grid});
    ViewedScene view;
    view.camera = frameCamera(bricks, {0.0, 0.0, 1.0}, 0.6, double{kWidth} / kHeight);
    view.medium.sigmaS = {kSigmaT, kSigmaT, kSigmaT};
    view.scene.march.adaptive = false;  // each step lit: which of several is drawn hangs on the last digits
    MarchPass pass(Filter::exact);
    pass.setParameters(marchParameters(view, bricks, kWidth, kHeight, 0, true));
    pictures[half] = marchOnGpu(pass, bricks, kWidth, kHeight, {0.5f, 0.5f}, 0).picture;
    samples[half] = bricks.samples;
  }
  ASSERT_EQ(samples[0].size(), samples[1].size());
  EXPECT_NE(samples[0], samples[1]) << "the file holds no halves";
  // A half errs by 2^-11 of a density, so transmittance by x e^-x of that at most: 1/e. Light comes through
  // the medium twice.
  constexpr double kHalf = 1.0 / 2048.0;
  const double alphaBound = kHalf / std::exp(1.0) + 1e-5;  // and floats along the way
  float brightest = 0.0f;
  for (const float value : pictures[0].planes[0]) brightest = std::max(brightest, value);
  ASSERT_GT(brightest, 0.0f);
  for (size_t plane = 0; plane < 4; ++plane)
    for (size_t i = 0; i < pictures[0].planes[plane].size(); ++i) {
      const double bound = plane == 3 ? alphaBound : 4.0 * kHalf * double{brightest};
      ASSERT_NEAR(pictures[0].planes[plane][i], pictures[1].planes[plane][i], bound) << plane;
    }
}

TEST(GlFileKinds, EachOfFiveGridsShowsOrSaysWhyNot) {
  needContext();
  constexpr int kEdge = 8;
  constexpr float kDensity = 0.5f, kSmoke = 0.125f, kHeat = 2.0f;
  const auto surface = boxGrid("surface", kEdge, 0.1f);
  surface->setGridClass(openvdb::GRID_LEVEL_SET);
  const auto velocity = makeVelocityGrid(kVoxel, false);
  velocity->getAccessor().setValue({1, 2, 3}, {1.0f, 0.0f, 0.0f});
  const openvdb::GridCPtrVec grids{surface, velocity, boxGrid("smoke", kEdge, kSmoke),
                                   boxGrid("density", kEdge, kDensity), boxGrid("temperature", kEdge, kHeat)};
  const glm::dvec3 middle(0.5 * (kEdge - 1));
  for (const auto& [name, density] :
       {std::pair{"", kDensity}, {"density", kDensity}, {"smoke", kSmoke}, {"temperature", kHeat}}) {
    SCOPED_TRACE(name);
    expectDepths(throughAFile(grids, name), voxels(), middle, double{density} * kEdge, 30.0);
  }
  for (const auto& [name, why] : {std::pair{"surface", "is a level set"}, {"vel", "vel"}, {"dust", "dust"}})
    try {
      throughAFile(grids, name);
      ADD_FAILURE() << name << " was read";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace nephele::testing_gl
