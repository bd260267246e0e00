// Profiles over height: the row height_profile. Depends on field.h.
#include <algorithm>

#include "bake/fields/rows.h"

namespace nephele {
namespace {

/// A curve of the height along the up axis, (h − base)/(top − base).
class HeightProfile final : public Field {
 public:
  HeightProfile(double base, double top, Curve curve, int upAxis)
      : base_(base), top_(top), curve_(std::move(curve)), upAxis_(upAxis) {}

  void evaluate(const Points& points, float* values) const override {
    const float* const along = upAxis_ == 1 ? points.y : points.z;
    const double start = points.origin[upAxis_] - base_;
    for (size_t n = 0; n < points.count; ++n)
      values[n] = float(valueAt((start + double(along[n])) / (top_ - base_)));
  }

  Interval bounds(const Box& box) const override {
    double from = (box.low[upAxis_] - base_) / (top_ - base_),
           to = (box.high[upAxis_] - base_) / (top_ - base_);
    if (from > to) std::swap(from, to);
    // Offsets inside a block are floats: one part in 10^6 of the block's span.
    const double room = 1e-6 * (to - from) + 1e-12 * std::max(std::abs(from), std::abs(to));
    from -= room;
    to += room;
    Interval all = hullOf(exactly(valueAt(from)), exactly(valueAt(to)));
    for (const auto& [x, y] : curve_)
      if (from <= x && x <= to) all = hullOf(all, exactly(y));
    return all.exact() ? all : rounded(all);
  }

  Box support() const override {
    Box box;
    const double low = worldOf(curve_.front()[0]), high = worldOf(curve_.back()[0]);
    if (curve_.front()[1] == 0.0) (base_ < top_ ? box.low : box.high)[upAxis_] = low;
    if (curve_.back()[1] == 0.0) (base_ < top_ ? box.high : box.low)[upAxis_] = high;
    return box;
  }

 private:
  double worldOf(double height) const { return base_ + height * (top_ - base_); }
  /// Values are floats, and one that holds throughout is to be known exactly.
  static Interval exactly(double value) { return {double(float(value)), double(float(value))}; }
  double valueAt(double height) const {
    if (height <= curve_.front()[0]) return curve_.front()[1];
    if (height >= curve_.back()[0]) return curve_.back()[1];
    const auto after = std::upper_bound(curve_.begin(), curve_.end(), height,
                                        [](double h, const std::array<double, 2>& p) { return h < p[0]; });
    const auto& [x1, y1] = *after;
    const auto& [x0, y0] = *(after - 1);
    return y0 + (height - x0) / (x1 - x0) * (y1 - y0);
  }

  double base_, top_;
  Curve curve_;
  int upAxis_;
};

std::optional<std::pair<std::string_view, std::string>> validate(const Arguments& a) {
  if (a.number("base") == a.number("top"))
    return {{"top", "'base' and 'top' are equal, so the profile has no height"}};
  return std::nullopt;
}

}  // namespace

FieldRow heightProfileRow() {
  return {
      "height_profile",
      "A curve over the height along the up axis, 0 at base and 1 at top; by default it cuts the lower half.",
      {{"base", ParameterType::number, "Height 0 of the curve.", Value{-1.0}, kAny, "world units"},
       {"top", ParameterType::number, "Height 1 of the curve.", Value{1.0}, kAny, "world units"},
       {"curve", ParameterType::curve, "Points [height, value], straight between, constant beyond the ends.",
        Value{Curve{{0.5, 0.0}, {1.0, 1.0}}}}},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        return std::make_shared<HeightProfile>(a.number("base"), a.number("top"), a.curve("curve"),
                                               context.upAxis);
      },
      validate};
}

}  // namespace nephele
