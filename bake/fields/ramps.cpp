// Ramps along an axis: the rows linear and exponential. Depends on envelope_field.h for directions, and on
// shared text.
#include <algorithm>

#include "bake/fields/envelope_field.h"
#include "bake/fields/rows.h"

namespace nephele {
namespace {

double along(const glm::dvec3& p, const glm::dvec3& direction) {
  return p.x * direction.x + p.y * direction.y + p.z * direction.z;
}

/// A function of (height − start)/length, the height measured along a unit vector. Shape gives: value(float)
/// at such a height, monotone; its ends for support.
template <class Shape>
class Ramp final : public Field {
 public:
  Ramp(const glm::dvec3& direction, double start, double length, const Shape& shape)
      : direction_(direction), start_(start), length_(length), shape_(shape) {}

  void evaluate(const Points& points, float* values) const override {
    const double origin = along(points.origin, direction_) - start_;
    for (size_t n = 0; n < points.count; ++n) {
      const glm::dvec3 p(double(points.x[n]), double(points.y[n]), double(points.z[n]));
      values[n] = shape_.value(float((origin + along(p, direction_)) / length_));
    }
  }

  Interval bounds(const Box& box) const override {
    const glm::dvec3 centre = box.centre(), half = box.halfSize();
    double reach = 0.0;
    for (int axis = 0; axis < 3; ++axis) reach += std::abs(direction_[axis]) * half[axis];
    const double height = along(centre, direction_) - start_;
    // Rounding of the height as a float, and of the points' offsets in a block.
    const double room = 1e-6 * (reach + std::abs(height)) + 1e-12 * std::abs(start_);
    double low = (height - reach - room) / length_, high = (height + reach + room) / length_;
    if (low > high) std::swap(low, high);
    return shape_.over(low, high);
  }

  Box support() const override {
    const auto [low, high] = shape_.ends();
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(direction_[axis]) != 1.0) continue;
      double from = start_ + low * length_, to = start_ + high * length_;
      if (from > to) std::swap(from, to);
      const double room = 1e-6 * (std::abs(start_) + std::abs(length_));
      if (direction_[axis] < 0.0) std::tie(from, to) = std::pair{-to, -from};
      box.low[axis] = from - room;
      box.high[axis] = to + room;
    }
    return box;
  }

 private:
  glm::dvec3 direction_;
  double start_, length_;
  Shape shape_;
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Exact where all is one value at an end, with room for a few roundings elsewhere.
Interval between(float a, float b) {
  if (a == b) return {double(a), double(a)};
  const Interval all{double(std::min(a, b)), double(std::max(a, b))};
  const double room = 1e-6 * std::max(std::abs(all.low), std::abs(all.high));
  return {all.low - room, all.high + room};
}

struct Linear {
  float from, to;
  float value(float at) const { return shared::linearRamp(at, from, to); }
  Interval over(double low, double high) const {
    if (high <= 0.0 || low >= 1.0 || from == to) return between(value(float(low)), value(float(high)));
    const Interval inside = between(value(float(low)), value(float(high)));
    // A weighted mean rounds by less than this beyond its ends.
    const double room = 1e-6 * std::max(std::abs(double(from)), std::abs(double(to)));
    return {inside.low - room, inside.high + room};
  }
  std::pair<double, double> ends() const {
    return {from == 0.0f ? 0.0 : -kInfinity, to == 0.0f ? 1.0 : kInfinity};
  }
};

struct Exponential {
  float base, below;  // below: 0 or 1
  float value(float at) const { return shared::exponentialRamp(at, base, below); }
  Interval over(double low, double high) const {
    const Interval falling = between(value(float(std::max(low, 0.0))), value(float(std::max(high, 0.0))));
    return low < 0.0 ? hullOf(falling, between(value(float(low)), base * below)) : falling;
  }
  std::pair<double, double> ends() const {
    constexpr double kVanishes = 87.0;  // exponential(−87) is the last that is not 0
    return {below == 0.0f ? 0.0 : -kInfinity, kVanishes};
  }
};

const Parameter kDirection{"direction", ParameterType::vector,
                           "What height is measured along, at any length; [0, 0, 0]: the up axis.",
                           Value{std::array<double, 3>{0, 0, 0}}};

Complaint validateLinear(const Arguments& a) {
  if (a.number("from") == a.number("to"))
    return {{"to", "'from' and 'to' are equal, so the ramp has no height"}};
  return std::nullopt;
}

Complaint validateExponential(const Arguments& a) { return complainOfSizes(a, {"scale_height"}); }

}  // namespace

FieldRow linearRow() {
  return {"linear",
          "A straight ramp over height, from one value to another, constant beyond its ends.",
          {{"from", ParameterType::number, "Height of the first value.", Value{-1.0}, kAny, "world units"},
           {"to", ParameterType::number, "Height of the second value.", Value{1.0}, kAny, "world units"},
           {"values", ParameterType::pair, "The values there.", Value{std::array<double, 2>{1, 0}}},
           kDirection},
          [](const Arguments& a, const BuildContext& context) -> FieldPtr {
            const auto& values = a.pair("values");
            return std::make_shared<Ramp<Linear>>(directionOrUp(a.vector("direction"), context),
                                                  a.number("from"), a.number("to") - a.number("from"),
                                                  Linear{float(values[0]), float(values[1])});
          },
          validateLinear};
}

FieldRow exponentialRow() {
  return {
      "exponential",
      "value * e^(-(height - base)/scale_height): thins out upwards as the air does, and is exactly 0 from "
      "87 scale heights on.",
      {{"base", ParameterType::number, "Height where it starts.", Value{-1.0}, kAny, "world units"},
       {"value", ParameterType::number, "Its value there.", Value{1.0}},
       {"scale_height", ParameterType::number, "Height over which it falls to 1/e.", Value{0.5}, kPositive,
        "world units"},
       {"below",
        ParameterType::choice,
        "Under the base: the value there, or nothing.",
        Value{std::string("value")},
        {},
        {},
        {"value", "nothing"}},
       kDirection},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        return std::make_shared<Ramp<Exponential>>(
            directionOrUp(a.vector("direction"), context), a.number("base"), a.number("scale_height"),
            Exponential{float(a.number("value")), a.choice("below") == "value" ? 1.0f : 0.0f});
      },
      validateExponential};
}

}  // namespace nephele
