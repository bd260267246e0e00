// Which files a bake is to make. Depends on run.h, base.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "bake/run.h"

namespace nephele {
namespace {

std::string fileOf(const std::string& folder, const std::string& name, const std::optional<int>& frame) {
  char suffix[16] = "";
  if (frame) std::snprintf(suffix, sizeof suffix, "_%04d", *frame);
  return (std::filesystem::path(folder) / (name + suffix + ".vdb")).string();
}

/// Throws where either end of the frames that were asked for is beyond those of all jobs.
void refuseMissingFrames(const Pipeline& pipeline, const FrameRange& asked,
                         const std::vector<BakeJob>& jobs) {
  int first = asked.last, last = asked.first;
  for (const BakeJob& job : jobs)
    if (job.frame) first = std::min(first, *job.frame), last = std::max(last, *job.frame);
  if (first == asked.first && last == asked.last) return;
  throw InputError({pipeline.path, 0, 0}, "--frames asks for " + std::to_string(asked.first) + " to " +
                                              std::to_string(asked.last) + ", of which the assets have " +
                                              std::to_string(first) + " to " + std::to_string(last) +
                                              " alone");
}

}  // namespace

std::vector<BakeJob> selectJobs(const Pipeline& pipeline, const BakeOptions& options) {
  Diagnostics out;
  std::vector<std::string_view> names;
  for (const Asset& asset : pipeline.assets) names.push_back(asset.name);
  for (const std::string& name : options.only)
    if (std::find(names.begin(), names.end(), name) == names.end())
      out.add({pipeline.path, 0, 0}, "the recipe has no asset '" + name + "'", didYouMean(name, names));
  out.throwIfAny();
  std::vector<BakeJob> jobs;
  bool anySequence = false;
  for (const Asset& asset : pipeline.assets) {
    if (!options.only.empty() &&
        std::find(options.only.begin(), options.only.end(), asset.name) == options.only.end())
      continue;
    if (!asset.frames) {
      jobs.push_back({&asset, std::nullopt, fileOf(options.outFolder, asset.name, std::nullopt)});
      continue;
    }
    anySequence = true;
    for (int frame = asset.frames->first; frame <= asset.frames->last; ++frame)
      if (!options.frames || (options.frames->first <= frame && frame <= options.frames->last))
        jobs.push_back({&asset, frame, fileOf(options.outFolder, asset.name, frame)});
  }
  if (options.frames && (!anySequence || jobs.empty()))
    throw InputError({pipeline.path, 0, 0}, "no asset has a frame from " +
                                                std::to_string(options.frames->first) + " to " +
                                                std::to_string(options.frames->last));
  if (options.frames) refuseMissingFrames(pipeline, *options.frames, jobs);
  std::vector<BakeJob> mine;
  for (size_t n = 0; n < jobs.size(); ++n)
    if (int(n % size_t(options.shard.count)) == options.shard.index - 1) mine.push_back(jobs[n]);
  return mine;
}

}  // namespace nephele
