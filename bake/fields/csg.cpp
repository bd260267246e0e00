// Set operations on densities: union, intersection, difference, smooth_union. Depends on fold.h and shared
// text.
#include "bake/fields/fold.h"
#include "bake/fields/rows.h"
#include "bake/fields/shared_text.h"

namespace nephele {
namespace {

const Interval kZero{0.0, 0.0};

/// Negative values of the first input count as 0, as those of the others do.
struct SetFold : Fold {
  static float start(float a) { return std::max(a, 0.0f); }
  static Interval startOver(const Interval& a) { return maximum(a, kZero); }
};

struct Union : SetFold {
  static constexpr bool kZeroStays = false, kZeroAddsNothing = true;
  static float apply(float a, float b) { return shared::uniteDensities(a, b); }
  static Interval join(const Interval& a, const Interval& b) { return maximum(a, b); }
  static Box hold(const Box& a, const Box& b) { return hull(a, b); }
};

struct Intersection : SetFold {
  static constexpr bool kZeroStays = true;
  static float apply(float a, float b) { return shared::intersectDensities(a, b); }
  static Interval join(const Interval& a, const Interval& b) { return maximum(minimum(a, b), kZero); }
  static Box hold(const Box& a, const Box& b) { return intersection(a, b); }
};

struct Difference : SetFold {
  static constexpr bool kZeroStays = true;
  static float apply(float a, float b) { return shared::subtractDensity(a, b); }
  /// It grows with a and falls with b, so its ends are at theirs.
  static Interval join(const Interval& a, const Interval& b) {
    return {at(a.low, b.high) * (1.0 - kRoom), at(a.high, b.low) * (1.0 + kRoom)};
  }
  static Box hold(const Box& a, const Box&) { return a; }

 private:
  static constexpr double kRoom = 1e-6;  // three roundings in floats

  static double at(double a, double b) {
    return std::max(std::min(a, std::max(a, 1.0) * (1.0 - std::clamp(b, 0.0, 1.0))), 0.0);
  }
};

struct SmoothUnion : SetFold {
  static constexpr bool kZeroStays = false;
  float blend = 0.0f;
  float apply(float a, float b) const { return shared::uniteSmoothly(a, b, blend); }
  /// It grows with both, so its ends are at theirs; never below the greater, nor above it and 1.
  Interval join(const Interval& a, const Interval& b) const {
    const Interval most = maximum(maximum(a, b), kZero);
    return {std::max(most.low, at(a.low, b.low) * (1.0 - kRoom)),
            std::min(std::max(most.high, 1.0), at(a.high, b.high) * (1.0 + kRoom))};
  }
  static Box hold(const Box& a, const Box& b) { return hull(a, b); }

 private:
  static constexpr double kRoom = 1e-6;  // a dozen roundings in floats

  double at(double a, double b) const {
    const double most = std::max({a, b, 0.0}), least = std::max(std::min(a, b), 0.0);
    const double k = std::min(double(blend), least), near = k - (most - least);
    return near > 0.0 ? std::min(most + near * near / (4.0 * k), std::max(most, 1.0)) : most;
  }
};

}  // namespace

FieldRow unionRow() {
  return {"union",
          "What is in any of its inputs: the greatest density. Negative values count as 0.",
          {kInputs},
          buildFold<Union>};
}

FieldRow intersectionRow() {
  return {"intersection",
          "What is in all of its inputs: the least density. Negative values count as 0.",
          {kInputs},
          buildFold<Intersection>};
}

FieldRow differenceRow() {
  return {"difference",
          "What is in its first input a and in none of the others b: min(a, max(a, 1) (1 - b)), b held "
          "within 0 and 1. Where b is 0 nothing is taken away, where it is 1 all.",
          {kInputs},
          buildFold<Difference>};
}

FieldRow smoothUnionRow() {
  return {
      "smooth_union",
      "What is in any of its inputs, thicker where two of them meet: the greatest density, raised by up to "
      "a quarter of `blend` where two are alike, though not above 1. Ends where its inputs end.",
      {kInputs,
       {"blend", ParameterType::number, "How alike two densities must be to melt together.", Value{0.3},
        kNonNegative, "density"}},
      [](const Arguments& a, const BuildContext&) -> FieldPtr {
        SmoothUnion rule;
        rule.blend = float(a.number("blend"));
        return std::make_shared<FoldField<SmoothUnion>>(a.fields("inputs"), rule);
      }};
}

}  // namespace nephele
