// Voxels that rays read: those, and no others than they need.
#include "volume/chord_voxels.h"

#include <gtest/gtest.h>

#include <glm/ext/matrix_transform.hpp>

#include "volume/bricks.h"

namespace nephele::test {
namespace {

constexpr int kEdge = 24;
constexpr double kVoxel = 0.1;

/// A cube of kEdge³ voxels from index 0, each of 1 or of what `value` says.
template <class Value>
BrickVolume cubeOf(const Value& value) {
  std::vector<float> values;
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) values.push_back(value(glm::ivec3(x, y, z)));
  return bricksFromDense(values, glm::ivec3(kEdge), glm::ivec3(0),
                         glm::scale(glm::dmat4(1.0), glm::dvec3(kVoxel)));
}

bool reads(const ChordVoxels& voxels, const glm::ivec3& at) {
  const auto mask = voxels.ofLeaf(at & ~7);
  const glm::ivec3 within = at & 7;
  return mask && ((*mask)[size_t(within.x)] >> (within.y * 8 + within.z) & 1) != 0;
}

TEST(ChordVoxels, AreAllThatDepthsHangOn) {
  const Chords chords = randomChords(glm::dvec3(0.0), glm::dvec3(kEdge * kVoxel), 20, 5);
  const ChordVoxels voxels(chords.lines, kVoxel, glm::dvec3(-1.0), glm::dvec3(kEdge * kVoxel + 1.0));
  const auto uneven = [](const glm::ivec3& at) { return float(1 + (at.x * 7 + at.y * 5 + at.z * 3) % 11); };
  int unread = 0;
  const BrickVolume masked = cubeOf([&](const glm::ivec3& at) {
    const bool read = reads(voxels, at);
    unread += !read;
    return read ? uneven(at) : 1e6f;
  });
  EXPECT_GT(unread, kEdge * kEdge * kEdge / 2);
  const std::vector<double> all = depthsAlong(cubeOf(uneven), chords.lines),
                            some = depthsAlong(masked, chords.lines);
  ASSERT_EQ(all.size(), some.size());
  for (size_t n = 0; n < all.size(); ++n) EXPECT_NEAR(some[n], all[n], 1e-6 * all[n]);
}

TEST(ChordVoxels, OfOneRayAlongAnAxisAreFourRowsWithinTheBox) {
  const double middle = 10.5 * kVoxel;
  const Chord along{{-5.0, middle, middle}, {5.0, middle, middle}};
  const ChordVoxels voxels(std::span(&along, 1), kVoxel, glm::dvec3(0.0), glm::dvec3(2.0));
  EXPECT_EQ(voxels.ofLeaf({-16, 8, 8}), std::nullopt);
  EXPECT_EQ(voxels.ofLeaf({24, 8, 8}), std::nullopt);
  EXPECT_EQ(voxels.ofLeaf({8, 0, 8}), std::nullopt);
  for (int x = 1; x < 20; ++x)
    for (int y = 8; y < 16; ++y)
      for (int z = 8; z < 16; ++z)
        EXPECT_EQ(reads(voxels, {x, y, z}), (y | 1) == 11 && (z | 1) == 11 && y >= 10);
}

TEST(ChordVoxels, LengthsInsideAreThoseWithDensity) {
  const BrickVolume cube = cubeOf([](const glm::ivec3&) { return 1.0f; });
  const double middle = 10.5 * kVoxel;
  const Chord along{{-5.0, middle, middle}, {5.0, middle, middle}};
  double inside = 0.0;
  depthsAlong(cube, std::span(&along, 1), &inside);
  // A voxel's worth beyond the outermost samples on either side.
  EXPECT_NEAR(inside, (kEdge + 1) * kVoxel, kDepthStepVoxels * kVoxel);
}

}  // namespace
}  // namespace nephele::test
