// Gradient noise over points, its bounds, and the rows perlin and fbm. Depends on field.h, table.h and shared
// text.
#include "bake/fields/perlin.h"

#include <cmath>

#include "bake/fields/rows.h"
#include "bake/fields/shared_text.h"

namespace nephele {
namespace {

/// A world coordinate as lattice cell and place in it. Cells wrap at 2^32: noise repeats there, 4 billion
/// cells away.
struct CellPlace {
  int32_t cell;
  float fraction;
};
CellPlace place(double coordinate, double cellSize) {
  const double cells = coordinate / cellSize;
  const double whole = std::floor(cells);
  return {int32_t(uint32_t(int64_t(whole))), float(cells - whole)};
}

/// Adds to a cell without overflow: wraps at 2^32.
int32_t stepped(int32_t cell, float by) { return int32_t(uint32_t(cell) + uint32_t(int32_t(by))); }

float noiseAt(const NoiseOctave& octave, const glm::dvec3& p) {
  const CellPlace x = place(p.x, octave.cellSize), y = place(p.y, octave.cellSize),
                  z = place(p.z, octave.cellSize);
  return shared::perlinNoise({x.cell, y.cell, z.cell}, {x.fraction, y.fraction, z.fraction}, octave.period,
                             octave.seed);
}

}  // namespace

double bandLimit(double cellVoxels) { return std::clamp((cellVoxels - 2.0) / 2.0, 0.0, 1.0); }

void addNoise(const NoiseOctave& octave, const Points& points, float* sums) {
  const CellPlace x0 = place(points.origin.x, octave.cellSize);
  const CellPlace y0 = place(points.origin.y, octave.cellSize);
  const CellPlace z0 = place(points.origin.z, octave.cellSize);
  const float frequency = float(1.0 / octave.cellSize);
  for (size_t n = 0; n < points.count; ++n) {
    const float x = x0.fraction + points.x[n] * frequency;
    const float y = y0.fraction + points.y[n] * frequency;
    const float z = z0.fraction + points.z[n] * frequency;
    const float cx = std::floor(x), cy = std::floor(y), cz = std::floor(z);
    sums[n] += octave.weight *
               shared::perlinNoise({stepped(x0.cell, cx), stepped(y0.cell, cy), stepped(z0.cell, cz)},
                                   {x - cx, y - cy, z - cz}, octave.period, octave.seed);
  }
}

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
    for (const NoiseOctave& octave : octaves_) addNoise(octave, points, values);
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
