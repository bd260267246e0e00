// A density field: values at points, an interval that bounds them in a box, and the box outside which they
// are 0. Depends on base and shared text alone: no OpenVDB, GL, YAML, clock or thread id in here.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "bake/fields/interval.h"

namespace nephele {

inline constexpr int kBlockEdge = 8;
inline constexpr int kBlockPoints = kBlockEdge * kBlockEdge * kBlockEdge;
/// Bytes of the widest vector: arrays of a block's points that begin on such a border are read without a
/// vector ever lying on two lines of the cache. Good to have, never needed.
inline constexpr size_t kBlockAlignment = 64;

/// 8³ points origin + spacing · (i, j, k), world units, ordered as an OpenVDB leaf: k (z) fastest, then j,
/// then i.
struct Lattice {
  glm::dvec3 origin{0.0};
  double spacing = 1.0;  // > 0
};

/// Up to 512 points origin + (x[n], y[n], z[n]), world units. The origin is double and the offsets are small,
/// so that fields keep their precision far from the world's origin.
struct Points {
  glm::dvec3 origin{0.0};
  size_t count = 0;
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
};

/// The closed box [low, high], world units. May be infinite; empty where low > high on any axis.
struct Box {
  glm::dvec3 low{-std::numeric_limits<double>::infinity()};
  glm::dvec3 high{std::numeric_limits<double>::infinity()};

  bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  glm::dvec3 centre() const { return 0.5 * (low + high); }
  glm::dvec3 halfSize() const { return 0.5 * (high - low); }
};
Box nothing();
Box intersection(const Box& a, const Box& b);
/// The smallest box that holds both; empty boxes add nothing.
Box hull(const Box& a, const Box& b);
Box grown(const Box& box, double by);
/// Grown by four units in the last place of its coordinates: holds the points of a lattice whose corners it
/// was made from, and what fields make of them, however those doubles are rounded.
Box roundedOutwards(const Box& box);
/// The box in a pattern that has moved by `offset`, rounded outwards: holds whatever a point less the offset
/// rounds to.
Box withinMoved(const Box& box, const glm::dvec3& offset);

/// Immutable once built; every method may be called from any number of threads.
class Field {
 public:
  virtual ~Field() = default;

  /// Values at points. `values` holds points.count floats and does not overlap the coordinates.
  virtual void evaluate(const Points& points, float* values) const = 0;

  /// Values on a lattice block (512 floats): the same numbers as at its points up to the error that the
  /// field's row in the table states, and equal on every machine. Fields with a faster way on a lattice
  /// override this.
  virtual void evaluate(const Lattice& lattice, float* values) const;

  /// An interval that certainly contains every value that either evaluate() gives in the box, rounding to
  /// floats included; that of the box's own doubles is the caller's (roundedOutwards). The box is finite and
  /// not empty.
  virtual Interval bounds(const Box& box) const = 0;

  /// A box outside which every value is exactly 0. Infinite where there is none.
  virtual Box support() const = 0;
};
using FieldPtr = std::shared_ptr<const Field>;

/// A lattice block's points as coordinate arrays, for fields that work on points.
struct LatticePoints {
  explicit LatticePoints(const Lattice& lattice);
  Points points() const;

  glm::dvec3 origin;
  alignas(kBlockAlignment) float x[kBlockPoints];
  alignas(kBlockAlignment) float y[kBlockPoints];
  alignas(kBlockAlignment) float z[kBlockPoints];
};

}  // namespace nephele
