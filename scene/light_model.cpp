// Looks, switches and the octaves' white furnace. Depends on scene alone.
#include "scene/light_model.h"

#include <cmath>

namespace nephele {

LightModel lightModelOf(const Scene& scene, const Medium& medium) {
  const bool report = scene.look == Look::report;
  LightModel model;
  model.look = scene.look;
  model.silverLining = scene.silverLining.on.value_or(report);
  model.phase = {medium.g, 0.0, 0.0};
  if (model.silverLining)
    model.phase = {scene.silverLining.inS, -scene.silverLining.outS, scene.silverLining.blend};
  model.powder = scene.powder.on.value_or(report);
  model.oSa = model.powder ? scene.powder.oSa : 0.0;
  model.transmittance = scene.lightTransmittance;
  model.octaveCount = scene.octaves.count.value_or(report ? kReportOctaves : 0);
  model.a = scene.octaves.a;
  model.b = scene.octaves.b;
  model.c = scene.octaves.c;
  model.d = scene.octaves.d;
  return model;
}

std::vector<LightTerm> termsOf(const LightModel& model) {
  return {{"silver_lining", model.silverLining, true,
           "two lobes in the place of the medium's g: a phase function like any other"},
          {"powder", model.powder, false, "darkens dense parts by a formula, and loses the light"},
          {"light_transmittance: chord", model.transmittance == LightTransmittance::chord, false,
           "sees a homogeneous ellipsoid in the place of the cloud"},
          {"octaves", model.octaveCount > 0, false,
           "stand for multiple scattering and keep no balance of energy: see the furnace value"}};
}

namespace {

/// ∫₀¹ e^(−x/μ) dμ for x ≥ 0.
double exponentialIntegral2(double x) { return x > 0.0 ? std::exp(-x) + x * std::expint(-x) : 1.0; }

/// Over the depths, by the middles of even shares of what the eye sees.
double furnaceOfClosedOrders(int count, double a, double b, double d) {
  constexpr int kShares = 4000;
  double sum = 0.0;
  for (int i = 0; i < kShares; ++i) {
    const double depth = -std::log((i + 0.5) / kShares);
    const double again = b * (1.0 - d * 0.5 * exponentialIntegral2(depth));
    double s = 1.0, weight = 1.0;
    for (int m = 0; m <= count; ++m, s *= a, weight *= again)
      sum += weight * 0.5 * exponentialIntegral2(s * depth) / kShares;
  }
  return sum;
}

}  // namespace

double furnaceValue(int count, double a, double b, double d) {
  if (d > 0.0) return furnaceOfClosedOrders(count, a, b, d);
  double sum = 0.0, s = 1.0, weight = 1.0;
  for (int m = 0; m <= count; ++m) {
    // s ln(1 + 1/s) → 0 with s, and 1/s would overflow before.
    constexpr double kNothing = 1e-300;
    const double seen = s > kNothing ? 1.0 - s * std::log1p(1.0 / s) : 1.0;
    sum += weight * 0.5 * seen;
    s *= a;
    weight *= b;
  }
  return sum;
}

}  // namespace nephele
