// The words by which scenes name their choices, as read and as written. Depends on scene.h alone.
#include "scene/scene.h"

namespace nephele {

std::string nameOf(Look look) { return look == Look::report ? "report" : "physical"; }

std::string nameOf(LightTransmittance transmittance) {
  return transmittance == LightTransmittance::chord ? "chord" : "marched";
}

std::string nameOf(AtlasPrecision precision) {
  switch (precision) {
    case AtlasPrecision::r8:
      return "r8";
    case AtlasPrecision::r16f:
      return "r16f";
    case AtlasPrecision::r32f:
      return "r32f";
    case AtlasPrecision::automatic:
      break;
  }
  return "auto";
}

std::string nameOf(Environment::Kind kind) {
  switch (kind) {
    case Environment::Kind::ramp:
      return "ramp";
    case Environment::Kind::exr:
      return "exr";
    case Environment::Kind::constant:
      break;
  }
  return "constant";
}

}  // namespace nephele
