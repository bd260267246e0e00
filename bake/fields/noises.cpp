// The rows of noise: fractal sums over any basis (fbm, ridged, billow), perlin, value, worley, perlin_worley.
// Depends on basis.h, the kernels, table.h and shared text.
#include <algorithm>
#include <cmath>

#include "bake/fields/basis.h"
#include "bake/fields/noise_kernels.h"
#include "bake/fields/rows.h"
#include "bake/fields/shared_text.h"

namespace nephele {
namespace {

/// Σ weight · fold(N) + level: octaves are faded by the band limit, `level` holds the mean of what was faded.
class FractalField final : public Field {
 public:
  FractalField(Basis basis, Fold fold, std::vector<NoiseOctave> octaves, double level)
      : basis_(basis), fold_(fold), octaves_(std::move(octaves)), level_(float(level)) {}

  void evaluate(const Points& points, float* values) const override {
    if (basis_ == Basis::perlin && fold_ == Fold::plain) {
      std::fill_n(values, points.count, level_);
      addNoiseAtPoints(octaves_.data(), octaves_.size(), points, values);
    } else {
      sum(points, points.count, values);
    }
  }
  void evaluate(const Lattice& lattice, float* values) const override {
    if (basis_ == Basis::perlin && fold_ == Fold::plain) {
      std::fill_n(values, kBlockPoints, level_);
      addNoiseOnLattice(octaves_.data(), octaves_.size(), lattice, values);
    } else {
      sum(lattice, kBlockPoints, values);
    }
  }

  Interval bounds(const Box& box) const override {
    Interval total{double(level_), double(level_)};
    for (const NoiseOctave& octave : octaves_)
      total = total + scaled(folded(boundBasis(basis_, octave, box)), double(octave.weight));
    return total;
  }

  Box support() const override { return octaves_.empty() && level_ == 0.0f ? nothing() : Box{}; }

 private:
  template <class Where>
  void sum(const Where& where, size_t count, float* values) const {
    std::fill_n(values, count, level_);
    alignas(kBlockAlignment) float octaveValues[kBlockPoints];
    for (const NoiseOctave& octave : octaves_) {
      evaluateBasis(basis_, octave, where, octaveValues);
      if (fold_ == Fold::plain)
        for (size_t n = 0; n < count; ++n) values[n] += octave.weight * octaveValues[n];
      else if (fold_ == Fold::ridged)
        for (size_t n = 0; n < count; ++n) values[n] += octave.weight * (1.0f - std::abs(octaveValues[n]));
      else
        for (size_t n = 0; n < count; ++n) values[n] += octave.weight * std::abs(octaveValues[n]);
    }
  }

  Interval folded(const Interval& n) const {
    if (fold_ == Fold::plain) return n;
    const double most = std::max(std::abs(n.low), std::abs(n.high));
    const double least = n.low <= 0.0 && n.high >= 0.0 ? 0.0 : std::min(std::abs(n.low), std::abs(n.high));
    return fold_ == Fold::billow ? Interval{least, most} : Interval{1.0, 1.0} - Interval{least, most};
  }

  Basis basis_;
  Fold fold_;
  std::vector<NoiseOctave> octaves_;
  float level_;
};

uint32_t mixedSeed(const Arguments& a, const BuildContext& context, int32_t family) {
  return shared::hashCell({int32_t(uint32_t(a.integer("seed"))), family, 0}, context.seed);
}

/// The parameters that rows of noise share; the seed is left to the caller. Rows of one octave lack those of
/// many.
Fractal fractalOf(const Arguments& a, int64_t octaves) {
  Fractal fractal{a.number("cell_size"), octaves, 2.0, 0.5, a.integer("period"), 0, a.vector("scroll")};
  fractal.evolve = a.number("evolve");
  if (octaves == 1) return fractal;
  fractal.lacunarity = a.number("lacunarity");
  fractal.gain = a.number("gain");
  fractal.fineScroll = a.vector("fine_scroll");
  return fractal;
}

Motion singleMotion(const Arguments& a) { return fractalOf(a, 1).motion(); }
Motion fractalMotion(const Arguments& a) { return fractalOf(a, a.integer("octaves")).motion(); }

std::shared_ptr<FractalField> makeFractal(Basis basis, Fold fold, const Arguments& a,
                                          const BuildContext& context, int64_t octaves, const char* field) {
  Fractal fractal = fractalOf(a, octaves);
  fractal.seed = mixedSeed(a, context, 0);
  std::vector<NoiseOctave> list = fbmOctaves(fractal, context, field);
  double kept = 0.0;
  for (const NoiseOctave& octave : list) kept += double(octave.weight);
  const double level = octaves == 0 ? 0.0 : std::max(0.0, 1.0 - kept) * meanOf(basis, fold);
  return std::make_shared<FractalField>(basis, fold, std::move(list), level);
}

const Parameter kBasis{"basis",
                       ParameterType::choice,
                       "The noise that is summed; worley is 1 - 2 F1, held within [-1, 1].",
                       Value{std::string("perlin")},
                       kAny,
                       {},
                       {"perlin", "value", "worley"}};

std::optional<std::pair<std::string_view, std::string>> validatePeriod(const Arguments& a) {
  const double lacunarity = a.number("lacunarity");
  if (a.integer("period") > 0 && lacunarity != std::floor(lacunarity))
    return {{"lacunarity", "a noise with a period needs a whole lacunarity, or its octaves do not close"}};
  return std::nullopt;
}

template <Fold kFold>
FieldRow fractalRow(std::string_view name, std::string_view sentence) {
  static constexpr const char* kNames[] = {"fbm", "ridged", "billow"};
  return {name,
          sentence,
          {kBasis, kCellSize, kOctaves, kLacunarity, kGain, kSeed, kPeriod, kScroll, kFineScroll, kEvolve},
          [](const Arguments& a, const BuildContext& context) -> FieldPtr {
            return makeFractal(basisOf(a.choice("basis")), kFold, a, context, a.integer("octaves"),
                               kNames[int(kFold)]);
          },
          validatePeriod,
          fractalMotion};
}

/// Mean of the noise's distance, ± 0.001: from 500,000 places at each of five jitters, straight between.
double meanDistance(const WorleyNoise& noise) {
  constexpr double kFirst[] = {0.4804, 0.4829, 0.4920, 0.5059, 0.5207, 0.5207};
  constexpr double kSecond[] = {0.7025, 0.7059, 0.7113, 0.7148, 0.7172, 0.7172};
  const double at = 4.0 * double(noise.jitter);
  const size_t n = size_t(at);
  const double share = at - double(n);
  const double first = kFirst[n] + share * (kFirst[n + 1] - kFirst[n]);
  const double second = kSecond[n] + share * (kSecond[n + 1] - kSecond[n]);
  return noise.output == WorleyOutput::f1   ? first
         : noise.output == WorleyOutput::f2 ? second
                                            : second - first;
}

/// Distances of cellular noise.
class WorleyField final : public Field {
 public:
  /// `kept`: the band limit's weight; the noise's mean stands in for what it takes away.
  WorleyField(const WorleyNoise& noise, const glm::dvec3& offset, double kept)
      : noise_(noise),
        offset_(offset),
        kept_(float(kept)),
        level_(float((1.0 - kept) * meanDistance(noise))) {}
  void evaluate(const Points& points, float* values) const override {
    Points moved = points;
    moved.origin -= offset_;
    if (kept_ > 0.0f) worleyAtPoints(noise_, moved, values);
    fade(points.count, values);
  }
  void evaluate(const Lattice& lattice, float* values) const override {
    if (kept_ > 0.0f) worleyOnLattice(noise_, {lattice.origin - offset_, lattice.spacing}, values);
    fade(kBlockPoints, values);
  }
  Interval bounds(const Box& box) const override {
    if (kept_ == 1.0f) return distances(box);
    if (kept_ == 0.0f) return {double(level_), double(level_)};
    return Interval{double(level_), double(level_)} + scaled(distances(box), double(kept_));
  }
  Box support() const override { return Box{}; }

 private:
  void fade(size_t count, float* values) const {
    if (kept_ == 1.0f) return;
    if (kept_ == 0.0f)
      std::fill_n(values, count, level_);
    else
      for (size_t n = 0; n < count; ++n) values[n] = level_ + kept_ * values[n];
  }

  Interval distances(const Box& box) const {
    // √3 bounds both distances; each changes by at most the way gone, their difference by twice that.
    constexpr double kLargest = 1.7321, kPlaceRoom = 1e-5;
    const Box within = withinMoved(box, offset_);
    const glm::dvec3 half = within.halfSize() / noise_.cellSize;
    const double slope = noise_.output == WorleyOutput::f2MinusF1 ? 2.0 : 1.0;
    const double way = slope * std::sqrt(half.x * half.x + half.y * half.y + half.z * half.z) + kPlaceRoom;
    if (!(way < kLargest)) return {0.0, kLargest};
    const double centre = double(worleyAt(noise_, within.centre()));
    return clamped({centre - way, centre + way}, 0.0, kLargest);
  }

  WorleyNoise noise_;
  glm::dvec3 offset_;  // world units that the pattern has moved
  float kept_, level_;
};

std::shared_ptr<const WorleyField> makeWorley(const Arguments& a, const BuildContext& context,
                                              WorleyOutput output) {
  const OctavePlace place = octavePlace(singleMotion(a), 0, context);
  const double cellVoxels = a.number("cell_size") / context.voxelSize, kept = bandLimit(cellVoxels);
  if (kept < 1.0 && context.notes) context.notes->push_back({"worley", 0, cellVoxels, kept});
  return std::make_shared<WorleyField>(
      WorleyNoise{a.number("cell_size"), float(a.number("jitter")), mixedSeed(a, context, 2),
                  int(a.integer("period")), output, place.turn},
      place.offset, kept);
}

/// Gradient noise and cellular noise as one, in [0, 1].
class PerlinWorley final : public Field {
 public:
  PerlinWorley(FieldPtr perlin, std::shared_ptr<const WorleyField> worley, bool dilate, double amount)
      : perlin_(std::move(perlin)), worley_(std::move(worley)), dilate_(dilate), amount_(float(amount)) {}
  void evaluate(const Points& points, float* values) const override { join(points, points.count, values); }
  void evaluate(const Lattice& lattice, float* values) const override { join(lattice, kBlockPoints, values); }
  Interval bounds(const Box& box) const override {
    const Interval half{0.5, 0.5}, one{1.0, 1.0};
    const Interval p = half + scaled(perlin_->bounds(box), 0.5);
    const Interval w = one - clamped(worley_->bounds(box), 0.0, 1.0);
    // Both forms grow with p and, in [0, 1], with w.
    const auto at = [&](double pv, double wv) {
      return dilate_ ? wv + std::clamp(pv, 0.0, 1.0) * (1.0 - wv) : pv + double(amount_) * (wv - pv);
    };
    return rounded(rounded({at(p.low, w.low), at(p.high, w.high)}));
  }
  Box support() const override { return Box{}; }

 private:
  template <class Where>
  void join(const Where& where, size_t count, float* values) const {
    alignas(kBlockAlignment) float distance[kBlockPoints];
    perlin_->evaluate(where, values);
    worley_->evaluate(where, distance);
    for (size_t n = 0; n < count; ++n) {
      const float p = 0.5f + 0.5f * values[n], w = 1.0f - std::min(distance[n], 1.0f);
      values[n] = dilate_ ? shared::remapRange(p, 0.0f, 1.0f, w, 1.0f) : p + amount_ * (w - p);
    }
  }
  FieldPtr perlin_;
  std::shared_ptr<const WorleyField> worley_;
  bool dilate_;
  float amount_;
};

const Parameter kJitter{"jitter", ParameterType::number,
                        "How far feature points stray from their cells' centres.", Value{1.0}, kUnit};

}  // namespace

FieldRow perlinRow() {
  return {"perlin",
          "Gradient noise in [-1, 1]: 0 at the corners of its cells, smooth between.",
          {kCellSize, kSeed, kPeriod, kScroll, kEvolve},
          [](const Arguments& a, const BuildContext& context) -> FieldPtr {
            return makeFractal(Basis::perlin, Fold::plain, a, context, 1, "perlin");
          },
          nullptr,
          singleMotion};
}

FieldRow valueRow() {
  return {"value",
          "Value noise in [-1, 1]: a random value at each corner of its cells, smooth between.",
          {kCellSize, kSeed, kPeriod, kScroll, kEvolve},
          [](const Arguments& a, const BuildContext& context) -> FieldPtr {
            return makeFractal(Basis::value, Fold::plain, a, context, 1, "value");
          },
          nullptr,
          singleMotion};
}

FieldRow fbmRow() {
  return fractalRow<Fold::plain>(
      "fbm", "Fractal sum of noise in [-1, 1]; octaves finer than the grid can hold are left out.");
}

FieldRow ridgedRow() {
  return fractalRow<Fold::ridged>(
      "ridged", "Fractal sum of 1 - |noise| in [0, 1]: sharp crests where the noise crosses 0.");
}

FieldRow billowRow() {
  return fractalRow<Fold::billow>(
      "billow", "Fractal sum of |noise| in [0, 1]: round lumps with sharp creases between.");
}

FieldRow worleyRow() {
  return {
      "worley",
      "Cellular noise: distances, in cells, to the nearest feature points; 0 up to 1.732.",
      {kCellSize,
       {"output",
        ParameterType::choice,
        "Distance to the nearest (f1), to the second nearest (f2), or their difference, which is 0 between "
        "cells.",
        Value{std::string("f1")},
        kAny,
        {},
        {"f1", "f2", "f2_minus_f1"}},
       kJitter,
       kSeed,
       kPeriod,
       kScroll,
       kEvolve},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        const std::string& output = a.choice("output");
        return makeWorley(a, context,
                          output == "f1"   ? WorleyOutput::f1
                          : output == "f2" ? WorleyOutput::f2
                                           : WorleyOutput::f2MinusF1);
      },
      nullptr,
      singleMotion};
}

FieldRow perlinWorleyRow() {
  return {
      "perlin_worley",
      "Gradient noise with the round lumps of cellular noise, in [0, 1].",
      {kCellSize,
       {"form",
        ParameterType::choice,
        "dilate: fBm P lifted by W, remap(P, 0, 1, W, 1); mix: P + amount (W - P); W is 1 - F1.",
        Value{std::string("dilate")},
        kAny,
        {},
        {"dilate", "mix"}},
       {"amount", ParameterType::number, "Share of the cellular noise where form is mix.", Value{0.5}, kUnit},
       kOctaves,
       kLacunarity,
       kGain,
       kJitter,
       kSeed,
       kPeriod,
       kScroll,
       kFineScroll,
       kEvolve},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        return std::make_shared<PerlinWorley>(
            makeFractal(Basis::perlin, Fold::plain, a, context, a.integer("octaves"), "perlin_worley"),
            makeWorley(a, context, WorleyOutput::f1), a.choice("form") == "dilate", a.number("amount"));
      },
      validatePeriod,
      fractalMotion};
}

}  // namespace nephele
