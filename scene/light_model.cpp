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

double furnaceValue(int count, double a, double b) {
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
