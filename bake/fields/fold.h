// A field that folds a list of fields into one, value by value. Depends on field.h and table.h.
#pragma once

#include <algorithm>

#include "bake/fields/table.h"

namespace nephele {

inline size_t countOf(const Points& points) { return points.count; }
inline size_t countOf(const Lattice&) { return size_t(kBlockPoints); }

/// What a fold does with its first input: takes it as it is. Folds hide what they do otherwise.
struct Fold {
  static float start(float a) { return a; }
  static Interval startOver(const Interval& a) { return a; }
  static constexpr bool kZeroAddsNothing = false;
};

/// A fold over a list. Rule gives, beside what Fold does: apply(sum, value), join(Interval, Interval) over
/// the same, hold(Box, Box) of supports, and kZeroStays: whether what is 0 stays so whatever follows. Where
/// kZeroAddsNothing, an input that is 0 throughout changes nothing and is not evaluated.
template <class Rule>
class FoldField final : public Field {
 public:
  FoldField(std::vector<FieldPtr> inputs, Rule rule) : inputs_(std::move(inputs)), rule_(rule) {
    for (const FieldPtr& input : inputs_) supports_.push_back(input->support());
    support_ = supports_.front();
    for (size_t i = 1; i < supports_.size(); ++i) support_ = rule_.hold(support_, supports_[i]);
  }

  void evaluate(const Points& points, float* values) const override { fold(points, values); }
  void evaluate(const Lattice& lattice, float* values) const override { fold(lattice, values); }

  Interval bounds(const Box& box) const override {
    Interval sum = rule_.startOver(inputs_.front()->bounds(box));
    for (size_t i = 1; i < inputs_.size(); ++i) {
      if (Rule::kZeroStays && sum.low == 0.0 && sum.high == 0.0) break;
      const Interval next = inputs_[i]->bounds(box);
      sum = sum.isFloat() && next.isFloat() ? single(rule_.apply(float(sum.low), float(next.low)))
                                            : rule_.join(sum, next);
    }
    return sum;
  }

  Box support() const override { return support_; }

 private:
  /// Whether all of a block lies where a field with this support is 0. Points are not asked.
  static bool misses(const Lattice& block, const Box& support) {
    constexpr double kReach = kBlockEdge - 1;
    return intersection(support, {block.origin, block.origin + kReach * block.spacing}).empty();
  }
  static bool misses(const Points&, const Box&) { return false; }

  template <class Where>
  void fold(const Where& where, float* values) const {
    const size_t count = countOf(where);
    inputs_.front()->evaluate(where, values);
    for (size_t n = 0; n < count; ++n) values[n] = rule_.start(values[n]);
    for (size_t i = 1; i < inputs_.size(); ++i) {
      if (Rule::kZeroStays && std::all_of(values, values + count, [](float v) { return v == 0.0f; })) return;
      if (Rule::kZeroAddsNothing && misses(where, supports_[i])) continue;
      alignas(kBlockAlignment) float next[kBlockPoints];
      inputs_[i]->evaluate(where, next);
      for (size_t n = 0; n < count; ++n) values[n] = rule_.apply(values[n], next[n]);
    }
  }

  std::vector<FieldPtr> inputs_;
  // Kept, since aliases may make the same input a part of a field in very many ways.
  std::vector<Box> supports_;
  Box support_;
  Rule rule_;
};

inline const Parameter kInputs{"inputs", ParameterType::fields, "One field or more, in order.", std::nullopt};

/// For rows whose list is called `inputs` and whose rule needs no numbers.
template <class Rule>
FieldPtr buildFold(const Arguments& a, const BuildContext&) {
  return std::make_shared<FoldField<Rule>>(a.fields("inputs"), Rule{});
}

}  // namespace nephele
