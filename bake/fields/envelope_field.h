// What all envelopes share: a signed distance becomes a density that falls over `falloff`, bounds come from
// distances. A shape says how far a point is and how far a box's points may be. Depends on field.h, table.h
// and shared text.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "bake/fields/shared_text.h"
#include "bake/fields/table.h"

namespace nephele {

inline double lengthOf(const glm::dvec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

/// The coordinates' magnitudes nearest to and farthest from the origin in a box. A function that grows with
/// |x|, |y| and |z| has its least and greatest value there.
inline glm::dvec3 leastMagnitudes(const Box& box) {
  glm::dvec3 least(0.0);
  for (int axis = 0; axis < 3; ++axis) least[axis] = std::max({box.low[axis], -box.high[axis], 0.0});
  return least;
}
inline glm::dvec3 greatestMagnitudes(const Box& box) {
  glm::dvec3 greatest(0.0);
  for (int axis = 0; axis < 3; ++axis)
    greatest[axis] = std::max(std::abs(box.low[axis]), std::abs(box.high[axis]));
  return greatest;
}

/// The envelope over an interval of signed distances; 0 and 1 are exact.
inline Interval envelopeOver(const Interval& distances, double falloff) {
  const auto valueAt = [falloff](double distance) {
    if (falloff <= 0.0) return distance < 0.0 ? 1.0 : 0.0;
    return std::clamp(-distance / falloff, 0.0, 1.0);
  };
  return {valueAt(distances.high), valueAt(distances.low)};
}

/// Room for a float distance at a point of the box, coordinates relative to a shape's centre: roundings of
/// the offset, the distance and the envelope, all of the size of the farthest point or the shape itself.
inline double distanceRoom(const Box& local, double size) {
  return 1e-6 * (lengthOf(greatestMagnitudes(local)) + size);
}

/// A shape about its own origin gives: float distance(vec3), from shared text, Lipschitz 1; Interval
/// distances(Box), of the real distance up to distanceRoom; Box extent(), outside which the distance is not
/// negative; double size(), the scale of its numbers.
template <class Shape>
class EnvelopeField final : public Field {
 public:
  EnvelopeField(const glm::dvec3& centre, const Shape& shape, double falloff)
      : centre_(centre), shape_(shape), falloff_(falloff) {}

  void evaluate(const Points& points, float* values) const override {
    const glm::vec3 offset(points.origin - centre_);
    const float falloff = float(falloff_);
    for (size_t n = 0; n < points.count; ++n)
      values[n] = shared::envelope(shape_.distance(offset + glm::vec3(points.x[n], points.y[n], points.z[n])),
                                   falloff);
  }

  /// Planes of 64 points, whose distances are taken in SIMD; a block that bounds find all 0 or all 1 costs no
  /// distance.
  void evaluate(const Lattice& lattice, float* values) const override {
    constexpr double kReach = kBlockEdge - 1;
    const Interval range = bounds({lattice.origin, lattice.origin + kReach * lattice.spacing});
    if (range.exact()) {
      std::fill_n(values, kBlockPoints, float(range.low));
      return;
    }
    // Local copies: the compiler then sees that nothing overlaps the values.
    const Shape shape = shape_;
    const glm::vec3 offset(lattice.origin - centre_);
    const float falloff = float(falloff_);
    constexpr int kPlane = kBlockEdge * kBlockEdge;
    float y[kPlane], z[kPlane];
    for (int n = 0; n < kPlane; ++n) {
      y[n] = float(n / kBlockEdge * lattice.spacing);
      z[n] = float(n % kBlockEdge * lattice.spacing);
    }
    for (int i = 0; i < kBlockEdge; ++i, values += kPlane) {
      const float x = float(i * lattice.spacing);
      for (int n = 0; n < kPlane; ++n)
        values[n] = shared::envelope(shape.distance(offset + glm::vec3(x, y[n], z[n])), falloff);
    }
  }

  Interval bounds(const Box& box) const override {
    const Box local{box.low - centre_, box.high - centre_};
    const Interval distances = shape_.distances(local);
    const double room = distanceRoom(local, shape_.size());
    return envelopeOver({distances.low - room, distances.high + room}, falloff_);
  }

  Box support() const override {
    const Box extent = grown(shape_.extent(), 1e-6 * shape_.size());
    return {extent.low + centre_, extent.high + centre_};
  }

 private:
  glm::dvec3 centre_;
  Shape shape_;
  double falloff_;
};

/// For shapes whose distance grows with |x|, |y| and |z|.
template <class Shape>
Interval distancesByMagnitude(const Shape& shape, const Box& local) {
  return {double(shape.distance(glm::vec3(leastMagnitudes(local)))),
          double(shape.distance(glm::vec3(greatestMagnitudes(local))))};
}

/// For any shape: what lies within half a diagonal of the box's centre differs by no more than that.
template <class Shape>
Interval distancesByCentre(const Shape& shape, const Box& local) {
  const double centre = double(shape.distance(glm::vec3(local.centre()))), reach = lengthOf(local.halfSize());
  return {centre - reach, centre + reach};
}

/// A complaint where one of the numbers or vectors of that name has a size that floats cannot square.
Complaint complainOfSizes(const Arguments& arguments, std::initializer_list<std::string_view> numbers,
                          std::initializer_list<std::string_view> vectors = {});

/// The vector at length 1, or the up axis where it is 0.
glm::dvec3 directionOrUp(const glm::dvec3& given, const BuildContext& context);

/// The parameter `falloff` with a default that suits the shape's own.
Parameter falloffParameter(double fallback);

}  // namespace nephele
