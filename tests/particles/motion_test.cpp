// The shared text of particle motion against closed forms, and steps that are much too long.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "particles/shared_text.h"

namespace nephele::motion {
namespace {

using State = Motion::Particle;

Motion still() {
  Motion m{};
  m.particles.up = vec4(0.0f, 0.0f, 1.0f, 0.0f);
  m.particles.curl = vec4(0.0f, 1.0f, 0.5f, 0.0f);
  m.particles.neighbours.x = 1.0f;
  return m;
}

void advance(Motion& motion, vec3& position, vec3& velocity, float seconds, int steps) {
  const float dt = seconds / float(steps);
  for (int n = 0; n < steps; ++n)
    motion.moveParticle(position, velocity, float(n) * dt, 0.0f, {}, float(n) * dt, dt);
}

TEST(ParticleMotion, SineAndCosineAreThoseOfTheLibrary) {
  double largest = 0.0;
  for (float x = -800.0f; x < 800.0f; x += 0.0137f) {
    const vec2 both = sineCosine(x);
    largest = std::max({largest, std::abs(double(both.x) - std::sin(double(x))),
                        std::abs(double(both.y) - std::cos(double(x)))});
  }
  EXPECT_LT(largest, 1.5e-7);
}

TEST(ParticleMotion, DragFactorsAreTheirFormulas) {
  for (double z = 1e-6; z < 80.0; z *= 1.1) {
    const vec3 f = still().dragFactors(float(z));
    const double zf = double(float(z)), e = std::exp(-zf), first = -std::expm1(-zf) / zf;
    const double second = zf < 1e-3 ? 0.5 - zf / 6.0 : (1.0 - first) / zf;
    EXPECT_NEAR(double(f.x), e, 4e-7) << z;
    EXPECT_NEAR(double(f.y), first, 8e-7) << z;
    EXPECT_NEAR(double(f.z), second, 2e-6) << z;
  }
}

TEST(ParticleMotion, WithoutDragAParticleFliesItsParabola) {
  Motion m = still();
  m.particles.gravity = vec4(0.0f, 0.0f, -9.81f, 0.0f);
  for (const int steps : {1, 7, 240}) {
    vec3 p(1.0f, 2.0f, 3.0f), v(3.0f, 0.0f, 5.0f);
    advance(m, p, v, 1.5f, steps);
    // x0 + v t + g t²/2
    EXPECT_NEAR(p.x, 1.0 + 3.0 * 1.5, 2e-5) << steps;
    EXPECT_NEAR(p.z, 3.0 + 5.0 * 1.5 - 0.5 * 9.81 * 1.5 * 1.5, 5e-5) << steps;
    EXPECT_NEAR(v.z, 5.0 - 9.81 * 1.5, 2e-5) << steps;
  }
}

TEST(ParticleMotion, WithDragItFollowsTheClosedFormAtAnyStep) {
  Motion m = still();
  const double g = -9.81, k = 3.0, w = 2.0, t = 1.25;
  m.particles.gravity = vec4(0.0f, 0.0f, float(g), float(k));
  m.particles.wind = vec4(float(w), 0.0f, 0.0f, 0.0f);
  for (const int steps : {1, 5, 300}) {
    vec3 p(0.0f), v(-4.0f, 0.0f, 6.0f);
    advance(m, p, v, float(t), steps);
    const double e = std::exp(-k * t);
    EXPECT_NEAR(v.x, w + (-4.0 - w) * e, 2e-5) << steps;
    EXPECT_NEAR(v.z, g / k + (6.0 - g / k) * e, 2e-5) << steps;
    EXPECT_NEAR(p.x, w * t + (-4.0 - w) * (1.0 - e) / k, 2e-5) << steps;
    EXPECT_NEAR(p.z, g / k * t + (6.0 - g / k) * (1.0 - e) / k, 2e-5) << steps;
  }
}

TEST(ParticleMotion, TerminalVelocityIsGravityOverDrag) {
  Motion m = still();
  m.particles.gravity = vec4(0.0f, 0.0f, -9.81f, 4.0f);
  for (const float dt : {1.0f / 240.0f, 1.0f / 24.0f, 1.0f}) {
    vec3 p(0.0f), v(0.0f, 0.0f, 100.0f);
    advance(m, p, v, 10.0f, int(10.0f / dt));
    EXPECT_NEAR(v.z, -9.81 / 4.0, 1e-5) << dt;
  }
}

TEST(ParticleMotion, AVortexTurnsParticlesOnCircles) {
  Motion m = still();
  m.particles.counts.x = 1;
  m.particles.vortices[0] = {vec4(1.0f, 0.0f, 0.0f, 50.0f), vec4(0.0f, 0.0f, 1.0f, 2.0f)};
  for (const float dt : {1.0f / 240.0f, 1.0f / 24.0f, 1.0f}) {
    vec3 p(1.5f, 0.0f, 0.3f), v(0.0f);
    advance(m, p, v, 20.0f, int(20.0f / dt));
    const double far = std::hypot(double(p.x) - 1.0, double(p.y));
    EXPECT_NEAR(far, 0.5, 2e-3) << dt;
    EXPECT_NEAR(p.z, 0.3, 1e-6);
  }
  // One step by the angle rate · e^(−r²/R²) · dt.
  vec3 p(1.5f, 0.0f, 0.0f), v(0.0f);
  m.moveParticle(p, v, 0.0f, 0.0f, {}, 0.0f, 0.01f);
  EXPECT_NEAR(std::atan2(double(p.y), double(p.x) - 1.0), 50.0 * std::exp(-0.25 / 4.0) * 0.01, 1e-5);
}

class StiffSteps : public testing::TestWithParam<float> {};

/// Drag of 10^4/s, springs of 10^5/s², and vortices of 10^3 radians per second, for a hundred steps.
TEST_P(StiffSteps, NothingGrows) {
  Motion m = still();
  m.particles.gravity = vec4(0.0f, 0.0f, -9.81f, 1e4f);
  m.particles.counts = ivec4(1, 1, 0, 0);
  m.particles.vortices[0] = {vec4(0.0f, 0.0f, 0.0f, 1e3f), vec4(0.0f, 0.0f, 1.0f, 1.0f)};
  m.particles.attractors[0] = {vec4(0.0f, 0.0f, 0.0f, 1e5f), vec4(5.0f, 0.0f, 0.0f, 0.0f)};
  for (const float drag : {0.0f, 1e4f}) {
    m.particles.gravity.w = drag;
    vec3 p(0.7f, 0.2f, 0.5f), v(1.0f, -2.0f, 0.5f);
    const float start = length(p);
    for (int n = 0; n < 100; ++n) {
      m.moveParticle(p, v, 0.0f, 0.0f, {}, float(n) * GetParam(), GetParam());
      ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(v.x));
      // One step of the first speeds and of gravity, and what the spring swings.
      ASSERT_LT(length(p), 3.0f * (start + 10.0f * GetParam() * (1.0f + GetParam())))
          << n << " drag " << drag;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Steps, StiffSteps,
                         testing::Values(1.0f / 240.0f, 1.0f / 60.0f, 1.0f / 24.0f, 0.25f, 1.0f));

TEST(ParticleMotion, CurlNoiseHasTheSpeedItIsGivenAndNoSources) {
  Motion m = still();
  m.particles.curl = vec4(2.0f, 1.0f, 0.5f, 0.0f);
  m.particles.counts = ivec4(0, 0, 1, 7);
  double squares = 0.0, divergence = 0.0, slopes = 0.0;
  constexpr int kCount = 20000;
  constexpr float kStep = 1e-2f;
  uint state = 5u;
  for (int n = 0; n < kCount; ++n) {
    const vec3 p = 50.0f * vec3(nextUniform(state), nextUniform(state), nextUniform(state));
    const vec3 flow = m.curlVelocity(p, 0.0f);
    squares += double(dot(flow, flow));
    double sources = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      vec3 apart(0.0f);
      apart[axis] = kStep;
      const double slope = double(
          (m.curlVelocity(p + apart, 0.0f)[axis] - m.curlVelocity(p - apart, 0.0f)[axis]) / (2.0f * kStep));
      sources += slope;
      slopes += slope * slope;
    }
    divergence += sources * sources;
  }
  EXPECT_NEAR(std::sqrt(squares / kCount), 2.0, 0.06);
  EXPECT_LT(std::sqrt(divergence / slopes), 0.01);
}

TEST(ParticleMotion, TheGroundKeepsParticlesAbove) {
  Motion m = still();
  m.particles.gravity = vec4(0.0f, 0.0f, -9.81f, 0.0f);
  m.particles.ground = vec4(0.25f, 0.5f, 0.1f, 0.0f);
  m.particles.flags.x = 1;
  for (const float dt : {1.0f / 240.0f, 1.0f / 24.0f, 1.0f}) {
    vec3 p(0.0f, 0.0f, 2.0f), v(1.0f, 0.0f, 0.0f);
    for (int n = 0; float(n) * dt < 150.0f; ++n) {
      m.moveParticle(p, v, 0.0f, 0.0f, {}, 0.0f, dt);
      ASSERT_GE(p.z, 0.25f - 1e-6f);
    }
    EXPECT_LT(p.z, 0.25f + 10.0f * dt * dt);  // at rest, but for what gravity gives and takes in a step
    EXPECT_LT(length(vec2(v.x, v.y)), 1e-3f);
  }
}

TEST(ParticleMotion, NeighboursPullTogetherAndPushApartWithoutGrowing) {
  Motion m = still();
  m.particles.neighbours = vec4(1.0f, 1e4f, 0.0f, 0.0f);
  for (const float dt : {1.0f / 240.0f, 1.0f / 24.0f, 1.0f}) {
    vec3 p[2] = {vec3(0.0f), vec3(0.6f, 0.0f, 0.0f)}, v[2] = {vec3(0.0f), vec3(0.0f)};
    for (int n = 0; n < 500; ++n) {
      Motion::NeighbourSums sums[2] = {};
      m.addNeighbour(p[1] - p[0], sums[0]);
      m.addNeighbour(p[0] - p[1], sums[1]);
      for (int k = 0; k < 2; ++k) {
        v[k] = m.afterNeighbours(v[k], sums[k], dt);
        p[k] += v[k] * dt;
      }
      ASSERT_LT(length(p[1] - p[0]), 0.7f) << dt;
    }
    EXPECT_LT(length(p[1] - p[0]), 0.1f) << dt;
  }
  m.particles.neighbours = vec4(1.0f, 0.0f, 50.0f, 0.0f);
  Motion::NeighbourSums sums{};
  m.addNeighbour(vec3(0.3f, 0.0f, 0.0f), sums);
  const vec3 pushed = m.afterNeighbours(vec3(0.0f), sums, 0.01f);
  // 1 − 0.3 of the full push, over the implicit step's 1 + dt² · 50.
  EXPECT_NEAR(pushed.x, -50.0 * 0.7 * 0.01 / (1.0 + 1e-4 * 50.0), 1e-4);
}

TEST(ParticleMotion, EmittersFillTheirShapesEvenly) {
  Motion m = still();
  EmitterParameters e{};
  e.center = vec4(1.0f, 2.0f, 3.0f, 0.0f);
  e.size = vec4(2.0f, 2.0f, 2.0f, 1.0f);
  e.axis = vec4(0.0f, 0.0f, 1.0f, 0.0f);
  e.motion = vec4(0.0f, 0.0f, 1.0f, 0.0f);
  e.born.x = 0.1f;
  constexpr int kCount = 20000;
  const auto meanOf = [&](int kind, bool surface, const auto& measure) {
    e.kind = ivec4(kind, surface ? 1 : 0, 42, 0);
    double sum = 0.0;
    for (uint id = 0; id < kCount; ++id)
      sum += measure(m.emitParticle(e, id, vec3(0.0f), vec3(0.0f)).position - vec3(1.0f, 2.0f, 3.0f));
    return sum / kCount;
  };
  const auto squared = [](vec3 p) { return double(dot(p, p)); };
  // 3/5 r² in a ball, r² on its surface, r²/2 in a disc; half size squared in a box, and on its surface (1 +
  // 2/3)/… of it.
  EXPECT_NEAR(meanOf(kEmitSphere, false, squared), 0.6 * 4.0, 0.03);
  EXPECT_NEAR(meanOf(kEmitSphere, true, squared), 4.0, 1e-4);
  EXPECT_NEAR(meanOf(kEmitDisc, false, squared), 2.0, 0.03);
  EXPECT_NEAR(meanOf(kEmitBox, false, squared), 4.0, 0.05);
  EXPECT_NEAR(meanOf(kEmitBox, true, squared), 4.0 * (1.0 + 2.0 / 3.0), 0.05);
  EXPECT_EQ(meanOf(kEmitPoint, false, squared), 0.0);
  EXPECT_NEAR(meanOf(kEmitSphere, false, [](vec3 p) { return double(p.x); }), 0.0, 0.03);
  const State born = m.emitParticle(e, 3u, vec3(0.0f), vec3(0.0f));
  EXPECT_NEAR(born.mass, 4.0 / 3.0 * std::numbers::pi * 1e-3, 1e-9);
}

}  // namespace
}  // namespace nephele::motion
