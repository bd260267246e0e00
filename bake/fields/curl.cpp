// Curl of a vector noise: the row curl. Depends on field.h, perlin.h and shared text.
#include <algorithm>
#include <array>
#include <cmath>

#include "bake/fields/cell_place.h"
#include "bake/fields/perlin.h"
#include "bake/fields/rows.h"
#include "bake/fields/shared_text.h"

namespace nephele {
namespace {

/// One component, or the length, of ∇ × (N_x, N_y, N_z) per cell, three gradient noises seeded apart, over
/// its largest possible component: a flow without sources [Bridson 2007].
class Curl final : public Field {
 public:
  /// `kept`: the band limit's weight; the length's mean stands in for what it takes away.
  Curl(const std::array<NoiseOctave, 3>& potential, int component, double kept)
      : potential_(potential),
        component_(component),
        kept_(float(kept)),
        level_(component == kLength ? float((1.0 - kept) * kMeanLength) : 0.0f) {}

  void evaluate(const Points& points, float* values) const override {
    if (kept_ == 0.0f) {
      std::fill_n(values, points.count, level_);
      return;
    }
    const NoiseOctave& octave = potential_[0];
    const glm::dvec3 origin = points.origin - octave.offset;
    const CellPlace x0 = cellPlace(origin.x, octave.cellSize), y0 = cellPlace(origin.y, octave.cellSize),
                    z0 = cellPlace(origin.z, octave.cellSize);
    const float frequency = float(1.0 / octave.cellSize);
    for (size_t n = 0; n < points.count; ++n) {
      const glm::vec3 p(x0.fraction + points.x[n] * frequency, y0.fraction + points.y[n] * frequency,
                        z0.fraction + points.z[n] * frequency);
      const glm::vec3 whole(std::floor(p.x), std::floor(p.y), std::floor(p.z));
      values[n] = valueAt(
          {cellAfter(x0.cell, whole.x), cellAfter(y0.cell, whole.y), cellAfter(z0.cell, whole.z)}, p - whole);
    }
  }

  /// The length of three components of at most 1 is at most √3.
  Interval bounds(const Box&) const override {
    constexpr double kLongest = 1.7321, kRoom = 1e-5;
    const Interval all =
        component_ == kLength ? Interval{0.0, kLongest} : Interval{-1.0 - kRoom, 1.0 + kRoom};
    if (kept_ == 1.0f) return all;
    return Interval{double(level_), double(level_)} + scaled(all, double(kept_));
  }

  Box support() const override { return Box{}; }

  static constexpr int kLength = 3;

 private:
  static glm::vec3 slopeInCell(const NoiseOctave& octave, const glm::ivec3& cell, const glm::vec3& f) {
    return octave.turn.evolves ? shared::turningSlope(cell, f, octave.period, octave.seed, octave.turn.at)
                               : shared::perlinSlope(cell, f, octave.period, octave.seed);
  }

  float valueAt(const glm::ivec3& cell, const glm::vec3& f) const {
    // Each component is a difference of two slopes.
    constexpr float kScale = float(0.5 / kPerlinSlope);
    std::array<glm::vec3, 3> slope;
    for (size_t axis = 0; axis < 3; ++axis) slope[axis] = slopeInCell(potential_[axis], cell, f);
    const glm::vec3 curl =
        kScale * glm::vec3(slope[2].y - slope[1].z, slope[0].z - slope[2].x, slope[1].x - slope[0].y);
    const float value = component_ != kLength
                            ? curl[component_]
                            : std::sqrt(curl.x * curl.x + curl.y * curl.y + curl.z * curl.z);
    return kept_ == 1.0f ? value : level_ + kept_ * value;
  }

  static constexpr double kMeanLength = 0.2135;  // from 500,000 places, ± 0.0005

  std::array<NoiseOctave, 3> potential_;
  int component_;
  float kept_, level_;
};

Motion motionOf(const Arguments& a) {
  return {double(a.integer("period")) * a.number("cell_size"), a.vector("scroll"), {}, a.number("evolve")};
}

}  // namespace

FieldRow curlRow() {
  return {
      "curl",
      "One component, in [-1, 1], or the length of the curl of a vector noise: a flow without sources.",
      {{"component",
        ParameterType::choice,
        "Which component.",
        Value{std::string("length")},
        kAny,
        {},
        {"x", "y", "z", "length"}},
       kCellSize,
       kSeed,
       kPeriod,
       kScroll,
       kEvolve},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        const std::string& name = a.choice("component");
        const uint32_t seed = shared::hashCell({int32_t(uint32_t(a.integer("seed"))), 3, 0}, context.seed);
        const OctavePlace place = octavePlace(motionOf(a), 0, context);
        const double cellVoxels = a.number("cell_size") / context.voxelSize, kept = bandLimit(cellVoxels);
        if (kept < 1.0 && context.notes) context.notes->push_back({"curl", 0, cellVoxels, kept});
        std::array<NoiseOctave, 3> potential;
        for (int axis = 0; axis < 3; ++axis)
          potential[size_t(axis)] = {a.number("cell_size"),    1.0f,         shared::seedApart(seed, axis),
                                     int(a.integer("period")), place.offset, place.turn};
        return std::make_shared<Curl>(potential, name == "length" ? Curl::kLength : name[0] - 'x', kept);
      },
      nullptr,
      motionOf};
}

}  // namespace nephele
