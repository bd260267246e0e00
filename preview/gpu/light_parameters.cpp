// Scene terms to parameter rows. Depends on what its header names.
#include "preview/gpu/light_parameters.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "base/error.h"
#include "scene/blackbody.h"
#include "scene/light_model.h"
#include "scene/sky.h"

namespace nephele {
namespace {

using glm::dmat3;
using glm::dvec3;
using glm::vec4;

// Kinds as shaders/shared/environment.glsl names them; asserted in tests/preview/sky_test.cpp.
enum SkyKind : int { kNone = 0, kConstant = 1, kRamp = 2, kMap = 3 };

vec4 row(const dvec3& v, double w = 0.0) { return vec4(glm::vec3(v), static_cast<float>(w)); }
dvec3 vectorOf(const Rgb& rgb) { return dvec3(rgb[0], rgb[1], rgb[2]); }

/// Height along up of an index position, 0 and 1 at the ends of the world box of the active voxels, whose
/// cells reach half a voxel to all sides.
vec4 heightRow(const BrickVolume& bricks, const IndexFrame& frame, const dvec3& up) {
  const double scale = std::ldexp(1.0, frame.level);
  const dmat3 worldFromIndex = scale * dmat3(bricks.worldFromIndex);
  const dvec3 slope(glm::dot(worldFromIndex[0], up), glm::dot(worldFromIndex[1], up),
                    glm::dot(worldFromIndex[2], up));
  const dvec3 corner = (dvec3(bricks.activeMin) - 0.5) / scale - dvec3(frame.brickMin * kBrickCells);
  const dvec3 extent = dvec3(bricks.activeMax - bricks.activeMin) / scale;
  double base = glm::dot(slope, corner), reach = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    base += std::min(0.0, slope[axis] * extent[axis]);
    reach += std::abs(slope[axis] * extent[axis]);
  }
  return reach > 0.0 ? row(slope / reach, -base / reach) : vec4(0.0f);
}

void setChord(shared::MarchParameters& p, const BrickVolume& bricks, const IndexFrame& frame,
              LightTransmittance transmittance) {
  const double scale = std::ldexp(1.0, frame.level);
  const dvec3 corner(frame.brickMin * kBrickCells);
  const dvec3 sum = dvec3(bricks.activeMin + bricks.activeMax - 1) / scale;
  const dvec3 extent = dvec3(bricks.activeMax - bricks.activeMin) / scale;
  p.chordCentre = row(0.5 * sum - corner, bricks.meanActive);
  p.chordRadii = row(0.5 * extent, transmittance == LightTransmittance::chord ? 1.0 : 0.0);
}

void setRamp(shared::MarchParameters& p, const SkyRamp& ramp) {
  const RampShape shape = rampShape(ramp.cloudiness);
  p.environment = row(ramp.intensity * vectorOf(ramp.zenith), double{p.environment.w});
  p.skyHorizon = row(ramp.intensity * vectorOf(ramp.horizon), shape.skyPower);
  p.skyGround = row(ramp.intensity * shape.groundFactor * vectorOf(ramp.ground), shape.groundPower);
}

void setEnvironment(shared::MarchParameters& p, const ViewedScene& view) {
  const Environment& environment = view.scene.environment;
  SkyKind kind = kNone;
  double rotation = 0.0;
  switch (environment.kind) {
    case Environment::Kind::constant: {
      const dvec3 radiance = vectorOf(environment.constant);
      kind = radiance == dvec3(0.0) ? kNone : kConstant;
      p.environment = row(radiance, double{p.environment.w});
      break;
    }
    case Environment::Kind::ramp:
      kind = kRamp;
      setRamp(p, environment.ramp);
      break;
    case Environment::Kind::exr:
      NEPHELE_CHECK_EQ(view.environmentMap != nullptr, true);
      kind = kMap;
      rotation = environment.exr.rotation;
      p.environment = row(dvec3(environment.exr.intensity), double{p.environment.w});
      p.skySize = glm::ivec4(view.environmentMap->width, view.environmentMap->height, 0, 0);
      break;
  }
  const SkyAxes axes = skyAxes(view.up, rotation);
  p.skyUp = row(axes.up, kind);
  p.skyRight = row(axes.right);
  p.skyForward = row(axes.forward, environment.show ? 1.0 : 0.0);
}

/// Octaves scatter the more of a sky that nothing hides.
void setOpenSky(shared::MarchParameters& p, const Environment& environment, const LightModel& light) {
  if (environment.kind == Environment::Kind::exr) return;  // never asked of the light cache
  double orders = 0.0, scattering = 1.0;
  for (int m = 0; m <= light.octaveCount; ++m, scattering *= light.b) orders += scattering;
  p.skyOpen = row(orders * meanSkyRadiance(environment));
}

/// From the density's index space, relative to its brick grid's corner, to the temperatures', relative to
/// theirs.
void setHeatPlaces(shared::MarchParameters& p, const BrickVolume& bricks, const IndexFrame& frame,
                   const BrickVolume& heat) {
  glm::dmat4 worldFromIndex = bricks.worldFromIndex;
  for (int axis = 0; axis < 3; ++axis) worldFromIndex[axis] *= std::ldexp(1.0, frame.level);
  const glm::dmat4 heatFromIndex = glm::inverse(heat.worldFromIndex) * worldFromIndex;
  const glm::dvec4 corner(dvec3(frame.brickMin * kBrickCells), 1.0);
  const dvec3 origin = dvec3(heatFromIndex * corner) - dvec3(heat.brickMin * kBrickCells);
  vec4* const rows[] = {&p.heatX, &p.heatY, &p.heatZ};
  for (int axis = 0; axis < 3; ++axis)
    *rows[axis] =
        row(dvec3(heatFromIndex[0][axis], heatFromIndex[1][axis], heatFromIndex[2][axis]), origin[axis]);
  p.heatCount = glm::ivec4(heat.brickCount, 0);
}

void setBlackbody(shared::MarchParameters& p) {
  // Of shaders/shared/emission.glsl; the first node, infinitely hot, stands at a temperature far beyond all
  // light.
  constexpr double kPlanckKelvin = 23586.5, kHottestKelvin = 1e8;
  for (int i = 0; i < shared::kBlackbodyNodes; ++i) {
    const double place = static_cast<double>(i) / (shared::kBlackbodyNodes - 1);
    // The coldest node is a hair warmer than what counts as invisible.
    constexpr double kHair = 1e-9;
    const double kelvin = std::min(kColdestKelvin / (place * place) * (1.0 + kHair), kHottestKelvin);
    p.blackbody[i] = row(std::expm1(kPlanckKelvin / kelvin) * vectorOf(blackbodyRadiance(kelvin)));
  }
}

void setEmission(shared::MarchParameters& p, const ViewedScene& view, const BrickVolume& bricks,
                 const IndexFrame& frame) {
  const Emission& emission = view.scene.emission;
  const bool on = emission.on.value_or(true) && bricks.temperature && !bricks.temperature->empty() &&
                  view.medium.sigmaA != Rgb{};
  p.emission =
      on ? vec4(static_cast<float>(emission.scale), static_cast<float>(emission.temperatureScale), 0.0f, 0.0f)
         : vec4(0.0f);
  if (!on) return;
  setHeatPlaces(p, bricks, frame, *bricks.temperature);
  setBlackbody(p);
}

}  // namespace

void setLightParameters(shared::MarchParameters& p, const ViewedScene& view, const BrickVolume& bricks,
                        const IndexFrame& frame) {
  const LightModel light = lightModelOf(view.scene, view.medium);
  const dvec3 sigmaS = vectorOf(view.medium.sigmaS);
  p.sigmaT = row(sigmaS + vectorOf(view.medium.sigmaA));
  p.sigmaS = row(sigmaS, double{p.sigmaS.w});
  p.phase = row(dvec3(light.phase.first, light.phase.second, light.phase.share));
  p.powder = row(dvec3(light.oSa, bricks.maximum > 0.0 ? 1.0 / bricks.maximum : 0.0, 0.0));
  p.height = heightRow(bricks, frame, view.up);
  p.octaves = row(dvec3(light.a, light.b, light.c), light.d);
  p.counts.y = light.octaveCount;
  setChord(p, bricks, frame, light.transmittance);
  setEnvironment(p, view);
  setOpenSky(p, view.scene.environment, light);
  setEmission(p, view, bricks, frame);
}

}  // namespace nephele
