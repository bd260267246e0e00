// Our noise and FastNoise2's on one lattice of 128³, features of 50 voxels, no cell border at its corner.
// Depends on fields and FastNoise2, which the user builds and names to CMake.
#include <FastNoise/FastNoise.h>

#include "bake/fields/noise_kernels.h"
#include "bake/fields/worley_kernels.h"
#include "base/hash.h"
#include "bench/pairs.h"
#include "bench/samples.h"
#include "bench/simd_level.h"

namespace nephele::bench {
namespace {

constexpr double kFeature = 50.0;
constexpr int kBlocks = 16, kEdge = kBlocks * kBlockEdge;
constexpr int64_t kOctaveCount = 5;
// The displacement that our warp has unless set, 0.8 cells.
constexpr double kWarpReach = 0.8 * kFeature;
const glm::dvec3 kCorner(3.7, 11.3, 29.1);
constexpr int kRepeats = 9;
constexpr int kSeed = 1;
// Told to our fields so that no octave fades by the band limit, since FastNoise2 has none.
constexpr double kUnfadedVoxel = 1.0 / 64.0;

struct Level {
  const char* name;
  int64_t ours;
  FastSIMD::FeatureSet theirs;
  double leastPerlin, leastFbm;
};
constexpr double kLeastWorley = 1.5, kLeastWarp = 1.0;

/// What both sides write to; one for both, so that neither has warmer memory.
struct Grid {
  std::vector<float> values = std::vector<float>(size_t(kEdge) * kEdge * kEdge);
};

std::string hashOf(const Grid& grid) {
  Hasher hasher;
  hasher.bytes(grid.values.data(), grid.values.size() * sizeof(float));
  return hasher.hex();
}

template <class Evaluate>
void overBlocks(Grid& grid, const Evaluate& evaluate) {
  float* values = grid.values.data();
  for (int x = 0; x < kBlocks; ++x)
    for (int y = 0; y < kBlocks; ++y)
      for (int z = 0; z < kBlocks; ++z, values += kBlockPoints) {
        std::fill_n(values, kBlockPoints, 0.0f);
        evaluate(Lattice{kCorner + double(kBlockEdge) * glm::dvec3(x, y, z), 1.0}, values);
      }
}

void generate(const FastNoise::SmartNode<>& node, Grid& grid) {
  node->GenUniformGrid3D(grid.values.data(), float(kCorner.x), float(kCorner.y), float(kCorner.z), kEdge,
                         kEdge, kEdge, 1.0f, 1.0f, 1.0f, kSeed);
}

std::vector<NoiseOctave> octaves(int64_t count) {
  BuildContext context;
  context.voxelSize = kUnfadedVoxel;
  return fbmOctaves({kFeature, count, 2.0, 0.5, 0, 1u, {}, {}}, context, "bench");
}

FieldPtr warpedFbm() {
  const FieldPtr fbm = makeField("fbm", {{"cell_size", kFeature}, {"octaves", kOctaveCount}}, kUnfadedVoxel);
  return makeField(
      "warp", {{"input", fbm}, {"cell_size", kFeature}, {"warp_scale", kWarpReach}, {"octaves", int64_t{1}}},
      kUnfadedVoxel);
}

struct Theirs {
  FastNoise::SmartNode<> perlin, fbm, worley, warp;
  explicit Theirs(FastSIMD::FeatureSet level) {
    auto basis = FastNoise::New<FastNoise::Perlin>(level);
    basis->SetScale(float(kFeature));
    auto fractal = FastNoise::New<FastNoise::FractalFBm>(level);
    fractal->SetSource(basis);
    fractal->SetOctaveCount(int(kOctaveCount));
    auto cells = FastNoise::New<FastNoise::CellularDistance>(level);
    cells->SetScale(float(kFeature));
    cells->SetDistanceFunction(FastNoise::DistanceFunction::Euclidean);
    auto warped = FastNoise::New<FastNoise::DomainWarpGradient>(level);
    warped->SetScale(float(kFeature));
    warped->SetWarpAmplitude(float(kWarpReach));
    warped->SetSource(fractal);
    perlin = basis, fbm = fractal, worley = cells, warp = warped;
  }
};

}  // namespace

void compareNoise(Table& table) {
  static constexpr Level kLevels[] = {
      {"SSE4", HWY_SSE4, FastSIMD::FeatureSet::SSE41, 5.0, 4.0},
      {"AVX2", HWY_AVX2, FastSIMD::FeatureSet::AVX2, 5.0, 4.0},
      {"AVX-512", HWY_AVX3, FastSIMD::FeatureSet::AVX512, 3.0, 3.0},
  };
  const auto one = octaves(1), five = octaves(kOctaveCount);
  const WorleyNoise worley{kFeature, 1.0f, 1u, 0, WorleyOutput::f1};
  const FieldPtr warped = warpedFbm();
  Grid grid;
  for (const Level& level : kLevels) {
    if ((hwy::SupportedTargets() & level.ours) == 0) continue;
    const Theirs theirs(level.theirs);
    const auto compare = [&](const char* what, const auto& evaluate, const FastNoise::SmartNode<>& node,
                             double least) {
      const std::string name = std::string("noise/") + what + "/" + level.name;
      if (!table.wants(name)) return;
      const SimdLevel forced(level.ours);
      const Minima minima =
          pairedMinima([&] { overBlocks(grid, evaluate); }, [&] { generate(node, grid); }, kRepeats);
      overBlocks(grid, evaluate);
      table.addSpeedup(name, minima, atLeast(least), hashOf(grid));
    };
    const auto perlinOf = [](const std::vector<NoiseOctave>& list) {
      return [&list](const Lattice& at, float* v) { addNoiseOnLattice(list.data(), list.size(), at, v); };
    };
    compare("perlin", perlinOf(one), theirs.perlin, level.leastPerlin);
    compare("fbm5", perlinOf(five), theirs.fbm, level.leastFbm);
    compare(
        "worley_f1", [&](const Lattice& at, float* v) { worleyOnLattice(worley, at, v); }, theirs.worley,
        kLeastWorley);
    compare(
        "warp_fbm5", [&](const Lattice& at, float* v) { warped->evaluate(at, v); }, theirs.warp, kLeastWarp);
  }
}

}  // namespace nephele::bench
