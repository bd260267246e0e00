// A whole bake. Depends on pipeline, voxelize, volume, base.
#include "bake/run.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <set>

#include "bake/velocity.h"
#include "bake/voxelize.h"
#include "base/files.h"
#include "base/progress.h"
#include "volume/info.h"
#include "volume/vdb_header.h"

namespace nephele {
namespace {

namespace fs = std::filesystem;

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The process's largest resident set so far, in bytes.
uint64_t peakBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return uint64_t(usage.ru_maxrss) * 1024;  // Linux counts kilobytes
}

/// Whether the file is there, whole, and baked from this recipe by this version.
bool isUpToDate(const BakeJob& job, const std::string& hash) {
  if (!fs::exists(job.file)) return false;
  try {
    const VdbHeader header = readVdbHeader(job.file);
    const auto found = header.metadata.find("recipe_hash");
    return found != header.metadata.end() && found->second == hash;
  } catch (const InputError&) {
    return false;  // damaged: bake it again
  }
}

Provenance provenanceOf(const Pipeline& pipeline, const BakeJob& job, const std::string& hash,
                        const Choice* choice) {
  Provenance provenance;
  if (choice) provenance.tolerance = choiceAsText(*choice);
  provenance.upAxis = pipeline.upAxis;
  provenance.recipeHash = hash;
  provenance.seed = pipeline.seed;
  provenance.frame = job.frame;
  if (job.asset->densityStep > 0.0) provenance.densityStep = job.asset->densityStep;
  if (job.asset->particles) {
    provenance.particles = writeParticles(*job.asset->particles);
    provenance.fps = job.asset->fps;
    provenance.cutoff = job.asset->cutoff;
  }
  if (pipeline.scene && pipeline.scene->medium) {
    provenance.hasMedium = true;
    provenance.sigmaS = pipeline.scene->medium->sigmaS;
    provenance.sigmaA = pipeline.scene->medium->sigmaA;
    provenance.g = pipeline.scene->medium->g;
  }
  return provenance;
}

/// Fills a record from the file itself.
void describe(const std::string& file, BakeRecord& record) {
  const FileInfo info = inspectFile(file);
  record.bytes = info.fileBytes;
  for (const GridInfo& grid : info.grids) {
    if (grid.name == "density") record.voxelsActive += grid.activeVoxels;
    record.gridBytes += grid.bytes;
    if (grid.name == "density") record.contentHash = grid.contentHash;
    if (grid.name == "vel") record.velocityHash = grid.contentHash;
  }
  if (const auto mass = info.metadata.find("mass"); mass != info.metadata.end())
    record.mass = std::stod(mass->second);
  record.peakBytes = peakBytes();
}

/// What the grid could not hold of a file that is up to date; of one whose tolerance chose the voxels, the
/// file does not say.
std::optional<std::vector<BandLimitNote>> bandLimitOf(const Pipeline& pipeline, const BakeJob& job) {
  if (job.asset->tolerance) return std::nullopt;
  std::vector<BandLimitNote> notes;
  if (!job.asset->density) return notes;
  BuildContext context = contextOf(pipeline, *job.asset, job.frame);
  context.notes = &notes;
  buildField(*job.asset->density, context);
  return notes;
}

VoxelizeSettings settingsOf(const Asset& asset, const BakeOptions& options) {
  const bool vel = asset.velocityFromMotion || !asset.velocityFields.empty();
  return {asset.voxelSize,
          asset.cutoff,
          asset.precision == Precision::half,
          options.memoryBytes,
          vel ? kVelocityLeafBytes : 0,
          asset.densityStep};
}

std::string refusalOf(const Asset& asset, const VoxelizeError& error) {
  return "asset '" + asset.name + "': " + error.what();
}

[[noreturn]] void refuse(const Asset& asset, const VoxelizeError& error) {
  throw InputError(asset.where, refusalOf(asset, error));
}

Velocities fillVelocity(const VectorField& velocity, const Voxelized& density, const Asset& asset,
                        const BakeOptions& options) {
  try {
    return voxelizeVelocity(
        density, settingsOf(asset, options),
        [&](const Lattice& lattice, float* x, float* y, float* z) { velocity.evaluate(lattice, x, y, z); });
  } catch (const VoxelizeError& error) {
    refuse(asset, error);
  }
}

/// Calls work(LeafProgress) with a bar that it moves, and names the asset where the density is refused.
template <class Work>
auto withBar(const Asset& asset, const std::string& label, bool quiet, const Work& work) {
  std::unique_ptr<Progress> bar;
  uint64_t drawn = 0;
  std::mutex mutex;
  const LeafProgress progress = [&](uint64_t leaves, uint64_t total) {
    const std::lock_guard lock(mutex);
    if (!bar) bar = std::make_unique<Progress>(label, total, quiet);
    if (leaves > drawn) bar->advance(leaves - drawn);
    drawn = std::max(drawn, leaves);
  };
  try {
    return work(progress);
  } catch (const VoxelizeError& error) {
    refuse(asset, error);
  }
}

/// Holds the frame a loop after the asset's first one against that.
LoopSeam measureSeam(const Pipeline& pipeline, const Asset& asset, const Voxelized& first,
                     const BakeOptions& options) {
  LoopSeam seam;
  seam.frame = asset.frames->first + int(*asset.loopFrames);
  const FieldPtr field = buildField(*asset.density, contextOf(pipeline, asset, seam.frame));
  const DensityChange change =
      withBar(asset, asset.name + ": seam", options.quiet, [&](const LeafProgress& progress) {
        return changeFrom(first, *field, settingsOf(asset, options), progress);
      });
  seam.largestDifference = change.largestDifference;
  seam.contentHash = change.contentHash;
  return seam;
}

void warnOf(const std::string& file, int longestAxis, uint64_t voxelsActive) {
  // Blender's viewport and texture-based viewers allocate the whole box.
  constexpr int kLongAxis = 2048;
  if (longestAxis > kLongAxis)
    std::cerr << "warning: " << file << ": " << longestAxis
              << " voxels along its longest axis; viewers that make grids dense may run out of memory\n";
  if (voxelsActive == 0)
    std::cerr << "warning: " << file << ": no voxel exceeds the cutoff; the file is valid and empty\n";
}

BakeRecord bakeParticles(const Pipeline& pipeline, const BakeJob& job, const std::string& hash,
                         const Choice* choice, ParticleRun& run) {
  BakeRecord record;
  record.bandLimit.emplace();
  const ParticleFrame frame = run.frame(job.frame);
  record.secondsSimulate = frame.secondsSimulate;
  record.secondsFill = frame.secondsSplat;
  record.ledger = frame.mass;
  auto start = std::chrono::steady_clock::now();
  record.contentHash = contentHashOf(frame.splatted, "density");
  record.velocityHash = contentHashOf(frame.splatted, "vel");
  record.secondsHash = secondsSince(start);
  start = std::chrono::steady_clock::now();
  // Points first: the grid's presence says that all of the frame is there.
  run.writePointsBeside(job.file);
  record.bytes = writeSplatted(job.file, frame.splatted, provenanceOf(pipeline, job, hash, choice));
  record.secondsWrite = secondsSince(start);
  record.voxelsActive = frame.splatted.voxelsActive;
  record.gridBytes = frame.splatted.gridBytes;
  record.mass = frame.mass.stored;
  record.maximum = frame.splatted.maximum;
  record.peakBytes = peakBytes();
  warnOf(job.file, frame.splatted.longestAxis, frame.splatted.voxelsActive);
  return record;
}

BakeRecord bakeOne(const Pipeline& pipeline, const BakeJob& job, const std::string& hash,
                   const Choice* choice, const BakeOptions& options) {
  BakeRecord record;
  BuildContext context = contextOf(pipeline, *job.asset, job.frame);
  context.notes = &record.bandLimit.emplace();
  auto start = std::chrono::steady_clock::now();
  const FieldPtr field = buildField(*job.asset->density, context);
  const Voxelized voxelized = withBar(*job.asset, fs::path(job.file).filename().string(), options.quiet,
                                      [&](const LeafProgress& progress) {
                                        return voxelize(*field, settingsOf(*job.asset, options), progress);
                                      });
  record.secondsFill = secondsSince(start);
  start = std::chrono::steady_clock::now();
  record.contentHash = contentHashOf(voxelized);
  record.secondsHash = secondsSince(start);
  if (job.asset->loopFrames && job.frame == job.asset->frames->first) {
    start = std::chrono::steady_clock::now();
    record.seam = measureSeam(pipeline, *job.asset, voxelized, options);
    record.secondsSeam = secondsSince(start);
  }
  std::optional<Velocities> velocities;
  context.notes = nullptr;  // the density has told them
  if (const VectorFieldPtr velocity = buildVelocity(*job.asset, context)) {
    start = std::chrono::steady_clock::now();
    velocities = fillVelocity(*velocity, voxelized, *job.asset, options);
    record.velocityHash = velocities->contentHash;
    record.largestSpeed = velocities->largestSpeed;
    record.secondsVelocity = secondsSince(start);
  }
  start = std::chrono::steady_clock::now();
  record.bytes = writeDensity(job.file, voxelized, provenanceOf(pipeline, job, hash, choice),
                              velocities ? &*velocities : nullptr);
  record.secondsWrite = secondsSince(start);
  record.voxelsActive = voxelized.voxelsActive;
  record.voxelsEvaluated = voxelized.voxelsEvaluated;
  record.gridBytes = voxelized.gridBytes;
  record.mass = voxelized.mass;
  record.maximum = voxelized.maximum;
  record.peakBytes = peakBytes();
  warnOf(job.file, voxelized.longestAxis, voxelized.voxelsActive);
  return record;
}

/// What the asset's tolerance chooses, measured once.
const Choice& settle(const Pipeline& pipeline, const Asset& asset, const BakeOptions& options,
                     std::map<const Asset*, Choice>& choices) {
  if (const auto known = choices.find(&asset); known != choices.end()) return known->second;
  const Choice& choice = choices[&asset] = chooseFor(pipeline, asset, options.outFolder);
  if (!options.quiet) {
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, " (%.1f s)", choice.seconds);
    std::cerr << asset.name << ": " << choiceAsText(choice) << seconds << '\n';
  }
  return choice;
}

}  // namespace

void checkDomains(const Pipeline& pipeline, const std::vector<BakeJob>& jobs, const BakeOptions& options) {
  Diagnostics out;
  std::set<const Asset*> checked;
  for (const BakeJob& job : jobs) {
    const Asset& asset = *job.asset;
    if (!asset.density || !checked.insert(&asset).second) continue;
    try {
      const FieldPtr field = buildField(*asset.density, contextOf(pipeline, asset, job.frame));
      if (asset.tolerance)
        checkEnds(*field);  // its voxels are yet to be chosen
      else
        checkDomain(*field, settingsOf(asset, options));
    } catch (const VoxelizeError& error) {
      out.add(asset.where, refusalOf(asset, error));
    }
  }
  out.throwIfAny();
}

void makeFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw WorldError("cannot make the folder '" + folder + "': " + error.message());
}

std::vector<BakeRecord> bakeAll(const Pipeline& pipeline, const BakeOptions& options) {
  const std::vector<BakeJob> jobs = selectJobs(pipeline, options);
  std::vector<BakeJob> due;
  for (const BakeJob& job : jobs)
    if (options.force || !isUpToDate(job, recipeHash(pipeline, *job.asset, job.frame))) due.push_back(job);
  checkDomains(pipeline, due, options);
  makeFolder(options.outFolder);
  removeLeftovers(options.outFolder);
  std::vector<BakeRecord> records;
  std::map<const Asset*, std::unique_ptr<ParticleRun>> runs;
  std::map<const Asset*, Choice> choices;
  for (BakeJob job : jobs) {
    const std::string hash = recipeHash(pipeline, *job.asset, job.frame);
    const Choice* choice = nullptr;
    BakeRecord record;
    if (!options.force && isUpToDate(job, hash)) {
      record.skipped = true;
      if (options.describeSkipped) {
        describe(job.file, record);
        record.bandLimit = bandLimitOf(pipeline, job);
      }
    } else {
      if (job.asset->tolerance) choice = &settle(pipeline, *job.asset, options, choices);
      if (choice) job.asset = &choice->asset;
      if (job.asset->particles) {
        auto& run = runs[job.asset];
        if (!run) run = std::make_unique<ParticleRun>(pipeline, *job.asset, options.outFolder);
        record = bakeParticles(pipeline, job, hash, choice, *run);
      } else {
        record = bakeOne(pipeline, job, hash, choice, options);
      }
    }
    if (choice) record.choice = *choice;
    record.name = job.asset->name;
    record.file = job.file;
    record.frame = job.frame;
    record.recipeHash = hash;
    record.loopFrames = job.asset->loopFrames;
    // Told once, with the frame that the seam is measured with.
    if (job.frame && job.frame == job.asset->frames->first) record.loopNotes = loopNotesOf(*job.asset);
    if (!options.quiet) std::cerr << recordAsText(record);
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace nephele
