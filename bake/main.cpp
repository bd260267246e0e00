// nephele-bake: argv → run → exit code, nothing else.
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <thread>

#include "bake/cost_chart.h"
#include "bake/nodes.h"
#include "bake/run.h"
#include "bake/stability_page.h"
#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/tolerance.h"
#include "base/version.h"
#include "volume/check.h"
#include "volume/difference.h"
#include "volume/info.h"

namespace {

using namespace nephele;

struct Command {
  std::string pipeline = "pipeline.yaml";
  BakeOptions options;
  std::string frames, shard;
  int threads = 0;
  bool dryRun = false;
  std::string report;
  std::vector<std::string> files;
  bool json = false, stability = false;
  std::string node;
  std::string first, second, tolerance, page, audience;
};

Shard parseShard(const std::string& text) {
  Shard shard;
  char slash = 0;
  std::istringstream in(text);
  if (!(in >> shard.index >> slash >> shard.count) || slash != '/' || !in.eof() || shard.index < 1 ||
      shard.index > shard.count)
    throw InputError({}, "--shard must read I/N with 1 <= I <= N, not '" + text + "'");
  return shard;
}

int bake(Command command) {
  if (!command.frames.empty()) {
    command.options.frames = parseFrames(command.frames);
    if (!command.options.frames)
      throw InputError({}, "--frames must read A-B with 0 <= A <= B, not '" + command.frames + "'");
  }
  if (!command.shard.empty()) command.options.shard = parseShard(command.shard);
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  command.threads > 0 ? size_t(command.threads) : size_t(cores));
  const Pipeline pipeline = loadPipeline(command.pipeline);
  if (!command.report.empty() && command.report != "-") requireWritable(command.report);
  command.options.memoryBytes = availableMemory();
  if (command.dryRun) {
    const std::vector<BakeJob> jobs = selectJobs(pipeline, command.options);
    checkDomains(pipeline, jobs, command.options);
    for (const BakeJob& job : jobs) std::cout << job.file << '\n';
    return kExitDone;
  }
  command.options.describeSkipped = !command.report.empty();
  const std::string report = reportAsJson(bakeAll(pipeline, command.options));
  if (command.report == "-")
    std::cout << report;
  else if (!command.report.empty())
    writeText(command.report, report);
  return kExitDone;
}

int info(const Command& command) {
  std::vector<FileInfo> infos;
  for (const std::string& file : command.files) infos.push_back(inspectFile(file));
  if (command.json)
    std::cout << infoAsJson(infos);
  else
    for (const FileInfo& file : infos) std::cout << infoAsText(file);
  return kExitDone;
}

int nodes(const Command& command) {
  if (!command.page.empty())
    writeFieldsPage(command.page);
  else
    std::cout << (command.node.empty() ? nodesAsText() : nodeAsText(command.node));
  return kExitDone;
}

int diff(const Command& command) {
  const double tolerance = command.tolerance.empty() ? -1.0 : parseTolerance(command.tolerance);
  const GridDifference d = differenceOfFiles(command.first, command.second);
  std::cout << (command.json ? differenceAsJson(d, command.first, command.second) : differenceAsText(d));
  const bool over = std::max({d.relativeDensity(), d.relativeDepth(), d.relativeVelocity()}) > tolerance;
  return tolerance >= 0.0 && over ? kExitNo : kExitDone;
}

int stability(const Command& command) {
  makeFolder(command.options.outFolder);
  requireWritable(command.options.outFolder + "/stability.csv");
  const BakeStability result = runBakeStability(command.options.quiet);
  const std::string unable = writeBakeStability(command.options.outFolder, result);
  if (!unable.empty()) std::cerr << "warning: " << unable << '\n';
  const std::vector<std::string> bad = badBakes(result);
  for (const std::string& sentence : bad) std::cerr << sentence << '\n';
  return bad.empty() ? kExitDone : kExitNo;
}

int chart(const Command& command) {
  if (command.stability) return stability(command);
  const Pipeline pipeline = loadPipeline(command.pipeline);
  BakeOptions options = command.options;
  if (options.only.empty() && pipeline.assets.size() == 1) options.only = {pipeline.assets.front().name};
  if (options.only.size() != 1)
    throw InputError({pipeline.path, 0, 0}, "a chart is of one asset; name it by --only");
  const Asset& asset = *selectJobs(pipeline, options).front().asset;
  makeFolder(options.outFolder);
  const CostChart measured = measureCosts(pipeline, asset, options.outFolder, options.quiet);
  const std::string sentence = writeCostChart(options.outFolder, measured);
  for (const std::string& what : measured.leftOut) std::cerr << "left out: " << what << '\n';
  if (!sentence.empty()) std::cerr << "warning: " << sentence << '\n';
  std::cout << costFrontAsText(measured);
  return kExitDone;
}

int check(const Command& command) {
  const Audience audience = audienceOf(command.audience);
  std::vector<FileCheck> checks;
  std::vector<Diagnostic> unread;  // told once all others were checked
  for (const std::string& file : command.files) try {
      checks.push_back(checkFile(file, audience));
    } catch (const InputError& error) {
      unread.insert(unread.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  if (command.json)
    std::cout << checksAsJson(checks);
  else
    for (const FileCheck& file : checks) std::cout << checkAsText(file);
  if (!unread.empty()) throw InputError(unread);
  return std::all_of(checks.begin(), checks.end(), [](const FileCheck& c) { return c.good(); }) ? kExitDone
                                                                                                : kExitNo;
}

void addBake(CLI::App& app, Command& command) {
  app.add_option("PIPELINE", command.pipeline, "Recipe");
  app.add_option("--out", command.options.outFolder, "Folder for the .vdb files")->type_name("DIR");
  app.add_option("--only", command.options.only, "Bake this asset; may be given again")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->capture_default_str();
  app.add_option("--frames", command.frames,
                 "Only these frames, both ends included, which the recipe must have; default: all")
      ->type_name("A-B");
  app.add_option("--shard", command.shard, "Only every Nth file from the Ith on; default: all")
      ->type_name("I/N");
  app.add_option("--threads", command.threads, "Threads; 0: one per core")->check(CLI::Range(0, 4096));
  app.add_flag("--force", command.options.force, "Bake also what is up to date");
  app.add_flag("--dry-run", command.dryRun, "Check the recipe and print the files that would be written");
  app.add_option("--report", command.report, "Write a report as JSON; -: to stdout")->type_name("FILE.json");
  app.add_flag("--quiet", command.options.quiet, "Say nothing but errors and warnings");
}

/// A command beside baking, and what it does.
using Subcommand = std::pair<const CLI::App*, int (*)(const Command&)>;

Subcommand addInfo(CLI::App& app, Command& command) {
  CLI::App* const sub = app.add_subcommand("info", "Grids, boxes, voxels, memory, metadata of .vdb files");
  sub->add_option("FILE.vdb", command.files, "Files")->required();
  sub->add_flag("--json", command.json, "As JSON");
  return {sub, info};
}

Subcommand addNodes(CLI::App& app, Command& command) {
  CLI::App* const sub = app.add_subcommand("nodes", "Every field with its parameters");
  sub->add_option("NAME", command.node, "One field in full; default: all, a line each");
  sub->add_option("--markdown", command.page, "Write fields.md and a picture of each field into this folder")
      ->type_name("DIR");
  return {sub, nodes};
}

Subcommand addDiff(CLI::App& app, Command& command) {
  CLI::App* const sub = app.add_subcommand(
      "diff", "Density, optical-depth and velocity difference; exit 3 if over the tolerance");
  sub->add_option("A.vdb", command.first, "The reference")->required();
  sub->add_option("B.vdb", command.second, "What is held against it")->required();
  sub->add_option(
         "--tolerance", command.tolerance,
         "Largest density, optical-depth and velocity difference, relative to A's largest: 0.03 or 3%")
      ->type_name("E");
  sub->add_flag("--json", command.json, "As JSON");
  return {sub, diff};
}

Subcommand addCheck(CLI::App& app, Command& command) {
  CLI::App* const sub = app.add_subcommand(
      "check",
      "Whether .vdb files open well in other programs, a verdict for each rule; exit 3 if one does not");
  sub->add_option("FILE.vdb", command.files, "Files, whoever wrote them")->required();
  sub->add_option("--for", command.audience,
                  "Only the rules of this program: blender, houdini, unreal; default: all")
      ->type_name("DCC");
  sub->add_flag("--json", command.json, "As JSON");
  return {sub, check};
}

Subcommand addChart(CLI::App& app, Command& command) {
  CLI::App* const sub = app.add_subcommand(
      "chart", "Density and optical-depth error against seconds, bytes and memory of one asset's bake");
  sub->add_option("PIPELINE", command.pipeline, "Recipe");
  sub->add_option("--only", command.options.only, "The asset; may be left out where there is one alone")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->capture_default_str();
  sub->add_option("--out", command.options.outFolder, "Folder for chart.csv, .svg, .png and index.html")
      ->type_name("DIR");
  sub->add_flag(
      "--stability", command.stability,
      "In place of a chart: where bakes may be trusted, as stability.csv, .svg, .png and .md; needs "
      "no recipe; exit 3 where a density holds what none may");
  sub->add_flag("--quiet", command.options.quiet, "Say nothing but errors and warnings");
  return {sub, chart};
}

int run(int argc, char** argv) {
  Command command;
  CLI::App app("Bakes the clouds of a recipe into sparse .vdb files.", "nephele-bake");
  app.set_version_flag("--version", std::string(programVersion()));
  app.option_defaults()->always_capture_default();
  addBake(app, command);
  const Subcommand subcommands[] = {addInfo(app, command), addNodes(app, command), addDiff(app, command),
                                    addCheck(app, command), addChart(app, command)};
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // --help and --version come this way too.
    if (error.get_exit_code() == 0) return app.exit(error);
    throw InputError({}, error.what(), "try nephele-bake --help");
  }
  for (const auto& [sub, does] : subcommands)
    if (sub->parsed()) return does(command);
  return bake(command);
}

}  // namespace

int main(int argc, char** argv) {
  return nephele::runGuarded([&] { return run(argc, argv); });
}
