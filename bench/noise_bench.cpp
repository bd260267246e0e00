// Noise and fields on blocks: million points per second, one thread, with a checksum that must not change
// with speed.
#include <benchmark/benchmark.h>

#include <cmath>

#include "bake/field_examples.h"
#include "bake/fields/noise_kernels.h"
#include "bake/fields/perlin.h"
#include "bake/fields/shared_text.h"
#include "bake/fields/table.h"
#include "bake/fields/worley_kernels.h"

namespace nephele::bench {
namespace {

// A feature size of 50 voxels, and a grid that lies on no cell border.
constexpr double kFeature = 50.0;
constexpr int kBlocks = 16;  // 128 voxels along each axis

Lattice blockAt(int n) {
  const glm::dvec3 offset(3.7, 11.3, 29.1);
  return {offset + 8.0 * glm::dvec3(n / (kBlocks * kBlocks), n / kBlocks % kBlocks, n % kBlocks), 1.0};
}

template <class Evaluate>
void overLattice(benchmark::State& state, const Evaluate& evaluate) {
  double sum = 0.0;
  for (auto _ : state) {
    sum = 0.0;
    for (int n = 0; n < kBlocks * kBlocks * kBlocks; ++n) {
      float values[kBlockPoints] = {};
      evaluate(blockAt(n), values);
      for (int k = 0; k < kBlockPoints; k += 73) sum += double(values[k]);
    }
  }
  state.SetItemsProcessed(state.iterations() * kBlocks * kBlocks * kBlocks * kBlockPoints);
  state.counters["checksum"] = sum;
}

std::vector<NoiseOctave> octaves(int64_t count) {
  return fbmOctaves({kFeature, count, 2.0, 0.5, 0, 1u, {}, {}}, {1.0, 2, 0, nullptr}, "bench");
}

void perlinLattice(benchmark::State& state) {
  const auto list = octaves(state.range(0));
  overLattice(state,
              [&](const Lattice& at, float* v) { addNoiseOnLattice(list.data(), list.size(), at, v); });
}
BENCHMARK(perlinLattice)->Arg(1)->Arg(5)->ArgName("octaves");

/// What turning gradients cost: only at lattice corners.
void evolvingLattice(benchmark::State& state) {
  auto list = octaves(state.range(0));
  for (NoiseOctave& octave : list) octave.turn = turnAt(0.3);
  overLattice(state,
              [&](const Lattice& at, float* v) { addNoiseOnLattice(list.data(), list.size(), at, v); });
}
BENCHMARK(evolvingLattice)->Arg(1)->Arg(5)->ArgName("octaves");

void worleyLattice(benchmark::State& state) {
  const WorleyNoise noise{kFeature, 1.0f, 1u, 0, state.range(0) == 1 ? WorleyOutput::f1 : WorleyOutput::f2};
  overLattice(state, [&](const Lattice& at, float* v) { worleyOnLattice(noise, at, v); });
}
BENCHMARK(worleyLattice)->Arg(1)->Arg(2)->ArgName("rank");

void perlinPoints(benchmark::State& state) {
  const auto list = octaves(state.range(0));
  overLattice(state, [&](const Lattice& at, float* v) {
    const LatticePoints block(at);
    addNoiseAtPoints(list.data(), list.size(), block.points(), v);
  });
}
BENCHMARK(perlinPoints)->Arg(1)->Arg(5)->ArgName("octaves");

void perlinDefinition(benchmark::State& state) {
  const auto list = octaves(state.range(0));
  overLattice(state, [&](const Lattice& at, float* v) {
    for (const NoiseOctave& octave : list)
      for (int n = 0; n < kBlockPoints; ++n) {
        const glm::dvec3 p = (at.origin + glm::dvec3(n / 64, n / 8 % 8, n % 8)) / octave.cellSize;
        const glm::dvec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z));
        v[n] += octave.weight * shared::perlinNoise(glm::ivec3(cell), glm::vec3(p - cell), 0, octave.seed);
      }
  });
}
BENCHMARK(perlinDefinition)->Arg(1)->Arg(5)->ArgName("octaves");

}  // namespace

/// Every row of the table at its defaults, cells of 50 voxels.
void field(benchmark::State& state, const std::string& name) {
  const FieldPtr built = examples::exampleField(name, {1.0 / kFeature, 2, 0, nullptr});
  overLattice(state, [&](const Lattice& at, float* v) {
    built->evaluate(Lattice{(at.origin - 64.0) / kFeature, 1.0 / kFeature}, v);
  });
}

}  // namespace nephele::bench

int main(int argc, char** argv) {
  // Here, not during static initialisation: the table's own constants must stand first.
  for (const nephele::FieldRow& row : nephele::fieldTable())
    benchmark::RegisterBenchmark(
        ("field/" + std::string(row.name)).c_str(),
        [name = std::string(row.name)](benchmark::State& state) { nephele::bench::field(state, name); });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
