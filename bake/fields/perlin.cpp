// Octaves of gradient noise and their bounds. Depends on field.h, table.h and shared text.
#include "bake/fields/perlin.h"

#include <cmath>

#include "bake/fields/cell_place.h"
#include "bake/fields/shared_text.h"

namespace nephele {
namespace {

/// `p` is a place in the pattern.
float noiseAt(const NoiseOctave& octave, const glm::dvec3& p) {
  const CellPlace x = cellPlace(p.x, octave.cellSize), y = cellPlace(p.y, octave.cellSize),
                  z = cellPlace(p.z, octave.cellSize);
  return noiseInCell(octave, {x.cell, y.cell, z.cell}, {x.fraction, y.fraction, z.fraction});
}

}  // namespace

float noiseScale(const NoiseOctave& octave) {
  return octave.turn.evolves ? shared::kTurningScale : shared::kPerlinScale;
}

float noiseInCell(const NoiseOctave& octave, const glm::ivec3& cell, const glm::vec3& f) {
  return octave.turn.evolves ? shared::turningNoise(cell, f, octave.period, octave.seed, octave.turn.at)
                             : shared::perlinNoise(cell, f, octave.period, octave.seed);
}

double bandLimit(double cellVoxels) { return std::clamp((cellVoxels - 2.0) / 2.0, 0.0, 1.0); }

Interval boundNoise(const NoiseOctave& octave, const Box& box) {
  const double weight = std::abs(double(octave.weight));
  const Box within = withinMoved(box, octave.offset);
  const glm::dvec3 half = within.halfSize() / octave.cellSize;
  const double cornerSlope = octave.turn.evolves ? kTurningCornerSlope : kPerlinCornerSlope;
  const double reach = std::min(kPerlinSlope * std::sqrt(half.x * half.x + half.y * half.y + half.z * half.z),
                                cornerSlope * std::max({half.x, half.y, half.z}));
  // Float noise may differ from real noise by the rounding of its 30 operations and of a point's place in its
  // cell, where a block's offsets reach across many cells.
  constexpr double kPlaceRoom = 1e-5;
  const Interval all{-weight * (1.0 + kPlaceRoom), weight * (1.0 + kPlaceRoom)};
  if (!(reach < 2.0)) return all;
  const double centre = double(octave.weight) * double(noiseAt(octave, within.centre()));
  const double room = weight * (reach + kPlaceRoom);
  return both(all, {centre - room, centre + room});
}

Motion Fractal::motion() const {
  return {double(period) * cellSize, scroll, fineScroll, evolve, octaves, lacunarity};
}

std::vector<NoiseOctave> fbmOctaves(const Fractal& fractal, const BuildContext& context, const char* field) {
  double total = 0.0, weight = 1.0;
  for (int64_t i = 0; i < fractal.octaves; ++i, weight *= fractal.gain) total += weight;
  std::vector<NoiseOctave> list;
  weight = 1.0;
  double size = fractal.cellSize;
  double cells = double(fractal.period);
  const Motion motion = fractal.motion();
  for (int64_t i = 0; i < fractal.octaves; ++i) {
    const double kept = i < context.mostOctaves ? bandLimit(size / context.voxelSize) : 0.0;
    if (kept < 1.0 && context.notes)
      context.notes->push_back({field, int(i), size / context.voxelSize, kept});
    if (kept > 0.0) {
      const OctavePlace place = octavePlace(motion, i, context);
      list.push_back({size, float(weight * kept / total), shared::seedApart(fractal.seed, int(i)),
                      int(std::lround(cells)), place.offset, place.turn});
    }
    weight *= fractal.gain;
    size /= fractal.lacunarity;
    cells *= fractal.lacunarity;
  }
  return list;
}

}  // namespace nephele
