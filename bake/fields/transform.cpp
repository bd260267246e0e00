// A field scaled, turned and moved: the row transform. Depends on field.h, turn.h, motion.h.
#include "bake/fields/transform.h"

#include <cmath>
#include <glm/matrix.hpp>

#include "bake/fields/motion.h"
#include "bake/fields/rows.h"

namespace nephele {
namespace {

class Placed final : public Field {
 public:
  Placed(FieldPtr input, const Placement& placement) : input_(std::move(input)), placement_(placement) {
    const glm::dmat3& m = placement.localFromWorld;
    keepsLattices_ = m == glm::dmat3(m[0][0]) && m[0][0] > 0.0;
  }

  void evaluate(const Points& points, float* values) const override {
    float local[3][kBlockPoints];
    const glm::mat3 m(placement_.localFromWorld);
    for (int axis = 0; axis < 3; ++axis)
      for (size_t n = 0; n < points.count; ++n)
        local[axis][n] = m[0][axis] * points.x[n] + m[1][axis] * points.y[n] + m[2][axis] * points.z[n];
    input_->evaluate(Points{localOf(points.origin), points.count, local[0], local[1], local[2]}, values);
  }

  /// One scale for all axes and no turn: a lattice stays one.
  void evaluate(const Lattice& lattice, float* values) const override {
    if (keepsLattices_)
      input_->evaluate(Lattice{localOf(lattice.origin), lattice.spacing * placement_.localFromWorld[0][0]},
                       values);
    else
      evaluate(LatticePoints(lattice).points(), values);
  }

  Interval bounds(const Box& box) const override {
    const Box local =
        imageOf(box, placement_.localFromWorld, -(placement_.localFromWorld * placement_.offset));
    // Offsets from a block's corner are floats, of up to the box's size and its distance from the origin,
    // mixed from three.
    constexpr double kRoom = 2e-6;
    double size = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      size = std::max(
          {size, local.high[axis] - local.low[axis], std::abs(local.low[axis]), std::abs(local.high[axis])});
    return input_->bounds(grown(local, kRoom * size));
  }

  Box support() const override {
    const Box inner = input_->support();
    if (inner.empty()) return inner;
    const Box image = imageOf(inner, placement_.worldFromLocal, placement_.offset);
    const glm::dvec3 size = image.high - image.low;
    Box support = image;
    for (int axis = 0; axis < 3; ++axis) {  // a hair for the rounding of places
      constexpr double kHair = 2e-6;
      const double reach = std::isfinite(size[axis]) ? size[axis] : 0.0;
      support.low[axis] -= kHair * reach;
      support.high[axis] += kHair * reach;
    }
    return support;
  }

 private:
  glm::dvec3 localOf(const glm::dvec3& world) const {
    return placement_.localFromWorld * (world - placement_.offset);
  }

  /// The box that holds the image of a box that may be infinite.
  static Box imageOf(const Box& box, const glm::dmat3& m, const glm::dvec3& offset) {
    Box image{offset, offset};
    for (int axis = 0; axis < 3; ++axis)
      for (int from = 0; from < 3; ++from) {
        const double factor = m[from][axis];
        if (factor == 0.0) continue;
        const double a = factor * box.low[from], b = factor * box.high[from];
        image.low[axis] += std::min(a, b);
        image.high[axis] += std::max(a, b);
      }
    return image;
  }

  FieldPtr input_;
  Placement placement_;
  bool keepsLattices_ = false;
};

/// A turn by an angle in degrees that takes `from` towards `to`.
glm::dmat3 turned(double degrees, int from, int to) {
  constexpr double kFullTurn = 360.0;
  const auto [cosine, sine] = cosineAndSine(degrees / kFullTurn);
  glm::dmat3 m(1.0);
  m[from][from] = m[to][to] = cosine;
  m[from][to] = sine;
  m[to][from] = -sine;
  return m;
}

Motion motionOf(const Arguments& a) {
  Motion motion;
  motion.scroll = a.vector("scroll");
  motion.repeats = false;
  return motion;
}

/// Scales and places beyond these would leave no digit of a place.
constexpr Range kScaleRange{1e-6, 1e6, false, false};
constexpr Range kPlaceRange{-1e9, 1e9, false, false};
constexpr Range kAngleRange{-36000.0, 36000.0, false, false};

}  // namespace

Placement placementOf(const Arguments& a, const BuildContext& context) {
  const glm::dvec3 scale = a.vector("scale"), angles = a.vector("rotate"), center = a.vector("center");
  const glm::dmat3 turn = turned(angles.z, 0, 1) * turned(angles.y, 2, 0) * turned(angles.x, 1, 2);
  glm::dmat3 stretch(1.0), shrink(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    stretch[axis][axis] = scale[axis];
    shrink[axis][axis] = 1.0 / scale[axis];
  }
  Placement placement;
  placement.worldFromLocal = turn * stretch;
  placement.localFromWorld = shrink * glm::transpose(turn);
  placement.offset = center + a.vector("translate") + octavePlace(motionOf(a), 0, context).offset -
                     placement.worldFromLocal * center;
  placement.leastScale = std::min({scale.x, scale.y, scale.z});
  return placement;
}

FieldPtr placedField(FieldPtr input, const Placement& placement) {
  return std::make_shared<Placed>(std::move(input), placement);
}

FieldRow transformRow() {
  const std::array<double, 3> zero{0, 0, 0};
  return {"transform",
          "Its input stretched, turned and moved: noise becomes streaks, shapes lie aslant.",
          {{"input", ParameterType::field, "What is placed.", std::nullopt},
           {"scale", ParameterType::vector, "How many times larger along each axis of the input.",
            Value{std::array<double, 3>{1, 1, 1}}, kScaleRange},
           {"rotate", ParameterType::vector, "Angles about x, then y, then z.", Value{zero}, kAngleRange,
            "degrees"},
           {"center", ParameterType::vector, "The place that scale and rotate leave where it is.",
            Value{zero}, kPlaceRange, "world units"},
           {"translate", ParameterType::vector, "How far it is then moved.", Value{zero}, kPlaceRange,
            "world units"},
           kScroll},
          [](const Arguments& a, const BuildContext& context) -> FieldPtr {
            return placedField(a.field("input"), placementOf(a, context));
          },
          nullptr,
          motionOf,
          [](const Arguments& a, const BuildContext& context) {
            // A cell that is made smaller along any axis spans fewer voxels there.
            BuildContext inner = context;
            inner.voxelSize = context.voxelSize / placementOf(a, context).leastScale;
            return inner;
          }};
}

}  // namespace nephele
