// Sequences of particles: restarts and shards change nothing, ledgers add up, points go out and come in.
#include "bake/particle_run.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "bake/particle_sources.h"
#include "bake/run.h"
#include "tests/scratch_folder.h"
#include "volume/difference.h"
#include "volume/info.h"

namespace nephele::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecipe = R"(
seed: 5
assets:
  puff:
    voxel_size: 0.1
    frames: 1-12
    particles:
      emitters: [{ rate: 900, particle_radius: 0.15, velocity: [0, 0, 1], spread: 0.4, life: 0.3, life_variation: 0.5, temperature: 1 }]
      forces: { drag: 1, buoyancy: 2, curl_noise: { speed: 0.5, cell_size: 0.4 }, neighbours: { radius: 0.1, separation: 2 } }
      density_over_life: [[0.5, 1], [1, 0.2]]
      checkpoint_every: 4
      grids: [vel, age]
)";

std::vector<BakeRecord> bake(const std::string& recipe, const BakeOptions& options) {
  return bakeAll(loadPipeline(recipe), options);
}

BakeOptions into(const std::string& folder) {
  BakeOptions options;
  options.outFolder = folder;
  options.quiet = true;
  return options;
}

std::map<int, std::string> hashesOf(const std::vector<BakeRecord>& records) {
  std::map<int, std::string> hashes;
  for (const BakeRecord& record : records) hashes[*record.frame] = record.contentHash + record.velocityHash;
  return hashes;
}

TEST(ParticleRun, RestartsAndShardsGiveTheSameFrames) {
  const ScratchFolder folder;
  const std::string recipe = folder.write("p.yaml", kRecipe);
  const auto whole = hashesOf(bake(recipe, into(folder.file("whole"))));
  ASSERT_EQ(whole.size(), 12u);
  EXPECT_NE(whole.at(3), whole.at(4));
  // Two shards, and one frame alone out of the checkpoints of the first run.
  for (const int index : {1, 2}) {
    BakeOptions options = into(folder.file("shards"));
    options.shard = {index, 2};
    for (const auto& [frame, hash] : hashesOf(bake(recipe, options)))
      EXPECT_EQ(hash, whole.at(frame)) << frame;
  }
  const Pipeline pipeline = loadPipeline(recipe);
  ParticleRun restarted(pipeline, pipeline.assets[0], folder.file("whole"));
  const ParticleFrame tenth = restarted.frame(10);
  EXPECT_EQ(tenth.stepsSimulated, 4u) << "two frames of two steps since the checkpoint of frame 8";
  EXPECT_EQ(contentHashOf(tenth.splatted, "density") + contentHashOf(tenth.splatted, "vel"), whole.at(10));
  ParticleRun anew(pipeline, pipeline.assets[0], folder.file("elsewhere"));
  EXPECT_EQ(anew.frame(10).stepsSimulated, 20u);
  // Another recipe does not take them.
  std::string other = kRecipe;
  other.replace(other.find("drag: 1"), 7, "drag: 2");
  const Pipeline second = loadPipeline(folder.write("q.yaml", other));
  EXPECT_EQ(ParticleRun(second, second.assets[0], folder.file("whole")).frame(10).stepsSimulated, 20u);
}

TEST(ParticleRun, ADamagedCheckpointIsAsGoodAsNone) {
  const ScratchFolder folder;
  const std::string recipe = folder.write("p.yaml", kRecipe);
  const auto whole = hashesOf(bake(recipe, into(folder.file("out"))));
  for (const auto& entry : fs::directory_iterator(folder.file("out") + "/puff.checkpoints"))
    fs::resize_file(entry.path(), fs::file_size(entry.path()) - 1);
  const Pipeline pipeline = loadPipeline(recipe);
  const ParticleFrame frame = ParticleRun(pipeline, pipeline.assets[0], folder.file("out")).frame(10);
  EXPECT_EQ(frame.stepsSimulated, 20u);
  EXPECT_EQ(contentHashOf(frame.splatted, "density") + contentHashOf(frame.splatted, "vel"), whole.at(10));
}

TEST(ParticleRun, LedgerAddsUp) {
  const ScratchFolder folder;
  for (const BakeRecord& record : bake(folder.write("p.yaml", kRecipe), into(folder.file("out")))) {
    ASSERT_TRUE(record.ledger);
    const MassLedger& m = *record.ledger;
    EXPECT_NEAR(m.emitted, m.died + m.faded + m.alive, 1e-12 * m.emitted);
    EXPECT_NEAR(m.alive, m.splatted, 1e-5 * m.alive);
    EXPECT_NEAR(m.splatted, m.stored + m.lostToCutoff + m.lostToHalf, 1e-12 * m.emitted);
    EXPECT_GT(m.lostToCutoff, 0.0);
    const FileInfo info = inspectFile(record.file);
    EXPECT_NEAR(std::stod(info.metadata.at("mass")), m.stored, 1e-12);
    EXPECT_NE(info.metadata.at("particles").find("rate: [[0, 900]]"), std::string::npos);
    EXPECT_EQ(info.grids.size(), 3u);
  }
  // 900 a second until frame 12 of 24 a second.
  EXPECT_EQ(bake(folder.file("p.yaml"), into(folder.file("again"))).back().ledger->countEmitted, 450u);
}

// Nothing at first, a puff, and nothing again.
constexpr const char* kPuff = R"(
assets:
  puff:
    voxel_size: 0.1
    frames: 1-10
    particles:
      emitters: [{ bursts: [[0.1, 60]], particle_radius: 0.25, velocity: [0, 0, 3], spread: 1, life: 0.2 }]
      shutter: 1
      grids: [vel]
)";

TEST(ParticleRun, AStableBoxIsThatOfAllFramesAndLosesNothing) {
  const ScratchFolder folder;
  const std::string plain = folder.write("plain.yaml", kPuff);
  const std::string stable = folder.write("stable.yaml", std::string(kPuff) + "      stable_box: true\n");
  const auto free = bake(plain, into(folder.file("plain"))), held = bake(stable, into(folder.file("stable")));
  ASSERT_EQ(held.size(), 10u);
  const GridInfo first = inspectFile(held[0].file).grids.at(0);
  int empty = 0, moved = 0;
  for (size_t n = 0; n < held.size(); ++n) {
    const FileInfo own = inspectFile(free[n].file), same = inspectFile(held[n].file);
    for (const GridInfo& grid : same.grids) {
      EXPECT_EQ(grid.boxMin, first.boxMin) << n << grid.name;
      EXPECT_EQ(grid.boxMax, first.boxMax) << n << grid.name;
    }
    const GridInfo& alone = own.grids.at(0);
    // Two corners of density 0 are all that it adds.
    EXPECT_EQ(same.grids.at(0).activeVoxels, alone.activeVoxels + 2u) << n;
    EXPECT_EQ(held[n].ledger->stored, free[n].ledger->stored) << n;
    const GridDifference between = differenceOfFiles(free[n].file, held[n].file);
    EXPECT_EQ(between.largest, 0.0) << n;
    EXPECT_EQ(between.largestDepth, 0.0) << n;
    EXPECT_EQ(between.largestVelocity, 0.0) << n;
    EXPECT_EQ(between.voxelsOnlyA + between.voxelsOnlyB, 0u) << n;
    empty += int(alone.activeVoxels == 0);
    if (alone.activeVoxels == 0) continue;
    moved += int(alone.boxMin != first.boxMin);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(alone.boxMin[axis], first.boxMin[axis]) << n;
      EXPECT_LE(alone.boxMax[axis], first.boxMax[axis]) << n;
    }
  }
  EXPECT_GT(empty, 2);
  EXPECT_GT(moved, 2);
  // One frame alone has the box of all, with the box file and without.
  for (const char* const out : {"stable", "elsewhere"}) {
    BakeOptions options = into(folder.file(out));
    options.frames = FrameRange{5, 5};
    options.force = true;
    EXPECT_EQ(bake(stable, options).at(0).contentHash, held[4].contentHash) << out;
  }
}

TEST(ParticleRun, ADamagedBoxFileIsAsGoodAsNone) {
  const ScratchFolder folder;
  const std::string stable = folder.write("stable.yaml", std::string(kPuff) + "      stable_box: true\n");
  const auto held = bake(stable, into(folder.file("out")));
  for (const auto& entry : fs::directory_iterator(folder.file("out") + "/puff.checkpoints"))
    if (entry.path().extension() == ".box") fs::resize_file(entry.path(), fs::file_size(entry.path()) - 6);
  BakeOptions again = into(folder.file("out"));
  again.force = true;
  EXPECT_EQ(hashesOf(bake(stable, again)), hashesOf(held));
}

TEST(ParticleRun, TheFilesBlockBakesToTheSameWithoutTheRecipesNames) {
  const ScratchFolder folder;
  const std::string head = "    voxel_size: 0.1\n    particles:\n";
  const std::string recipe = folder.write("p.yaml", R"(
fields:
  rough: { fbm: { cell_size: 0.5 } }
  deep: { multiply: [rough, { remap: { input: rough, to: [0.5, 1] } }] }
assets:
  puff:
)" + head + R"(
      emitters: [{ bursts: [[0, 20]], particle_radius: 0.4 }]
      erosion: { amount: 1, field: deep }
)");
  const BakeRecord whole = bake(recipe, into(folder.file("out"))).at(0);
  std::istringstream block(inspectFile(whole.file).metadata.at("particles"));
  std::string again = "assets:\n  puff:\n" + head, line;
  while (std::getline(block, line)) again += "      " + line + "\n";
  const BakeRecord copy = bake(folder.write("q.yaml", again), into(folder.file("again"))).at(0);
  EXPECT_EQ(copy.contentHash, whole.contentHash) << again;
}

TEST(ParticleRun, AlongRaysIsTheSameDensityAlone) {
  const ScratchFolder folder;
  const Pipeline pipeline = loadPipeline(folder.write("p.yaml", kRecipe));
  ParticleRun run(pipeline, pipeline.assets[0], folder.file("out"));
  run.moveTo(10);
  const Chords chords = randomChords(run.extent().low, run.extent().high, 300, 1);
  const Splatted all = run.splatted(pipeline.assets[0]),
                 density = run.densityAlong(chords.lines, pipeline.assets[0]);
  EXPECT_NE(contentHashOf(all, "vel"), "");
  EXPECT_EQ(contentHashOf(density, "vel"), "");
  EXPECT_LT(2 * density.gridBytes, all.gridBytes);
  const DepthDifference d =
      differenceOf(depthsAlong(bricksOf(all), chords.lines), depthsAlong(bricksOf(density), chords.lines));
  EXPECT_GT(d.largestA, 0.0);
  EXPECT_LT(d.relative(), 1e-3) << "a half's rounding";
}

TEST(Report, ALineHoldsALongPathAndEnds) {
  BakeRecord record;
  record.file = std::string(300, 'p') + ".vdb";
  record.skipped = true;
  EXPECT_EQ(recordAsText(record), record.file + ": up to date\n");
  record.skipped = false;
  record.voxelsActive = 1250000;
  EXPECT_EQ(recordAsText(record),
            record.file + ": 1.25 million active voxels, 0.0 MB, 0.00 s (fill 0.00, write 0.00)\n");
}

TEST(ParticleRun, IsUpToDateUntilTheRecipeChanges) {
  const ScratchFolder folder;
  const std::string recipe = folder.write("p.yaml", kRecipe);
  bake(recipe, into(folder.file("out")));
  for (const BakeRecord& record : bake(recipe, into(folder.file("out")))) EXPECT_TRUE(record.skipped);
  std::string other = kRecipe;
  other.replace(other.find("drag: 1"), 7, "drag: 2");
  folder.write("p.yaml", other);
  for (const BakeRecord& record : bake(recipe, into(folder.file("out")))) EXPECT_FALSE(record.skipped);
  // Points that are asked for later are written.
  folder.write("p.yaml", other + "      write_points: [ply]\n");
  bake(recipe, into(folder.file("out")));
  EXPECT_EQ(readPoints(folder.file("out/puff_points_0012.ply")).size(),
            bake(folder.file("p.yaml"), into(folder.file("new"))).back().ledger->countAlive);
}

PointSet somePoints() {
  PointSet p;
  uint32_t state = 9;
  for (int n = 0; n < 500; ++n) {
    p.x.push_back(motion::nextUniform(state)), p.y.push_back(motion::nextUniform(state));
    p.z.push_back(motion::nextUniform(state)), p.radius.push_back(0.1f + 0.1f * motion::nextUniform(state));
    p.vx.push_back(1.0f), p.vy.push_back(0.0f), p.vz.push_back(motion::nextUniform(state));
    p.density.push_back(2.0f);
  }
  return p;
}

TEST(Points, GoThroughEveryKindOfFile) {
  const ScratchFolder folder;
  const PointSet points = somePoints();
  double speeds = 0.0, radii = 0.0;
  for (size_t n = 0; n < points.size(); ++n)
    speeds += double(points.vz[n]), radii += double(points.radius[n]);
  for (const char* const name : {"p.csv", "p.ply", "p.vdb"}) {
    writePoints(folder.file(name), points);
    const PointSet read = readPoints(folder.file(name));
    ASSERT_EQ(read.size(), points.size()) << name;
    ASSERT_EQ(read.vz.size(), points.size()) << name;
    double sums[3] = {};
    for (size_t n = 0; n < read.size(); ++n) {
      sums[0] += double(read.vz[n]);
      sums[1] += double(read.radius[n]);
      sums[2] += double(read.density[n]);
      // A .vdb sorts them: each is there, whichever its number.
      float least = 1e9f;
      for (size_t k = 0; k < points.size(); ++k)
        least = std::min(least, std::abs(read.x[n] - points.x[k]) + std::abs(read.y[n] - points.y[k]) +
                                    std::abs(read.z[n] - points.z[k]) + std::abs(read.vz[n] - points.vz[k]));
      ASSERT_LT(least, 1e-6f) << name;
    }
    EXPECT_NEAR(sums[0], speeds, 1e-3) << name;
    EXPECT_NEAR(sums[1], radii, 1e-3) << name;
    EXPECT_EQ(sums[2], 1000.0) << name;
  }
}

TEST(Points, AreEmittedAsTheyStand) {
  const ScratchFolder folder;
  writePoints(folder.file("p.ply"), somePoints());
  const std::string recipe = folder.write("p.yaml", R"(
assets:
  cast:
    voxel_size: 0.05
    particles: { emitters: [{ shape: points, file: p.ply, scale: 2 }], write_points: [csv, vdb] }
)");
  const auto records = bake(recipe, into(folder.file("out")));
  EXPECT_EQ(records.at(0).ledger->countAlive, 500u);
  for (const char* const name : {"out/cast_points.csv", "out/cast_points.vdb"}) {
    const PointSet read = readPoints(folder.file(name));
    ASSERT_EQ(read.size(), 500u) << name;
    double x = 0.0, expected = 0.0;
    for (const float v : read.x) x += double(v);
    for (const float v : somePoints().x) expected += 2.0 * double(v);
    EXPECT_NEAR(x, expected, 1e-3) << name;
  }
}

TEST(Points, MeshesEmitFromTheirSurfaceAndTheirInside) {
  const ScratchFolder folder;
  // A tetrahedron with corners at 0 and on the axes at 1.
  const std::string mesh =
      folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  Emitter emitter;
  emitter.shape = EmitterShape::mesh;
  emitter.scale = 2.0;
  constexpr int kCount = 4000;
  for (const bool surface : {false, true}) {
    emitter.surface = surface;
    const SiteSourcePtr source = makeSiteSource(emitter, mesh);
    double sum = 0.0;
    for (uint64_t n = 0; n < kCount; ++n) {
      const Site site = source->site(n, 7);
      const glm::vec3 p = 0.5f * site.position;
      const float least = std::min({p.x, p.y, p.z, 1.0f - p.x - p.y - p.z});
      ASSERT_GE(least, -1e-5f);
      ASSERT_LE(least, surface ? 1e-5f : 1.0f);
      sum += double(p.x);
    }
    // The mean of x: 1/4 inside; on the faces 1/3 but for x = 0, weighted by their areas ½, ½, ½ and √3/2.
    const double slanted = std::sqrt(3.0) / 2.0;
    EXPECT_NEAR(sum / kCount, surface ? (1.0 + slanted) / 3.0 / (1.5 + slanted) : 0.25, 0.01);
  }
}

}  // namespace
}  // namespace nephele::test
