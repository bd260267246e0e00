// How the noise of a field moves: what its row asks for, where that has come to at a time, and how it closes
// over a loop. Depends on table.h and turn.h.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/fields/table.h"
#include "bake/fields/turn.h"

namespace nephele {

/// What a row's parameters ask of its octaves. Octave 0 is the coarsest.
struct Motion {
  double period = 0.0;         // world units after which the pattern repeats on every axis; 0: never
  glm::dvec3 scroll{0.0};      // world units per second, all octaves
  glm::dvec3 fineScroll{0.0};  // on top of it for the last octave, in even shares for those between
  double evolve = 0.0;         // turns per second of octave 0; finer ones turn faster
  int64_t octaves = 1;
  double lacunarity = 2.0;
  bool repeats = true;  // false: the row has no period to give
};

/// One octave at a time.
struct OctavePlace {
  glm::dvec3 offset{0.0};  // world units that the pattern has moved
  Turn turn{};
};

/// Turns of octave `octave` for one of octave 0: lacunarity^(2/3) for each octave, as eddies of size l turn
/// over in a time that grows with l^(2/3) [Kolmogorov 1941].
double evolveRate(double lacunarity, int64_t octave);

/// Where an octave is at the context's time. In a loop every motion is a whole number of periods or turns,
/// the nearest to what is asked, and is counted in whole frames: the same place, bit for bit, a loop later.
OctavePlace octavePlace(const Motion& motion, int64_t octave, const BuildContext& context);

/// The mean velocity of the octaves, world units per second, in a loop that of the loop.
glm::dvec3 meanScroll(const Motion& motion, const BuildContext& context);

/// What of the motion cannot close over the loop, and what would: the parameter at fault and a sentence each.
std::vector<std::pair<std::string_view, std::string>> loopComplaints(const Motion& motion, const Loop& loop);

/// What the loop makes of the parameters that do not fit it as they stand.
std::vector<LoopNote> loopNotes(const Motion& motion, const Loop& loop, std::string_view field);

}  // namespace nephele
