// Fitting from the command line. Depends on preview, volume, base.
#include "preview/fit_command.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>

#include "base/chart.h"
#include "base/error.h"
#include "base/figures.h"
#include "base/files.h"
#include "preview/measure/fit_octaves.h"
#include "preview/render_command.h"
#include "preview/resolve.h"
#include "scene/light_model.h"
#include "volume/metadata.h"

namespace nephele {
namespace {

/// A volume on the table; its bricks do not move.
struct Opened {
  std::unique_ptr<BrickVolume> bricks;
  FitSubject subject;
};

Opened openSubject(const std::string& path, const Scene& scene, const FitCommandOptions& options,
                   double aspect) {
  Opened opened{std::make_unique<BrickVolume>(openVolume(path, options.grid)), {}};
  if (opened.bricks->empty()) throw InputError({path}, "an empty grid has nothing to fit to");
  std::string sentence;
  opened.subject = {std::filesystem::path(path).stem().string(), opened.bricks.get(),
                    resolveScene(scene, *opened.bricks, aspect, sentence)};
  std::cerr << opened.subject.name << ": " << sentence << '\n';
  return opened;
}

Table tableOf(const FitResult& result) {
  Table table{{"view", "fitted_to", "before", "before_low95", "before_high95", "after", "after_low95",
               "after_high95", "at_best"},
              {}};
  for (const FitView& view : result.views)
    table.rows.push_back({view.name, view.fitted ? "1" : "0", std::to_string(view.before.relativeRmse),
                          std::to_string(view.before.low), std::to_string(view.before.high),
                          std::to_string(view.after.relativeRmse), std::to_string(view.after.low),
                          std::to_string(view.after.high), view.atBest ? std::to_string(*view.atBest) : ""});
  return table;
}

/// Error after over error before, each view a mark; below the line of equals factors are better.
std::string drawFit(const std::string& folder, const FitResult& result) {
  ChartPanel panel{"Octaves fitted to the reference",
                   "relative RMSE with a = b = c = 0.5",
                   "relative RMSE with fitted factors",
                   {}};
  ChartSeries fitted{"fitted to", {}, false}, held{"held back", {}, false},
      half{"half of the error", {}, true};
  double least = 1.0, most = 0.0;
  for (const FitView& view : result.views) {
    const double x = view.before.relativeRmse;
    (view.fitted ? fitted : held)
        .points.push_back({x, view.after.relativeRmse, view.after.low, view.after.high});
    least = std::min(least, x);
    most = std::max(most, x);
  }
  for (const double x : {least, most}) half.points.push_back({x, 0.5 * x, 0.5 * x, 0.5 * x});
  panel.series = {fitted, held, half};
  return drawChart({panel}, folder, "fit");
}

void report(const FitResult& result) {
  std::cout << result.count << " octaves\n";
  for (size_t node = 0; node < result.factors.size(); ++node) {
    const OctaveFactors& factors = result.factors[node];
    char text[128];
    std::snprintf(text, sizeof text, "sun at %.0f degrees: a %.3f, b %.3f, c %.3f, d %.3f\n",
                  kFittedElevations[node], factors[0], factors[1], factors[2], factors[kOpenness]);
    std::cout << text;
  }
  const auto over = [](const char* name, const std::vector<FitView>& views, bool fitted) {
    std::cout << name << ": " << percent(errorOver(views, fitted, FitStage::before)) << " before, "
              << percent(errorOver(views, fitted, FitStage::after)) << " after";
    const double atBest = errorOver(views, fitted, FitStage::atBest);
    if (atBest > 0.0) std::cout << ", " << percent(atBest) << " by factors of each view's own";
    std::cout << '\n';
  };
  std::vector<FitView> own, others;
  for (const FitView& view : result.views) (view.atBest ? own : others).push_back(view);
  over("views fitted to", own, true);
  over("views held back", own, false);
  if (!others.empty()) over("files not fitted to", others, false);
  std::cout << std::flush;
}

}  // namespace

int fitCommand(const FitCommandOptions& options) {
  if (options.files.empty()) throw InputError({}, "fit needs a FILE.vdb");
  if (!options.out.empty()) {
    std::error_code failed;
    std::filesystem::create_directories(options.out, failed);
    if (failed) throw WorldError("cannot make the folder '" + options.out + "': " + failed.message());
    requireWritable(options.out + "/fit.csv");
  }
  if (!options.dryRun)
    for (const std::string& file : options.files) requireWritable(file);
  Scene scene = options.scene.empty() ? Scene{} : openScene(options.scene, {});
  if (scene.stage.on) std::cerr << "fit: the stage has no truth and is left out\n";
  scene.stage.on = false;
  FitOptions fitting;
  fitting.quiet = options.quiet;
  fitting.count = options.count;
  fitting.width = options.width;
  fitting.height = options.height;
  if (!fitting.count && scene.octaves.count.value_or(0) > 0) fitting.count = *scene.octaves.count;
  const double aspect = static_cast<double>(fitting.width) / fitting.height;
  std::vector<Opened> opened;  // owns what the subjects point at
  std::vector<FitSubject> subjects, checks;
  const auto open = [&](const std::vector<std::string>& paths, std::vector<FitSubject>& into) {
    for (const std::string& path : paths) {
      opened.push_back(openSubject(path, scene, options, aspect));
      into.push_back(opened.back().subject);
    }
  };
  open(options.files, subjects);
  open(options.checks, checks);
  const auto march = findMethod("march").make({}), truth = findMethod("reference").make({});
  const FitResult result = fitOctaves(*march, *truth, subjects, checks, fitting);
  report(result);
  if (!options.out.empty()) {
    writeCsv(options.out + "/fit.csv", tableOf(result));
    const std::string unable = drawFit(options.out, result);
    if (!unable.empty()) std::cerr << unable << '\n';
  }
  const bool worse = worsensHeldBack(result.views);
  if (worse)
    std::cerr << "fit: views held back are farther from the reference with these factors than with 0.5\n";
  if (options.dryRun) return kExitDone;
  if (worse && !options.evenIfWorse) {
    std::cerr << "fit: nothing is stored; --even-if-worse stores them nevertheless\n";
    return kExitNo;
  }
  std::map<std::string, std::vector<double>> numbers{{kFittedCount, {static_cast<double>(result.count)}}};
  for (size_t i = 0; i < std::size(kFittedFactors); ++i)
    for (const OctaveFactors& factors : result.factors) numbers[kFittedFactors[i]].push_back(factors[i]);
  for (const std::string& file : options.files) addMetadata(file, numbers);
  return kExitDone;
}

}  // namespace nephele
