// Domain warp: a field read at displaced places. Depends on field.h, perlin.h and shared text.
#include <algorithm>
#include <array>
#include <cmath>

#include "bake/fields/displace.h"
#include "bake/fields/noise_kernels.h"
#include "bake/fields/perlin.h"
#include "bake/fields/rows.h"
#include "bake/fields/shared_text.h"

namespace nephele {
namespace {

/// The three axes of one displacement, fBm noises seeded apart.
using Displacement = std::array<std::vector<NoiseOctave>, 3>;

/// ρ(p + warp_scale · W(warp_offset · p)) [Quilez, Nurage]; iterated, each W is read where the one before
/// displaces to.
class Warp final : public Field {
 public:
  Warp(FieldPtr input, double scale, std::vector<Displacement> noise)
      : input_(std::move(input)), scale_(scale), noise_(std::move(noise)) {}

  void evaluate(const Points& points, float* values) const override {
    Moved moved;
    displace(points, points, noise_.front(), moved);
    evaluateMoved(points, moved, values);
  }

  void evaluate(const Lattice& lattice, float* values) const override {
    Moved moved;
    for (size_t axis = 0; axis < 3; ++axis) {
      std::fill_n(moved.at[axis], kBlockPoints, 0.0f);
      addNoiseOnLattice(noise_.front()[axis].data(), noise_.front()[axis].size(), lattice, moved.at[axis]);
    }
    displaceOnLattice(lattice, float(scale_), moved.at);
    if (noise_.size() == 1)
      input_->evaluate(moved.points({lattice.origin, kBlockPoints}), values);
    else
      evaluateMoved(LatticePoints(lattice).points(), moved, values);
  }

  Interval bounds(const Box& box) const override {
    Box reached = box;
    for (const Displacement& noise : noise_) {
      Box next = box;
      for (int axis = 0; axis < 3; ++axis) {
        Interval shift{};
        for (const NoiseOctave& octave : noise[size_t(axis)]) shift = shift + boundNoise(octave, reached);
        shift = scaled(shift, scale_);
        // Displaced float coordinates are rounded to the spacing of floats at the size of the box and the
        // shift.
        const double room =
            1e-6 * (box.high[axis] - box.low[axis] + std::abs(shift.low) + std::abs(shift.high));
        next.low[axis] += shift.low - room;
        next.high[axis] += shift.high + room;
      }
      reached = next;
    }
    return input_->bounds(reached);
  }

  /// The last displacement alone says how far a place is moved.
  Box support() const override {
    double reach = 0.0;
    for (const auto& axis : noise_.back()) {
      double sum = 0.0;
      for (const NoiseOctave& octave : axis) sum += std::abs(double(octave.weight));
      reach = std::max(reach, sum);
    }
    // One part in 10^5 for the rounding of the noise, as in boundNoise.
    return grown(input_->support(), std::abs(scale_) * reach * (1.0 + 1e-5));
  }

 private:
  struct Moved {
    alignas(kBlockAlignment) float at[3][kBlockPoints];
    Points points(const Points& like) const { return {like.origin, like.count, at[0], at[1], at[2]}; }
  };

  /// moved = points + scale · W(where).
  void displace(const Points& points, const Points& where, const Displacement& noise, Moved& moved) const {
    const float* const from[3] = {points.x, points.y, points.z};
    for (size_t axis = 0; axis < 3; ++axis) {
      float* const to = moved.at[axis];
      std::fill_n(to, points.count, 0.0f);
      addNoiseAtPoints(noise[axis].data(), noise[axis].size(), where, to);
      for (size_t n = 0; n < points.count; ++n) to[n] = from[axis][n] + float(scale_) * to[n];
    }
  }

  void evaluateMoved(const Points& points, const Moved& first, float* values) const {
    if (noise_.size() == 1) return input_->evaluate(first.points(points), values);
    Moved turns[2];
    const Moved* last = &first;
    for (size_t n = 1; n < noise_.size(); ++n) {
      Moved& next = turns[n % 2];
      displace(points, last->points(points), noise_[n], next);
      last = &next;
    }
    input_->evaluate(last->points(points), values);
  }

  FieldPtr input_;
  double scale_;
  std::vector<Displacement> noise_;  // in the order of reading
};

/// How many times finer, root mean square, a warp makes what it displaces: √(1 + 3 g²) with g the rms slope
/// of a displacement along an axis, whose own noise is made finer by the displacement before it.
double squeezeOf(const std::vector<Displacement>& noise, double scale) {
  constexpr double kSlopeRms =
      0.6794;  // of perlinNoise along an axis, per cell; from 500,000 places, ± 0.001
  double squeeze = 1.0;
  for (const Displacement& displacement : noise) {
    double squares = 0.0;
    for (const NoiseOctave& octave : displacement[0]) {
      const double slope = kSlopeRms * double(octave.weight) / octave.cellSize * scale * squeeze;
      squares += slope * slope;
    }
    squeeze = std::sqrt(1.0 + 3.0 * squares);
  }
  return squeeze;
}

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
       {"warp_scale",
        ParameterType::number,
        "Largest displacement along an axis; larger is looser.",
        Value{0.8},
        {0.0, 1e6, false, false},
        "world units"},
       {"warp_offset",
        ParameterType::number,
        "Frequency of the displacement; larger is more broken up.",
        Value{1.0},
        {1e-6, 1e6, false, false}},
       {"cell_size", ParameterType::number, "Edge of a displacement cell at warp_offset 1.", Value{1.0},
        kSizeRange, "world units"},
       {"octaves",
        ParameterType::integer,
        "Layers of the displacing noise.",
        Value{int64_t{2}},
        {1.0, 16.0, false, false}},
       {"iterations",
        ParameterType::integer,
        "How often: each displacement is read where the one before leads; more is more curled.",
        Value{int64_t{1}},
        {1.0, 8.0, false, false}},
       kSeed,
       kPeriod,
       kScroll,
       kEvolve},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        const uint32_t seed = shared::hashCell({int32_t(uint32_t(a.integer("seed"))), 1, 0}, context.seed);
        Fractal fractal = fractalOf(a);
        std::vector<Displacement> noise(size_t(a.integer("iterations")));
        for (int n = 0; n < int(noise.size()); ++n)
          for (int axis = 0; axis < 3; ++axis) {
            BuildContext quiet = context;
            if (axis + n > 0) quiet.notes = nullptr;  // all axes and iterations leave out the same octaves
            fractal.seed = shared::seedApart(seed, 3 * n + axis);
            noise[size_t(n)][size_t(axis)] = fbmOctaves(fractal, quiet, "warp");
          }
        const double scale = a.number("warp_scale");
        if (context.notes) context.notes->push_back({"warp", 0, 0.0, 1.0, squeezeOf(noise, scale)});
        return std::make_shared<Warp>(a.field("input"), scale, std::move(noise));
      },
      nullptr,
      [](const Arguments& a) { return fractalOf(a).motion(); }};
}

}  // namespace nephele
