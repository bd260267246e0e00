// Noise of one octave by kind. Depends on perlin.h, the kernels and shared text.
#include "bake/fields/basis.h"

#include <algorithm>
#include <cmath>

#include "bake/fields/cell_place.h"
#include "bake/fields/noise_kernels.h"
#include "bake/fields/shared_text.h"

namespace nephele {
namespace {

WorleyNoise worleyOf(const NoiseOctave& octave) {
  return {octave.cellSize, 1.0f, octave.seed, octave.period, WorleyOutput::f1, octave.turn};
}

float valueNoiseAt(const NoiseOctave& octave, const CellPlace& x, const CellPlace& y, const CellPlace& z) {
  const glm::ivec3 cell(x.cell, y.cell, z.cell);
  const glm::vec3 f(x.fraction, y.fraction, z.fraction);
  return octave.turn.evolves ? shared::turningValue(cell, f, octave.period, octave.seed, octave.turn.at)
                             : shared::valueNoise(cell, f, octave.period, octave.seed);
}

CellPlace moved(const CellPlace& start, float by) {
  const float along = start.fraction + by, whole = std::floor(along);
  return {cellAfter(start.cell, whole), along - whole};
}

void valueNoiseAtPoints(const NoiseOctave& octave, const Points& points, float* values) {
  const glm::dvec3 origin = points.origin - octave.offset;
  const CellPlace x = cellPlace(origin.x, octave.cellSize), y = cellPlace(origin.y, octave.cellSize),
                  z = cellPlace(origin.z, octave.cellSize);
  const float frequency = float(1.0 / octave.cellSize);
  for (size_t n = 0; n < points.count; ++n)
    values[n] = valueNoiseAt(octave, moved(x, points.x[n] * frequency), moved(y, points.y[n] * frequency),
                             moved(z, points.z[n] * frequency));
}

void fromDistance(float* values, size_t count) {
  for (size_t n = 0; n < count; ++n) values[n] = std::clamp(1.0f - 2.0f * values[n], -1.0f, 1.0f);
}

}  // namespace

Basis basisOf(const std::string& name) {
  return name == "value" ? Basis::value : name == "worley" ? Basis::worley : Basis::perlin;
}

double meanOf(Basis basis, Fold fold) {
  if (fold == Fold::plain) return basis == Basis::worley ? -0.041 : 0.0;
  const double magnitude = basis == Basis::perlin ? 0.2124 : basis == Basis::value ? 0.3303 : 0.282;
  return fold == Fold::ridged ? 1.0 - magnitude : magnitude;
}

void evaluateBasis(Basis basis, const NoiseOctave& octave, const Points& points, float* values) {
  if (basis == Basis::value) return valueNoiseAtPoints(octave, points, values);
  if (basis == Basis::worley) {
    Points moved = points;
    moved.origin -= octave.offset;
    worleyAtPoints(worleyOf(octave), moved, values);
    return fromDistance(values, points.count);
  }
  NoiseOctave whole = octave;
  whole.weight = 1.0f;
  std::fill_n(values, points.count, 0.0f);
  addNoiseAtPoints(&whole, 1, points, values);
}

void evaluateBasis(Basis basis, const NoiseOctave& octave, const Lattice& lattice, float* values) {
  if (basis == Basis::value) return valueNoiseAtPoints(octave, LatticePoints(lattice).points(), values);
  if (basis == Basis::worley) {
    worleyOnLattice(worleyOf(octave), {lattice.origin - octave.offset, lattice.spacing}, values);
    return fromDistance(values, kBlockPoints);
  }
  NoiseOctave whole = octave;
  whole.weight = 1.0f;
  std::fill_n(values, kBlockPoints, 0.0f);
  addNoiseOnLattice(&whole, 1, lattice, values);
}

Interval boundBasis(Basis basis, const NoiseOctave& octave, const Box& box) {
  if (basis == Basis::perlin) {
    NoiseOctave whole = octave;
    whole.weight = 1.0f;
    return boundNoise(whole, box);
  }
  // As in boundNoise: room for float places and operations.
  constexpr double kPlaceRoom = 1e-5;
  const Box within = withinMoved(box, octave.offset);
  const glm::dvec3 half = within.halfSize() / octave.cellSize;
  const double across = std::sqrt(half.x * half.x + half.y * half.y + half.z * half.z);
  const Interval all{-1.0 - kPlaceRoom, 1.0 + kPlaceRoom};
  const double slope = basis == Basis::worley ? 2.0 : kValueSlope;
  // A distance to the nearest of points changes by at most the way gone; the basis takes twice that.
  if (!(slope * across < 2.0)) return all;
  const glm::dvec3 p = within.centre();
  const double centre =
      basis == Basis::worley
          ? 1.0 - 2.0 * double(worleyAt(worleyOf(octave), p))
          : double(valueNoiseAt(octave, cellPlace(p.x, octave.cellSize), cellPlace(p.y, octave.cellSize),
                                cellPlace(p.z, octave.cellSize)));
  const double room = slope * across + kPlaceRoom;
  const Interval near{centre - room, centre + room};
  return basis == Basis::worley ? clamped(near, -1.0, 1.0) : both(near, all);
}

}  // namespace nephele
