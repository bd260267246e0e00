// A fog ball of radius 256 voxels, density clamp(1.2 (1 - r/256) + 0.9 fBm, 0, 1) with features of 50 voxels,
// filled and baked by our engine and by the plain way: TBB over leaves, values straight into their buffers,
// OpenVDB's own writer. Depends on voxelize, fields, OpenVDB, TBB; FastNoise2 where it was given.
#include <openvdb/io/File.h>
#include <openvdb/tools/Prune.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <memory>

#include "bake/fields/table.h"
#include "bake/voxelize.h"
#include "bench/pairs.h"
#include "bench/samples.h"
#include "bench/scalar_noise.h"
#include "volume/vdb_file.h"

#ifdef NEPHELE_WITH_FASTNOISE2
#include <FastNoise/FastNoise.h>
#endif

namespace nephele::bench {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr int kRadius = 256;
constexpr float kFeature = 50.0f;
constexpr int kOctaveCount = 5;
constexpr float kBallWeight = 1.2f, kNoiseWeight = 0.9f;
constexpr int kFillRepeats = 5, kBakeRepeats = 3;
constexpr uint64_t kWordBits = 64;

/// The plain way. `noise(origin, values)` gives fBm at a leaf's 512 points, z fastest.
template <class Noise>
openvdb::FloatGrid::Ptr fillPlainly(const Noise& noise) {
  std::vector<openvdb::Coord> origins;
  for (int x = -kRadius; x < kRadius; x += kBlockEdge)
    for (int y = -kRadius; y < kRadius; y += kBlockEdge)
      for (int z = -kRadius; z < kRadius; z += kBlockEdge) {
        const auto gap = [](int low) { return double(std::max({low, -(low + kBlockEdge - 1), 0})); };
        if (gap(x) * gap(x) + gap(y) * gap(y) + gap(z) * gap(z) < double(kRadius) * kRadius)
          origins.emplace_back(x, y, z);
      }
  std::vector<std::unique_ptr<Leaf>> leaves(origins.size());
  tbb::parallel_for(size_t(0), origins.size(), [&](size_t n) {
    auto leaf = std::make_unique<Leaf>(openvdb::PartialCreate(), origins[n], 0.0f);
    leaf->allocate();
    float* const values = leaf->buffer().data();
    noise(origins[n], values);
    for (int k = 0; k < kBlockPoints; ++k) {
      const openvdb::Vec3s p((Leaf::offsetToLocalCoord(openvdb::Index(k)) + origins[n]).asVec3s());
      const float r = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / float(kRadius);
      const float density = kBallWeight * (1.0f - r) + kNoiseWeight * values[k];
      values[k] = r < 1.0f ? std::min(std::max(density, 0.0f), 1.0f) : 0.0f;
    }
    Leaf::NodeMaskType mask;
    for (openvdb::Index word = 0; word < openvdb::Index(kBlockPoints / kWordBits); ++word) {
      uint64_t bits = 0;
      for (uint64_t k = 0; k < kWordBits; ++k) bits |= uint64_t(values[word * kWordBits + k] > 0.0f) << k;
      mask.getWord<uint64_t>(word) = bits;
    }
    leaf->setValueMask(mask);
    if (!mask.isOff()) leaves[n] = std::move(leaf);
  });
  auto grid = makeFogGrid("density", 1.0, false);
  openvdb::tree::ValueAccessor<openvdb::FloatTree> accessor(grid->tree());
  for (auto& leaf : leaves)
    if (leaf) accessor.addLeaf(leaf.release());
  openvdb::tools::prune(grid->tree());
  return grid;
}

openvdb::FloatGrid::Ptr fillWithScalarNoise() {
  const ScalarFbm fbm(kFeature, kOctaveCount);
  return fillPlainly([&](const openvdb::Coord& origin, float* values) {
    for (int k = 0; k < kBlockPoints; ++k) {
      const openvdb::Coord p = origin + Leaf::offsetToLocalCoord(openvdb::Index(k));
      values[k] = fbm.at(float(p.x()), float(p.y()), float(p.z()));
    }
  });
}

#ifdef NEPHELE_WITH_FASTNOISE2
openvdb::FloatGrid::Ptr fillWithFastNoise2() {
  auto basis = FastNoise::New<FastNoise::Perlin>();
  basis->SetScale(kFeature);
  auto fbm = FastNoise::New<FastNoise::FractalFBm>();
  fbm->SetSource(basis);
  fbm->SetOctaveCount(kOctaveCount);
  return fillPlainly([&](const openvdb::Coord& origin, float* values) {
    // Its x runs fastest; a leaf's z does.
    fbm->GenUniformGrid3D(values, float(origin.z()), float(origin.y()), float(origin.x()), kBlockEdge,
                          kBlockEdge, kBlockEdge, 1.0f, 1.0f, 1.0f, 1);
  });
}
#endif

FieldPtr ourBall() {
  const double radius = double(kRadius);
  const FieldPtr ball = makeField("sphere", {{"radius", radius}, {"falloff", radius}});
  const FieldPtr fbm =
      makeField("fbm", {{"cell_size", double(kFeature)}, {"octaves", int64_t(kOctaveCount)}});
  const FieldPtr fog = fold("add", {fold("multiply", {constant(double(kBallWeight)), ball}),
                                    fold("multiply", {constant(double(kNoiseWeight)), fbm})});
  const FieldPtr cut = makeField("sphere", {{"radius", radius}, {"falloff", 0.0}});
  return fold("multiply", {cut, makeField("remap", {{"input", fog}})});
}

const VoxelizeSettings kSettings{1.0, 0.0, false};

void compareFill(Table& table, const char* name, const std::function<openvdb::FloatGrid::Ptr()>& theirs,
                 const Target& target) {
  if (!table.wants(name)) return;
  const FieldPtr field = ourBall();
  const Minima minima = pairedMinima([&] { voxelize(*field, kSettings); }, [&] { theirs(); }, kFillRepeats);
  table.addSpeedup(name, minima, target, contentHashOf(voxelize(*field, kSettings)));
}

/// Theirs writes with OpenVDB's io::File and its codec; ours hashes, writes beside, flushes and renames too.
void compareBake(Table& table, const char* name, const std::function<openvdb::FloatGrid::Ptr()>& theirs,
                 const Target& target) {
  if (!table.wants(name)) return;
  const FieldPtr field = ourBall();
  const examples::SampleFolder folder;
  std::string hash;
  const auto bakeOurs = [&] {
    const Voxelized voxelized = voxelize(*field, kSettings);
    hash = contentHashOf(voxelized);
    writeDensity(folder.file("ours.vdb"), voxelized, Provenance{});
  };
  const auto bakeTheirs = [&] {
    openvdb::io::File file(folder.file("theirs.vdb"));
    file.setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    file.write({theirs()});
    file.close();
  };
  table.addSpeedup(name, pairedMinima(bakeOurs, bakeTheirs, kBakeRepeats), target, hash);
}

}  // namespace

void compareFogBall(Table& table) {
  initializeOpenVdb();
  // From the issue: fills and whole bakes against both peers.
  constexpr double kFillScalar = 10.0, kBakeScalar = 2.5;
  compareFill(table, "fog_ball/fill/scalar_noise", fillWithScalarNoise, atLeast(kFillScalar));
  compareBake(table, "fog_ball/bake/scalar_noise", fillWithScalarNoise, atLeast(kBakeScalar));
#ifdef NEPHELE_WITH_FASTNOISE2
  constexpr double kFillFastNoise2 = 1.8, kBakeFastNoise2 = 1.2;
  compareFill(table, "fog_ball/fill/fastnoise2", fillWithFastNoise2, atLeast(kFillFastNoise2));
  compareBake(table, "fog_ball/bake/fastnoise2", fillWithFastNoise2, atLeast(kBakeFastNoise2));
#endif
}

}  // namespace nephele::bench
