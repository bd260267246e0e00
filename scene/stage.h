// The look-dev stage: solid things around the medium, as signed distance fields [BenSahla, Fournier]. Plain
// values; what is left open follows from the cloud (preview/gpu/stage_parameters.h). Depends on glm alone.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

namespace nephele {

/// One thing that stands on the stage. `size`: radius of a ball, edge of a cube; world units.
struct StageThing {
  bool on = true;
  std::optional<glm::dvec3> center;  // nullopt (`auto` in files): on the floor, before the cloud
  std::optional<double> size;        // nullopt: follows from the cloud's box
  bool operator==(const StageThing&) const = default;
};

struct Stage {
  bool on = false;  // in a file, `stage` without `on` switches it on
  bool floor = true;
  std::optional<double> height;   // of the floor along up; nullopt: a little below the cloud
  std::optional<double> checker;  // edge of a square; nullopt: follows from the cloud's box
  StageThing chrome, grey, cube{.on = false, .center = {}, .size = {}};  // the cube is of chrome
  bool highlights = true;                                                // off: surfaces are Lambertian
  double penumbra = 8.0;  // sharpness k of the things' shadows [Quilez], 1…1000; 0: hard
  bool operator==(const Stage&) const = default;
};

}  // namespace nephele
