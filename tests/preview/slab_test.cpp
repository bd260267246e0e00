// The slab test on the cases that break careless ones (MODEL.md, section 2): signed zeros, denormals, faces,
// edges.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shaders/shared/leaves.h"

namespace nephele::shared {
namespace {

constexpr float kDenormal = 1e-42f;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Interval {
  bool hit;
  double near, far;
};

/// The mathematical interval of t ≥ 0 inside the closed box, in double; a component of 0 decides by the
/// origin.
Interval exactInterval(const vec3& origin, const vec3& direction, const vec3& low, const vec3& high) {
  double near = 0.0, far = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = double{origin[axis]}, d = double{direction[axis]};
    const double lo = double{low[axis]}, hi = double{high[axis]};
    if (d == 0.0) {
      if (o < lo || o > hi) return {false, 0.0, 0.0};
      continue;
    }
    near = std::max(near, std::min((lo - o) / d, (hi - o) / d));
    far = std::min(far, std::max((lo - o) / d, (hi - o) / d));
  }
  return {far > near, near, far};
}

void expectExact(const vec3& origin, const vec3& direction) {
  const vec3 low(0.0f), high(8.0f, 16.0f, 24.0f);
  const Interval expected = exactInterval(origin, direction, low, high);
  float near = -1.0f, far = -1.0f;
  const bool hit = intersectBox(origin, direction, low, high, near, far);
  SCOPED_TRACE(testing::Message() << "origin " << origin.x << ' ' << origin.y << ' ' << origin.z
                                  << ", direction " << direction.x << ' ' << direction.y << ' '
                                  << direction.z);
  EXPECT_EQ(hit, expected.hit);
  EXPECT_FALSE(std::isnan(near) || std::isnan(far));
  if (!hit || !expected.hit) return;
  EXPECT_NEAR(double{near}, expected.near, 1e-5);
  EXPECT_NEAR(double{far} / expected.far, 1.0, 1e-6);
}

TEST(Slab, AxisAlignedWithZerosOfBothSigns) {
  for (float a : {0.0f, -0.0f, kDenormal, -kDenormal})
    for (float b : {0.0f, -0.0f, kDenormal, -kDenormal})
      for (float sign : {1.0f, -1.0f}) {
        expectExact(vec3(4.0f - 9.0f * sign, 5.0f, 6.0f), vec3(sign, a, b));
        expectExact(vec3(4.0f, 8.0f - 20.0f * sign, 6.0f), vec3(a, sign, b));
        expectExact(vec3(4.0f, 5.0f, 12.0f - 30.0f * sign), vec3(a, b, sign));
        expectExact(vec3(-9.0f, 17.0f, 6.0f), vec3(sign, a, b));  // beside the box
      }
}

TEST(Slab, OriginInside) {
  expectExact(vec3(1.0f, 2.0f, 3.0f), vec3(0.6f, 0.0f, 0.8f));
  expectExact(vec3(1.0f, 2.0f, 3.0f), vec3(-0.36f, 0.48f, -0.8f));
}

TEST(Slab, OriginOnFaceEdgeAndCorner) {
  for (float z : {0.0f, -0.0f}) {
    expectExact(vec3(0.0f, 5.0f, 6.0f), vec3(1.0f, z, z));     // into the box
    expectExact(vec3(0.0f, 5.0f, 6.0f), vec3(-1.0f, z, z));    // out of it: a point, no interval
    expectExact(vec3(0.0f, 5.0f, 6.0f), vec3(z, 1.0f, z));     // within the face
    expectExact(vec3(8.0f, -3.0f, 6.0f), vec3(z, 1.0f, z));    // along the other face
    expectExact(vec3(0.0f, -3.0f, 0.0f), vec3(z, 1.0f, z));    // along an edge
    expectExact(vec3(8.0f, 20.0f, 24.0f), vec3(z, -1.0f, z));  // along the opposite edge
  }
  expectExact(vec3(0.0f), vec3(0.6f, 0.0f, 0.8f));
  expectExact(vec3(0.0f), vec3(-0.6f, 0.0f, 0.8f));
  expectExact(vec3(-1.0f, -1.0f, -1.0f), vec3(1.0f, 1.0f, 1.0f));  // through the corner
}

TEST(Slab, BehindAndMissed) {
  expectExact(vec3(20.0f, 5.0f, 6.0f), vec3(1.0f, 0.0f, 0.0f));
  expectExact(vec3(-4.0f, -4.0f, 6.0f), vec3(-0.6f, 0.8f, 0.0f));
  expectExact(vec3(-10.0f, 5.0f, 6.0f), vec3(0.1f, 0.99f, 0.0f));
}

}  // namespace
}  // namespace nephele::shared
