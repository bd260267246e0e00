// Gradient noise over points, its bounds, and the rows perlin and fbm. Depends on field.h, table.h and shared
// text.
#include "bake/fields/perlin.h"

#include <cmath>

#include "bake/fields/cell_place.h"
#include "bake/fields/noise_kernels.h"
#include "bake/fields/rows.h"
#include "bake/fields/shared_text.h"

namespace nephele {
namespace {

float noiseAt(const NoiseOctave& octave, const glm::dvec3& p) {
  const CellPlace x = cellPlace(p.x, octave.cellSize), y = cellPlace(p.y, octave.cellSize),
                  z = cellPlace(p.z, octave.cellSize);
  return shared::perlinNoise({x.cell, y.cell, z.cell}, {x.fraction, y.fraction, z.fraction}, octave.period,
                             octave.seed);
}

}  // namespace

double bandLimit(double cellVoxels) { return std::clamp((cellVoxels - 2.0) / 2.0, 0.0, 1.0); }

Interval boundNoise(const NoiseOctave& octave, const Box& box) {
  const double weight = std::abs(double(octave.weight));
  const glm::dvec3 half = box.halfSize() / octave.cellSize;
  const double reach = std::min(kPerlinSlope * std::sqrt(half.x * half.x + half.y * half.y + half.z * half.z),
                                kPerlinCornerSlope * std::max({half.x, half.y, half.z}));
  // Float noise may differ from real noise by the rounding of its 30 operations and of a point's place in its
  // cell, where a block's offsets reach across many cells.
  constexpr double kPlaceRoom = 1e-5;
  const Interval all{-weight * (1.0 + kPlaceRoom), weight * (1.0 + kPlaceRoom)};
  if (!(reach < 2.0)) return all;
  const double centre = double(octave.weight) * double(noiseAt(octave, box.centre()));
  const double room = weight * (reach + kPlaceRoom);
  return both(all, {centre - room, centre + room});
}

std::vector<NoiseOctave> fbmOctaves(double cellSize, int64_t octaves, double lacunarity, double gain,
                                    int64_t period, uint32_t seed, const BuildContext& context,
                                    const char* field) {
  double total = 0.0, weight = 1.0;
  for (int64_t i = 0; i < octaves; ++i, weight *= gain) total += weight;
  std::vector<NoiseOctave> list;
  weight = 1.0;
  double size = cellSize;
  double cells = double(period);
  for (int64_t i = 0; i < octaves; ++i) {
    const double kept = bandLimit(size / context.voxelSize);
    if (kept < 1.0 && context.notes)
      context.notes->push_back({field, int(i), size / context.voxelSize, kept});
    if (kept > 0.0)
      list.push_back(
          {size, float(weight * kept / total), shared::seedApart(seed, int(i)), int(std::lround(cells))});
    weight *= gain;
    size /= lacunarity;
    cells *= lacunarity;
  }
  return list;
}

namespace {

/// Σ of octaves: the row perlin is one of them.
class NoiseField final : public Field {
 public:
  explicit NoiseField(std::vector<NoiseOctave> octaves) : octaves_(std::move(octaves)) {}

  void evaluate(const Points& points, float* values) const override {
    std::fill_n(values, points.count, 0.0f);
    for (const NoiseOctave& octave : octaves_) addNoiseAtPoints(octave, points, values);
  }

  void evaluate(const Lattice& lattice, float* values) const override {
    std::fill_n(values, kBlockPoints, 0.0f);
    addNoiseOnLattice(octaves_.data(), octaves_.size(), lattice, values);
  }

  Interval bounds(const Box& box) const override {
    Interval sum{};
    for (const NoiseOctave& octave : octaves_) sum = sum + boundNoise(octave, box);
    return sum;
  }

  Box support() const override { return octaves_.empty() ? nothing() : Box{}; }

 private:
  std::vector<NoiseOctave> octaves_;
};

uint32_t mixedSeed(const Arguments& a, const BuildContext& context) {
  return shared::hashCell({int32_t(uint32_t(a.integer("seed"))), 0, 0}, context.seed);
}

std::optional<std::pair<std::string_view, std::string>> validatePeriod(const Arguments& a) {
  const double lacunarity = a.number("lacunarity");
  if (a.integer("period") > 0 && lacunarity != std::floor(lacunarity))
    return {{"lacunarity", "a noise with a period needs a whole lacunarity, or its octaves do not close"}};
  return std::nullopt;
}

}  // namespace

FieldRow perlinRow() {
  return {"perlin",
          "Gradient noise in [-1, 1]: 0 at the corners of its cells, smooth between.",
          {kCellSize, kSeed, kPeriod},
          [](const Arguments& a, const BuildContext& context) -> FieldPtr {
            return std::make_shared<NoiseField>(fbmOctaves(a.number("cell_size"), 1, 2.0, 0.5,
                                                           a.integer("period"), mixedSeed(a, context),
                                                           context, "perlin"));
          }};
}

FieldRow fbmRow() {
  return {"fbm",
          "Fractal sum of gradient noise in [-1, 1]; octaves finer than the grid can hold are left out.",
          {kCellSize, kOctaves, kLacunarity, kGain, kSeed, kPeriod},
          [](const Arguments& a, const BuildContext& context) -> FieldPtr {
            return std::make_shared<NoiseField>(
                fbmOctaves(a.number("cell_size"), a.integer("octaves"), a.number("lacunarity"),
                           a.number("gain"), a.integer("period"), mixedSeed(a, context), context, "fbm"));
          },
          validatePeriod};
}

}  // namespace nephele
