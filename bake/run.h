// A whole bake: which files, which are up to date, field → grid → file, and the report. Depends on pipeline,
// voxelize, volume, base; no OpenVDB.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bake/choice.h"
#include "bake/particle_run.h"
#include "bake/pipeline.h"

namespace nephele {

/// I of N: every Nth file from the Ith on, 1 ≤ index ≤ count.
struct Shard {
  int index = 1;
  int count = 1;
};

struct BakeOptions {
  std::string outFolder = "out";
  std::vector<std::string> only;     // asset names; empty: all
  std::optional<FrameRange> frames;  // of what the recipe asks for; nullopt: all
  Shard shard;
  bool force = false;            // also what is up to date
  bool describeSkipped = false;  // read what is up to date, so that its record is whole
  bool quiet = false;            // no progress, no sentences about files
  uint64_t memoryBytes = std::numeric_limits<uint64_t>::max();  // what a grid may take
};

/// One file to be.
struct BakeJob {
  const Asset* asset = nullptr;
  std::optional<int> frame;
  std::string file;  // outFolder/NAME.vdb or outFolder/NAME_0001.vdb
};

/// How a loop closes: the frame that begins the asset's range against the one a loop later.
struct LoopSeam {
  int frame = 0;
  double largestDifference = 0.0;  // of densities
  std::string contentHash;         // of the frame a loop later
};

/// What one file cost and holds. Files that were up to date cost nothing.
struct BakeRecord {
  std::string name;
  std::string file;
  std::optional<int> frame;
  std::string recipeHash;
  bool skipped = false;
  double secondsFill = 0.0, secondsHash = 0.0, secondsSeam = 0.0, secondsWrite = 0.0;
  uint64_t voxelsActive = 0, voxelsEvaluated = 0;
  uint64_t gridBytes = 0, bytes = 0, peakBytes = 0;
  std::string contentHash;                           // of the density
  std::string velocityHash;                          // of the grid vel; empty where there is none
  double largestSpeed = 0.0, secondsVelocity = 0.0;  // world units per second
  double mass = 0.0, maximum = 0.0;
  std::optional<std::vector<BandLimitNote>> bandLimit;  // none where it is not known
  std::optional<int64_t> loopFrames;
  std::vector<LoopNote> loopNotes;
  std::optional<MassLedger> ledger;  // of particles
  double secondsSimulate = 0.0;
  std::optional<Choice> choice;  // of an asset with a tolerance; none where the file was up to date
  std::optional<LoopSeam> seam;  // measured with the asset's first frame; none where that was up to date
};

/// The files that the options select, in recipe order. Throws InputError for an asset that the recipe lacks,
/// and for frames none of which the recipe has.
std::vector<BakeJob> selectJobs(const Pipeline& pipeline, const BakeOptions& options);

/// Refuses, for all assets at once, densities that no grid can hold (checkDomain, bake/voxelize.h), each at
/// its first frame among the jobs; where a tolerance has yet to choose the voxels, what fills all of space
/// (checkEnds). Particles find their own limits. Throws InputError.
void checkDomains(const Pipeline& pipeline, const std::vector<BakeJob>& jobs, const BakeOptions& options);

/// Bakes what selectJobs() gives, after checkDomains() of what is not up to date. Each file appears whole or
/// not at all; one whose recipe hash, frame and size are those of this recipe is left as it is. Sentences go
/// to stderr. Throws InputError or WorldError.
std::vector<BakeRecord> bakeAll(const Pipeline& pipeline, const BakeOptions& options);

/// Makes the folder and those above it where they are missing. Throws WorldError.
void makeFolder(const std::string& folder);

/// What people should know of a note, without the line's end; empty where the report alone tells it.
std::string noteAsText(const BandLimitNote& note);

/// What people should know of a file: a line of its cost, and one for each thing worth telling.
std::string recordAsText(const BakeRecord& record);

/// The report of DESIGN.md, section 1: assets[{name, file, frame, seconds{…}, …}].
std::string reportAsJson(const std::vector<BakeRecord>& records);

}  // namespace nephele
