// Which files a bake is to make. Depends on run.h, base.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>

#include "bake/run.h"

namespace nephele {
namespace {

std::string fileOf(const std::string& folder, const std::string& name, const std::optional<int>& frame) {
  char suffix[16] = "";
  if (frame) std::snprintf(suffix, sizeof suffix, "_%04d", *frame);
  return (std::filesystem::path(folder) / (name + suffix + ".vdb")).string();
}

/// Throws where no job has one of the frames that were asked for.
void refuseMissingFrames(const Pipeline& pipeline, const FrameRange& asked,
                         const std::vector<BakeJob>& jobs) {
  std::set<int> frames;
  for (const BakeJob& job : jobs)
    if (job.frame) frames.insert(*job.frame);
  const std::string range = std::to_string(asked.first) + " to " + std::to_string(asked.last);
  if (frames.empty()) throw InputError({pipeline.path, 0, 0}, "no asset has a frame from " + range);
  for (int frame = asked.first; frame <= asked.last; ++frame)
    if (!frames.contains(frame))
      throw InputError({pipeline.path, 0, 0},
                       "--frames asks for " + range + ", and no asset has frame " + std::to_string(frame));
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
  for (const Asset& asset : pipeline.assets) {
    if (!options.only.empty() &&
        std::find(options.only.begin(), options.only.end(), asset.name) == options.only.end())
      continue;
    if (!asset.frames) {
      jobs.push_back({&asset, std::nullopt, fileOf(options.outFolder, asset.name, std::nullopt)});
      continue;
    }
    for (int frame = asset.frames->first; frame <= asset.frames->last; ++frame)
      if (!options.frames || (options.frames->first <= frame && frame <= options.frames->last))
        jobs.push_back({&asset, frame, fileOf(options.outFolder, asset.name, frame)});
  }
  if (options.frames) refuseMissingFrames(pipeline, *options.frames, jobs);
  std::vector<BakeJob> mine;
  for (size_t n = 0; n < jobs.size(); ++n)
    if (int(n % size_t(options.shard.count)) == options.shard.index - 1) mine.push_back(jobs[n]);
  return mine;
}

}  // namespace nephele
