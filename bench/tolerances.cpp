// Every recipe of a folder at tolerances of 10, 3 and 1%: what was chosen, the error along rays that the
// choice did not see, and the bytes against the recipe's own voxel size, as a table in Markdown. Ends with
// exit code 3 where a tolerance does not hold. Depends on choice, trial.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "bake/choice.h"
#include "bake/trial.h"
#include "base/error.h"
#include "base/figures.h"
#include "base/tolerance.h"

namespace nephele::bench {
namespace {

constexpr double kTolerances[] = {0.10, 0.03, 0.01};

struct Asked {
  std::string folder, only;
  uint64_t seed = 1;  // the choice itself uses 0
  std::vector<double> tolerances{std::begin(kTolerances), std::end(kTolerances)};
  bool trials = false;  // print what was tried as well, to stderr
};

/// Bytes of the files of the frames that a choice measures.
double bytesOf(const Pipeline& pipeline, const Asset& asset, const std::string& scratch) {
  const TrialBaker baker(pipeline, asset, sampledFrames(asset), scratch);
  const std::string file = scratch + "/trial";
  double bytes = 0.0;
  for (size_t n = 0; n < baker.frameCount(); ++n) bytes += double(baker.bake(n, asset, file).fileBytes);
  std::filesystem::remove(file);
  return bytes;
}

/// Sums over recipes of one tolerance.
struct Shares {
  double sum = 0.0, count = 0.0;       // of the shares
  double chosen = 0.0, recipes = 0.0;  // bytes of all files
};

/// One line of the table. Returns whether the tolerance holds.
bool measure(const Pipeline& pipeline, double tolerance, const Asked& asked, const std::string& scratch,
             Shares& shares) {
  const Asset& own = pipeline.assets.front();
  Asset asset = own;
  asset.tolerance = tolerance;
  asset.precisionGiven = false;
  const Choice choice = chooseFor(pipeline, asset, scratch);
  if (asked.trials)
    for (const ChoiceTrial& t : choice.trials)
      std::cerr << "  " << number(t.voxelSize, 3) << (t.precision == Precision::half ? " half " : " float ")
                << t.mostOctaves << " octaves, step " << number(t.densityStep, 3) << ": " << percent(t.error)
                << ", " << number(t.voxels, 3) << " voxels\n";
  const double fresh =
      depthError(pipeline, finerThan(choice.asset), choice.asset, kChoiceRays, asked.seed, scratch);
  const double chosenBytes = bytesOf(pipeline, choice.asset, scratch),
               ownBytes = bytesOf(pipeline, own, scratch), bytes = chosenBytes / ownBytes;
  shares.chosen += chosenBytes;
  shares.recipes += ownBytes;
  shares.sum += bytes;
  shares.count += 1.0;
  const bool holds = fresh <= tolerance;
  std::cout << "| " << own.name << " | " << percent(tolerance) << " | " << number(choice.asset.voxelSize, 3)
            << " of " << number(own.voxelSize, 3) << " | "
            << (choice.asset.precision == Precision::half ? "half" : "float") << " | "
            << (choice.asset.mostOctaves == kAllOctaves ? "all" : std::to_string(choice.asset.mostOctaves))
            << " | " << (choice.asset.densityStep > 0.0 ? number(choice.asset.densityStep, 3) : "none")
            << " | " << percent(choice.measured) << " | " << percent(fresh) << (holds ? "" : " **over**")
            << " | " << number(bytes, 3) << " | " << number(choice.seconds, 2) << " |" << std::endl;
  return holds;
}

Asked parsed(int argc, char** argv) {
  Asked asked;
  std::vector<double> tolerances;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--seed" && i + 1 < argc)
      asked.seed = std::strtoull(argv[++i], nullptr, 10);
    else if (word == "--trials")
      asked.trials = true;
    else if (word == "--only" && i + 1 < argc)
      asked.only = argv[++i];
    else if (word == "--tolerance" && i + 1 < argc)
      tolerances.push_back(parseTolerance(argv[++i]));
    else
      asked.folder = word;
  }
  if (!tolerances.empty()) asked.tolerances = tolerances;
  if (asked.folder.empty())
    throw InputError(
        {}, "usage: nephele_tolerances FOLDER [--seed N] [--only NAME] [--tolerance 3%]... [--trials]");
  return asked;
}

int run(const Asked& asked) {
  std::vector<std::string> recipes;
  for (const auto& entry : std::filesystem::directory_iterator(asked.folder))
    if (entry.path().extension() == ".yaml" && (asked.only.empty() || entry.path().stem() == asked.only))
      recipes.push_back(entry.path().string());
  if (recipes.empty())
    throw InputError(
        {}, "no recipe" + (asked.only.empty() ? "" : " '" + asked.only + "'") + " in " + asked.folder);
  std::sort(recipes.begin(), recipes.end());
  std::string scratch = (std::filesystem::temp_directory_path() / "nephele_tolerances_XXXXXX").string();
  if (mkdtemp(scratch.data()) == nullptr) throw WorldError("no scratch folder");
  std::cout << "| sample | asked | voxel size | precision | octaves | step | measured | on fresh rays | "
               "bytes, of the "
               "recipe's | seconds |\n|---|---|---|---|---|---|---|---|---|---|\n";
  bool allHold = true;
  std::vector<Shares> shares(asked.tolerances.size());
  for (const std::string& recipe : recipes) {
    const Pipeline pipeline = loadPipeline(recipe);
    for (size_t t = 0; t < asked.tolerances.size(); ++t)
      allHold &= measure(pipeline, asked.tolerances[t], asked, scratch, shares[t]);
  }
  for (size_t t = 0; t < shares.size(); ++t)
    std::cout << "\n"
              << percent(asked.tolerances[t]) << ": bytes of the recipe's, on average "
              << number(shares[t].sum / shares[t].count, 3) << " over " << shares[t].count
              << " samples, of all files together " << number(shares[t].chosen / shares[t].recipes, 3)
              << "\n";
  std::filesystem::remove_all(scratch);
  return allHold ? kExitDone : kExitNo;
}

}  // namespace
}  // namespace nephele::bench

int main(int argc, char** argv) {
  return nephele::runGuarded([&] { return nephele::bench::run(nephele::bench::parsed(argc, argv)); });
}
