// Fields made of fields, value by value: constant, add, multiply, min, max, mix, remap. Depends on field.h
// and shared text.
#include <algorithm>

#include "bake/fields/fold.h"
#include "bake/fields/rows.h"
#include "bake/fields/shared_text.h"

namespace nephele {
namespace {

class Constant final : public Field {
 public:
  explicit Constant(double value) : value_(float(value)) {}
  void evaluate(const Points& points, float* values) const override {
    std::fill_n(values, points.count, value_);
  }
  void evaluate(const Lattice&, float* values) const override { std::fill_n(values, kBlockPoints, value_); }
  Interval bounds(const Box&) const override { return {double(value_), double(value_)}; }
  Box support() const override { return value_ == 0.0f ? nothing() : Box{}; }

 private:
  float value_;
};

struct Add : Fold {
  static constexpr bool kZeroStays = false, kZeroAddsNothing = true;
  static float apply(float a, float b) { return a + b; }
  static Interval join(const Interval& a, const Interval& b) { return a + b; }
  static Box hold(const Box& a, const Box& b) { return hull(a, b); }
};
struct Multiply : Fold {
  static constexpr bool kZeroStays = true;
  static float apply(float a, float b) { return a * b; }
  static Interval join(const Interval& a, const Interval& b) { return a * b; }
  static Box hold(const Box& a, const Box& b) { return intersection(a, b); }
};
struct Min : Fold {
  static constexpr bool kZeroStays = false;
  static float apply(float a, float b) { return std::min(a, b); }
  static Interval join(const Interval& a, const Interval& b) { return minimum(a, b); }
  static Box hold(const Box& a, const Box& b) { return hull(a, b); }
};
struct Max : Fold {
  static constexpr bool kZeroStays = false;
  static float apply(float a, float b) { return std::max(a, b); }
  static Interval join(const Interval& a, const Interval& b) { return maximum(a, b); }
  static Box hold(const Box& a, const Box& b) { return hull(a, b); }
};

/// a + (b − a) · t.
class Mix final : public Field {
 public:
  Mix(FieldPtr a, FieldPtr b, FieldPtr t)
      : a_(std::move(a)), b_(std::move(b)), t_(std::move(t)), support_(hull(a_->support(), b_->support())) {}
  void evaluate(const Points& points, float* values) const override { mixAt(points, values); }
  void evaluate(const Lattice& lattice, float* values) const override { mixAt(lattice, values); }
  Interval bounds(const Box& box) const override {
    const Interval a = a_->bounds(box), b = b_->bounds(box), t = t_->bounds(box);
    if (a.isFloat() && b.isFloat() && t.isFloat())
      return single(mixed(float(a.low), float(b.low), float(t.low)));
    const Interval plain = a + (b - a) * t;
    if (t.low < 0.0 || t.high > 1.0) return plain;
    // A weight in [0, 1] stays between the two; room for the three operations.
    const double room =
        1e-6 * std::max({std::abs(a.low), std::abs(a.high), std::abs(b.low), std::abs(b.high)});
    const Interval between = hullOf(a, b);
    return both(plain, {between.low - room, between.high + room});
  }
  Box support() const override { return support_; }

 private:
  static float mixed(float a, float b, float t) { return a + (b - a) * t; }
  template <class Where>
  void mixAt(const Where& where, float* values) const {
    alignas(kBlockAlignment) float b[kBlockPoints];
    alignas(kBlockAlignment) float t[kBlockPoints];
    a_->evaluate(where, values);
    b_->evaluate(where, b);
    t_->evaluate(where, t);
    for (size_t n = 0; n < countOf(where); ++n) values[n] = mixed(values[n], b[n], t[n]);
  }
  FieldPtr a_, b_, t_;
  Box support_;  // kept, as folds keep theirs
};

class Remap final : public Field {
 public:
  Remap(FieldPtr input, std::array<double, 2> from, std::array<double, 2> to)
      : input_(std::move(input)), from_(from), to_(to) {}
  void evaluate(const Points& points, float* values) const override { remapAt(points, values); }
  void evaluate(const Lattice& lattice, float* values) const override { remapAt(lattice, values); }
  Interval bounds(const Box& box) const override {
    const Interval v = input_->bounds(box);
    const double p = at(float(v.low)), q = at(float(v.high));
    if (v.isFloat()) return {p, p};
    // The remap is monotone; its float form errs by a few roundings of its two ends.
    const double room = 1e-6 * (std::abs(to_[0]) + std::abs(to_[1]));
    return {std::min(p, q) - room, std::max(p, q) + room};
  }
  Box support() const override { return at(0.0f) == 0.0 ? input_->support() : Box{}; }

 private:
  double at(float v) const {
    return double(shared::remapRange(v, float(from_[0]), float(from_[1]), float(to_[0]), float(to_[1])));
  }
  template <class Where>
  void remapAt(const Where& where, float* values) const {
    input_->evaluate(where, values);
    for (size_t n = 0; n < countOf(where); ++n)
      values[n] =
          shared::remapRange(values[n], float(from_[0]), float(from_[1]), float(to_[0]), float(to_[1]));
  }
  FieldPtr input_;
  std::array<double, 2> from_, to_;
};

std::optional<std::pair<std::string_view, std::string>> validateRemap(const Arguments& a) {
  const auto& from = a.pair("from");
  if (float(from[0]) == float(from[1]))
    return {{"from", "both ends of 'from' are equal, so nothing can be told apart"}};
  return std::nullopt;
}

}  // namespace

FieldRow constantRow() {
  return {"constant",
          "One value everywhere. A bare number means the same.",
          {{"value", ParameterType::number, "The value.", Value{1.0}}},
          [](const Arguments& a, const BuildContext&) -> FieldPtr {
            return std::make_shared<Constant>(a.number("value"));
          }};
}
FieldRow addRow() { return {"add", "The sum of its inputs.", {kInputs}, buildFold<Add>}; }
FieldRow multiplyRow() {
  return {
      "multiply",
      "The product of its inputs; put the one that is 0 most often first, the rest is not computed there.",
      {kInputs},
      buildFold<Multiply>};
}
FieldRow minRow() { return {"min", "The least of its inputs.", {kInputs}, buildFold<Min>}; }
FieldRow maxRow() { return {"max", "The greatest of its inputs.", {kInputs}, buildFold<Max>}; }
FieldRow mixRow() {
  return {"mix",
          "From a to b as t goes from 0 to 1: a + (b - a) t.",
          {{"a", ParameterType::field, "Taken where t is 0.", std::nullopt},
           {"b", ParameterType::field, "Taken where t is 1.", std::nullopt},
           {"t", ParameterType::field, "The weight of b.", std::nullopt}},
          [](const Arguments& a, const BuildContext&) -> FieldPtr {
            return std::make_shared<Mix>(a.field("a"), a.field("b"), a.field("t"));
          }};
}
FieldRow remapRow() {
  return {"remap",
          "Its input, held within `from` and stretched to `to`; either may be reversed.",
          {{"input", ParameterType::field, "What is remapped.", std::nullopt},
           {"from", ParameterType::pair, "Input range.", Value{std::array<double, 2>{0, 1}}},
           {"to", ParameterType::pair, "Output range.", Value{std::array<double, 2>{0, 1}}}},
          [](const Arguments& a, const BuildContext&) -> FieldPtr {
            return std::make_shared<Remap>(a.field("input"), a.pair("from"), a.pair("to"));
          },
          validateRemap};
}

}  // namespace nephele
