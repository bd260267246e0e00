// Random rays and depths along them. Depends on chords.h, TBB.
#include "volume/chords.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "base/error.h"

namespace nephele {
namespace {

using glm::dvec3;

dvec3 onSphere(std::mt19937_64& random) {
  // Two draws of 53 bits each, in place of a distribution, whose sequence the standard leaves open.
  const auto uniform = [&] { return double(random() >> 11) * 0x1p-53; };
  const double z = 2.0 * uniform() - 1.0, angle = 2.0 * std::numbers::pi * uniform();
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace

double Chords::volumeOf(double lengthInside) const {
  // Mean length · π R² is the volume: the ball's own chords have a mean of 4 R / 3.
  return lines.empty() ? 0.0 : std::numbers::pi * radius * radius * lengthInside / double(lines.size());
}

Chords randomChords(const dvec3& low, const dvec3& high, uint64_t count, uint64_t seed) {
  Chords chords;
  if (!(low.x <= high.x && low.y <= high.y && low.z <= high.z)) return chords;
  const dvec3 centre = 0.5 * (low + high);
  chords.radius = 0.5 * glm::length(high - low);
  chords.lines.resize(count);
  for (uint64_t n = 0; n < count; ++n) {
    constexpr int kRayBits = 32;
    std::mt19937_64 random(seed << kRayBits | n);
    const dvec3 from = centre + chords.radius * onSphere(random);
    chords.lines[n] = {from, centre + chords.radius * onSphere(random)};
  }
  return chords;
}

ChordWalk walkBetween(const dvec3& from, const dvec3& to, const dvec3& low, const dvec3& high) {
  ChordWalk walk;
  walk.start = from;
  walk.along = to - from;
  walk.steps = std::max(1, int(std::ceil(glm::length(walk.along) / kDepthStepVoxels)));
  double first = 0.0, last = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - from[axis]) / walk.along[axis],
                 b = (high[axis] - from[axis]) / walk.along[axis];
    if (std::isnan(a) || std::isnan(b)) continue;  // along the side itself
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  if (!(first < last)) return walk;
  walk.begin = int(std::floor(first * walk.steps));
  walk.end = std::min(walk.steps, int(std::ceil(last * walk.steps)));
  return walk;
}

std::vector<double> depthsAlong(const BrickVolume& v, std::span<const Chord> chords, double* lengthInside) {
  std::vector<double> depths(chords.size()), lengths(chords.size());
  if (lengthInside) *lengthInside = 0.0;
  if (v.empty()) return depths;
  const glm::dmat4 toIndex = glm::inverse(v.worldFromIndex);
  const auto indexOf = [&](const dvec3& p) { return dvec3(toIndex * glm::dvec4(p, 1.0)); };
  const dvec3 low(v.brickMin * kBrickCells), high((v.brickMin + v.brickCount) * kBrickCells);
  tbb::parallel_for(size_t(0), chords.size(), [&](size_t n) {
    const ChordWalk walk = walkBetween(indexOf(chords[n].from), indexOf(chords[n].to), low, high);
    double sum = 0.0;
    int inside = 0;
    for (int k = walk.begin; k < walk.end; ++k) {
      const double density = densityAt(v, walk.at(k));
      sum += density;
      inside += density > 0.0;
    }
    const double length = glm::distance(chords[n].from, chords[n].to);
    depths[n] = sum * length / walk.steps;
    lengths[n] = inside * length / walk.steps;
  });
  if (lengthInside)
    for (const double length : lengths) *lengthInside += length;
  return depths;
}

double relativeTo(double reference, double difference) {
  if (difference == 0.0) return 0.0;
  return reference > 0.0 ? difference / reference : std::numeric_limits<double>::infinity();
}

double DepthDifference::relative() const { return relativeTo(largestA, largest); }

DepthDifference differenceOf(std::span<const double> a, std::span<const double> b) {
  NEPHELE_CHECK_EQ(a.size(), b.size());
  DepthDifference d;
  d.rays = a.size();
  double squares = 0.0;
  for (size_t n = 0; n < a.size(); ++n) {
    const double apart = std::abs(a[n] - b[n]);
    d.largest = std::max(d.largest, apart);
    d.largestA = std::max(d.largestA, a[n]);
    squares += apart * apart;
  }
  if (!a.empty()) d.rms = std::sqrt(squares / double(a.size()));
  return d;
}

}  // namespace nephele
