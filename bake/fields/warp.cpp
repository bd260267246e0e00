// Domain warp: a field read at displaced places. Depends on field.h, perlin.h and shared text.
#include <algorithm>
#include <array>
#include <cmath>

#include "bake/fields/noise_kernels.h"
#include "bake/fields/perlin.h"
#include "bake/fields/rows.h"
#include "bake/fields/shared_text.h"

namespace nephele {
namespace {

/// ρ(p + warp_scale · W(warp_offset · p)), W three fBm noises seeded apart [Quilez, Nurage].
class Warp final : public Field {
 public:
  Warp(FieldPtr input, double scale, std::array<std::vector<NoiseOctave>, 3> noise)
      : input_(std::move(input)), scale_(scale), noise_(std::move(noise)) {}

  void evaluate(const Points& points, float* values) const override {
    const auto addNoise = [&](const std::vector<NoiseOctave>& noise, float* sums) {
      for (const NoiseOctave& octave : noise) addNoiseAtPoints(octave, points, sums);
    };
    evaluateMoved(points, addNoise, values);
  }

  void evaluate(const Lattice& lattice, float* values) const override {
    const LatticePoints block(lattice);
    const auto addNoise = [&](const std::vector<NoiseOctave>& noise, float* sums) {
      addNoiseOnLattice(noise.data(), noise.size(), lattice, sums);
    };
    evaluateMoved(block.points(), addNoise, values);
  }

  Interval bounds(const Box& box) const override {
    Box reached = box;
    for (int axis = 0; axis < 3; ++axis) {
      Interval shift{};
      for (const NoiseOctave& octave : noise_[axis]) shift = shift + boundNoise(octave, box);
      shift = scaled(shift, scale_);
      // Displaced float coordinates are rounded to the spacing of floats at the size of the box and the
      // shift.
      const double room =
          1e-6 * (box.high[axis] - box.low[axis] + std::abs(shift.low) + std::abs(shift.high));
      reached.low[axis] += shift.low - room;
      reached.high[axis] += shift.high + room;
    }
    return input_->bounds(reached);
  }

  Box support() const override {
    double reach = 0.0;
    for (const auto& axis : noise_) {
      double sum = 0.0;
      for (const NoiseOctave& octave : axis) sum += std::abs(double(octave.weight));
      reach = std::max(reach, sum);
    }
    // One part in 10^5 for the rounding of the noise, as in boundNoise.
    return grown(input_->support(), std::abs(scale_) * reach * (1.0 + 1e-5));
  }

 private:
  /// `addNoise(noise, sums)` adds an axis' displacement noise at the points.
  template <class AddNoise>
  void evaluateMoved(const Points& points, const AddNoise& addNoise, float* values) const {
    float moved[3][kBlockPoints];
    const float* const from[3] = {points.x, points.y, points.z};
    for (int axis = 0; axis < 3; ++axis) {
      std::fill_n(moved[axis], points.count, 0.0f);
      addNoise(noise_[size_t(axis)], moved[axis]);
      for (size_t n = 0; n < points.count; ++n)
        moved[axis][n] = from[axis][n] + float(scale_) * moved[axis][n];
    }
    input_->evaluate(Points{points.origin, points.count, moved[0], moved[1], moved[2]}, values);
  }

  FieldPtr input_;
  double scale_;
  std::array<std::vector<NoiseOctave>, 3> noise_;
};

/// The displacing noise; its seed is left to the caller.
Fractal fractalOf(const Arguments& a) {
  Fractal fractal{a.number("cell_size") / a.number("warp_offset"),
                  a.integer("octaves"),
                  2.0,
                  0.5,
                  a.integer("period"),
                  0,
                  a.vector("scroll")};
  fractal.evolve = a.number("evolve");
  return fractal;
}

}  // namespace

FieldRow warpRow() {
  return {
      "warp",
      "Its input, read at places that noise displaces: turns smooth shapes and patterns into billows.",
      {{"input", ParameterType::field, "What is displaced.", std::nullopt},
       {"warp_scale", ParameterType::number, "Largest displacement along an axis; larger is looser.",
        Value{0.8}, kNonNegative, "world units"},
       {"warp_offset", ParameterType::number, "Frequency of the displacement; larger is more broken up.",
        Value{1.0}, kPositive},
       {"cell_size", ParameterType::number, "Edge of a displacement cell at warp_offset 1.", Value{1.0},
        kPositive, "world units"},
       {"octaves",
        ParameterType::integer,
        "Layers of the displacing noise.",
        Value{int64_t{2}},
        {1.0, 16.0, false, false}},
       kSeed,
       kPeriod,
       kScroll,
       kEvolve},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        const uint32_t seed = shared::hashCell({int32_t(uint32_t(a.integer("seed"))), 1, 0}, context.seed);
        Fractal fractal = fractalOf(a);
        std::array<std::vector<NoiseOctave>, 3> noise;
        for (int axis = 0; axis < 3; ++axis) {
          BuildContext quiet = context;
          if (axis > 0) quiet.notes = nullptr;  // the three axes leave out the same octaves
          fractal.seed = shared::seedApart(seed, axis);
          noise[axis] = fbmOctaves(fractal, quiet, "warp");
        }
        return std::make_shared<Warp>(a.field("input"), a.number("warp_scale"), std::move(noise));
      },
      nullptr,
      [](const Arguments& a) { return fractalOf(a).motion(); }};
}

}  // namespace nephele
