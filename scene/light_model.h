// What is on after the look and the scene's own switches: the one answer that renderers, panel and charts
// read. Depends on scene alone.
#pragma once

#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace nephele {

/// Orders of scattering beyond the first in the `report` look where a scene does not count them.
inline constexpr int kReportOctaves = 4;

/// Asymmetries of the phase function mix(HG(first), HG(second), share).
struct PhaseLobes {
  double first = 0.0;
  double second = 0.0;  // 0 or below
  double share = 0.0;   // of the second, in [0, 1]
};

/// Every term of MODEL.md, section 2, settled. Emission is settled by the file too: here it is only what the
/// scene asks.
struct LightModel {
  Look look = Look::physical;
  PhaseLobes phase;
  bool silverLining = false;
  bool powder = false;
  double oSa = 0.0;  // 0 where powder is off
  LightTransmittance transmittance = LightTransmittance::marched;
  int octaveCount = 0;
  double a = 0.5, b = 0.5, c = 0.5, d = 0.0;
};

/// The medium is the one that is lit: the scene's, or the one chosen for it.
LightModel lightModelOf(const Scene& scene, const Medium& medium);

/// One switchable term for people to read.
struct LightTerm {
  std::string_view name;  // as in files
  bool on = false;
  bool physical = true;       // false: the picture is not the solution of the radiative transfer equation
  std::string_view sentence;  // what it does, or why it is not physical
};

/// All switchable terms in the order of scene.h.
std::vector<LightTerm> termsOf(const LightModel& model);

/// What an isotropic half-space of albedo 1 shows, looked at straight on, under a sky of radiance 1, if light
/// is scattered by the octaves' sum: Σ_m b^m ½ (1 − s ln(1 + 1/s)), s = a^m, m = 0 … count; exactly 1 would
/// be right (white furnace [PBRT]), single scattering alone gives ½ (1 − ln 2) = 0.153, and above 1 the
/// factors make light. Order m sees the sky through e^(−a^m τ/μ'), whose mean over directions is ½ E₂(a^m τ),
/// and the eye through e^(−τ). count ≥ 0, a, b and d in [0, 1]; a = 0 gives the limits ½ b^m. With d, order m
/// is weighed by (1 − d ½ E₂(τ))^m as well: half of all directions lead out; summed over depths, within 1e-5.
double furnaceValue(int count, double a, double b, double d = 0.0);

}  // namespace nephele
