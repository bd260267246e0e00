// Headless rendering and comparing. Depends on preview, volume and base.
#include "preview/render_command.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "base/files.h"
#include "preview/behind.h"
#include "preview/measure/compare.h"
#include "preview/measure/error_request.h"
#include "preview/measure/trust.h"
#include "preview/method.h"
#include "preview/render_stats.h"
#include "preview/resolve.h"
#include "preview/temperature.h"
#include "scene/light_model.h"
#include "scene/presets.h"

namespace nephele {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kReferenceMethod = "reference", kMarchMethod = "march";
constexpr double kPercent = 100.0;
constexpr size_t kColourPlanes = 4;  // R, G, B, A come first

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string padded(int frame, size_t width) {
  std::ostringstream out;
  out << std::setw(static_cast<int>(width)) << std::setfill('0') << frame;
  return out.str();
}

/// Replaces the last run of # in the file name; empty where there is none.
std::string replaceHashes(const std::string& path, int frame) {
  const size_t last = path.rfind('#');
  if (last == std::string::npos) return {};
  size_t first = last;
  while (first > 0 && path[first - 1] == '#') --first;
  return path.substr(0, first) + padded(frame, last + 1 - first) + path.substr(last + 1);
}

bool hasExtension(const std::string& path, const std::string& extension) {
  return std::filesystem::path(path).extension() == extension;
}

void checkOptions(const RenderOptions& options) {
  Diagnostics complaints;
  const bool exr = hasExtension(options.out, ".exr");
  if (!exr && !hasExtension(options.out, ".png"))
    complaints.add({}, "--render '" + options.out + "' should end in .exr or .png");
  if (options.aov && !exr) complaints.add({}, "--aov needs an .exr: a .png holds no further channels");
  if (options.samples == 0u) complaints.add({}, "--spp should be at least 1");
  if (options.frames && options.frames->first > options.frames->second)
    complaints.add({}, "--frames: the first frame is after the last");
  const bool chooses = options.error > 0.0 && options.method != kReferenceMethod;
  if (options.bounces && options.method != kReferenceMethod && !chooses)
    complaints.add(
        {},
        "--bounces needs --method reference or --error; the march takes its orders from the scene's "
        "octaves");
  if (chooses && options.method != kMarchMethod)
    complaints.add({}, "--error chooses between the march and the reference; it does not take --method " +
                           options.method);
  if (chooses && (options.samples || options.stepVoxels))
    complaints.add({}, "--error chooses steps and samples itself; leave out --step and --spp");
  complaints.throwIfAny();
}

/// Renders one frame after another; the first one chooses camera, medium and exposure for all, so that
/// nothing flickers.
class Sequence {
 public:
  explicit Sequence(const RenderOptions& options)
      : options_(options),
        row_(findMethod(options.method)),
        scene_(openScene(options.scene, options.stepVoxels)) {}

  void frame(const std::string& in, const std::string& out) {
    const auto start = Clock::now();
    const double apart = method_ ? apartOf(*method_) : 0.0;
    BrickVolume bricks = openVolume(in, options_.grid);
    addTemperature(bricks, scene_.emission);
    totals_.secondsLoad += secondsSince(start);
    if (!view_) {
      std::string sentence;
      view_ = resolveScene(scene_, bricks, static_cast<double>(options_.width) / options_.height, sentence);
      if (scene_.stage.on) requireStage();
      std::cerr << sentence << '\n' << describeLight(*view_) << '\n';
      if (isReference()) tellWhatIsLeftOut();
      const SceneFacts facts = sceneFactsOf(brickFactsOf(bricks), bricks, *view_);
      if (!chooses())  // --error measures instead
        for (const std::string& warning : trustWarnings(row_.name, facts, *view_, trustTable()))
          std::cerr << warning << '\n';
      method_ = row_.make({options_.filter, options_.vramBytes});
    }
    method_->setVolume(bricks);
    PictureCost cost;
    Picture picture = chooses() ? renderWithin(bricks, cost) : method_->render(*view_, request(), cost);
    totals_.secondsToLastPixel += secondsSince(start) - (apartOf(*method_) - apart);
    if (cost.relativeError > 0.0 && !chooses())
      std::cerr << "noise: " << kPercent * cost.relativeError << "% relative RMSE\n";
    if (!exposureEv_) exposureEv_ = hasExtension(out, ".png") ? exposureFor(options_, picture) : 0.0;
    writePicture(out, std::move(picture), *view_, *exposureEv_, options_.aov);
    totals_.add(cost);
    if (view_->scene.march.checkSkips && !isReference())
      std::cerr << "check_skips: of " << cost.skipsChecked << " densities checked, bounds were wrong for "
                << cost.skipsWrong << '\n';
    if (cost.voxelPixels > view_->scene.march.levelPixels)
      std::cerr << "levels: GPU memory or textures end before the picture is resolved; voxels cover up to "
                << cost.voxelPixels << " pixels\n";
  }

  /// Writes the stats of the frames that were rendered, where there are any.
  void finish() const {
    if (!options_.stats.empty() && totals_.frames > 0)
      writeRenderStats(options_.stats, totals_, *method_, *view_, options_.error);
  }

 private:
  PictureRequest request() const {
    constexpr unsigned kSamples = 4, kReferenceSamples = 64;
    PictureRequest request;
    request.width = options_.width;
    request.height = options_.height;
    request.samples = options_.samples.value_or(isReference() ? kReferenceSamples : kSamples);
    request.seed = options_.seed;
    request.bounces = options_.bounces;
    request.error = options_.error;
    return request;
  }
  void requireStage() const {
    if (row_.name != kMarchMethod && !isReference())
      throw InputError(
          {},
          "the stage is drawn by --method march and reference alone; switch it off by stage: { on: false }");
    if (chooses() && (scene_.stage.highlights || scene_.stage.penumbra > 0.0))
      throw InputError(
          {},
          "--error needs truth, and the stage's highlights and penumbras have none; switch them off by "
          "stage: { highlights: false, penumbra: 0 }");
  }
  /// The path tracer knows physics alone.
  void tellWhatIsLeftOut() const {
    for (const LightTerm& term : termsOf(lightModelOf(view_->scene, view_->medium)))
      if (term.on && !term.physical)
        std::cerr << "reference: leaves out '" << term.name << "', which has no truth: it " << term.sentence
                  << '\n';
    if (scene_.stage.on && (scene_.stage.highlights || scene_.stage.penumbra > 0.0))
      std::cerr << "reference: leaves out the stage's highlights and penumbras, which have no truth\n";
  }
  /// Seconds that are told apart from those of pictures.
  static double apartOf(const Method& method) { return method.secondsDriver + method.secondsShaders; }
  bool isReference() const { return row_.name == kReferenceMethod; }
  bool chooses() const { return options_.error > 0.0 && !isReference(); }

  /// A picture that errs by no more than --error asks: the cheapest way that is expected to, and the next one
  /// where the picture then measures worse.
  Picture renderWithin(const BrickVolume& bricks, PictureCost& cost) {
    requireTruth(*view_);
    if (!truth_) truth_ = findMethod(std::string(kReferenceMethod)).make({});
    truth_->setVolume(bricks);
    ErrorReport report;
    auto start = Clock::now();
    ErrorSearch search(*method_, *truth_, *view_, request());
    report.stride = search.stride();
    report.bounces = bouncesOfTruth(*view_, options_.bounces);
    for (size_t from = 0;; from = report.pick.rung + 1) {
      report.pick = search.pick(options_.error, from);
      report.waysMeasured = search.measuredRungs();
      report.secondsChoosing += secondsSince(start);
      std::cerr << "error: picked " << report.pick.setting.name << ", expected to err by "
                << kPercent * report.pick.error << "% in " << report.pick.milliseconds << " ms, of "
                << report.waysMeasured << " ways measured\n";
      Picture picture = renderPick(report, cost);
      start = Clock::now();
      const bool kept = measure(search, picture, cost, report);
      report.secondsMeasuring += secondsSince(start);
      if (kept) {
        totals_.error = report;
        return picture;
      }
      start = Clock::now();
    }
  }

  Picture renderPick(ErrorReport& report, PictureCost& cost) {
    constexpr double kMillisecondsASecond = 1000.0;
    const std::clock_t before = std::clock();
    Picture picture = renderPicked(report, cost);
    report.processorMilliseconds =
        kMillisecondsASecond * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    return picture;
  }

  Picture renderPicked(const ErrorReport& report, PictureCost& cost) {
    PictureRequest asked = request();
    cost = {};
    if (report.pick.setting.method != kReferenceMethod) {
      asked.samples = report.pick.setting.samples;
      return method_->render(withSetting(*view_, report.pick.setting), asked, cost);
    }
    asked.error = options_.error;
    asked.bounces = report.bounces;
    return truth_->render(*view_, asked, cost);
  }

  /// Whether a picture errs by no more than was asked. The reference errs by its noise alone, which it knows.
  bool measure(ErrorSearch& search, const Picture& picture, const PictureCost& cost,
               ErrorReport& report) const {
    if (report.pick.setting.method == kReferenceMethod) {
      report.measured.relativeRmse = report.measured.low = report.measured.high = cost.relativeError;
      std::cerr << "error: the reference's noise is " << kPercent * cost.relativeError << "% relative RMSE\n";
      return true;
    }
    const ErrorSearch::Verdict verdict = search.measure(picture, options_.error);
    report.measured = verdict.error;
    std::cerr << "error: measured " << kPercent * report.measured.relativeRmse << "% relative RMSE ("
              << kPercent * report.measured.low << "% to " << kPercent * report.measured.high
              << "%) on one pixel in " << search.stride() * search.stride() << '\n';
    return verdict.kept;
  }

  const RenderOptions& options_;
  const MethodRow& row_;
  Scene scene_;
  std::optional<ViewedScene> view_;
  std::optional<double> exposureEv_;
  std::unique_ptr<Method> method_;
  std::unique_ptr<Method> truth_;  // where --error chooses
  RenderTotals totals_;
};

/// A scene file, or the preset of that name where there is no such file.
Scene sceneNamed(const std::string& name) {
  const bool preset = name.find_first_of("./\\") == std::string::npos && !std::filesystem::exists(name);
  if (!preset) return loadScene(name);
  Scene scene = defaultScene();
  applyPreset(findPreset(name), scene);
  return scene;
}

}  // namespace

Scene openScene(const std::string& path, std::optional<double> stepVoxels) {
  Scene scene = path.empty() ? defaultScene() : sceneNamed(path);
  if (stepVoxels) {
    scene.march.stepVoxels = *stepVoxels;
    scene.march.stepPixels = 0.0;  // as long as was asked for, whatever voxels cover
  }
  return scene;
}

BrickVolume openVolume(const std::string& path, const std::string& grid) {
  BrickVolume bricks = loadBricks(path, grid);
  for (const std::string& note : bricks.notes) std::cerr << path << ": " << note << '\n';
  return bricks;
}

std::string framePath(const std::string& pattern, int frame) {
  if (std::string path = replaceHashes(pattern, frame); !path.empty()) return path;
  const std::filesystem::path path(pattern);
  const std::string stem = path.stem().string();
  size_t first = stem.size();
  while (first > 0 && stem[first - 1] >= '0' && stem[first - 1] <= '9') --first;
  if (first == stem.size())
    throw InputError({pattern},
                     "--frames needs a file name with a frame number, as in name_0001.vdb or name_####.vdb");
  const std::string name =
      stem.substr(0, first) + padded(frame, stem.size() - first) + path.extension().string();
  return (path.parent_path() / name).string();
}

std::string frameOutput(const std::string& pattern, int frame) {
  if (std::string path = replaceHashes(pattern, frame); !path.empty()) return path;
  constexpr size_t kDigits = 4;
  const std::filesystem::path path(pattern);
  const std::string name = path.stem().string() + "_" + padded(frame, kDigits) + path.extension().string();
  return (path.parent_path() / name).string();
}

void writePicture(const std::string& path, Picture picture, const ViewedScene& view, double exposureEv,
                  bool aov) {
  if (hasExtension(path, ".png")) {
    if (behindOf(view.scene) == Behind::sky) addSky(picture, view);
    writePng(path, picture, static_cast<float>(exposureEv), backdropOf(view.scene, exposureEv));
    return;
  }
  if (!aov) {
    picture.names.resize(kColourPlanes);
    picture.planes.resize(kColourPlanes);
  }
  writeExr(path, picture);
}

double chooseExposure(const Picture& picture) {
  constexpr float kMostlyMedium = 0.5f;
  constexpr double kBrightShare = 0.95, kShownAt = 0.88, kMostEv = 16.0;
  std::vector<double> radiances;
  for (size_t i = 0; i < picture.planes[3].size(); ++i) {
    const double alpha = double{picture.planes[3][i]};
    if (alpha > double{kMostlyMedium})
      radiances.push_back(
          (double{picture.planes[0][i]} + double{picture.planes[1][i]} + double{picture.planes[2][i]}) /
          (3.0 * alpha));
  }
  if (radiances.empty()) return 0.0;
  const auto bright =
      radiances.begin() + static_cast<std::ptrdiff_t>(kBrightShare * static_cast<double>(radiances.size()));
  std::nth_element(radiances.begin(), bright, radiances.end());
  if (!(*bright > 0.0)) return 0.0;
  return std::clamp(std::log2(-std::log(1.0 - kShownAt) / *bright), -kMostEv, kMostEv);
}

double exposureFor(const RenderOptions& options, const Picture& picture) {
  if (options.exposureEv) return *options.exposureEv;
  if (!options.scene.empty()) return 0.0;
  const double exposureEv = chooseExposure(picture);
  std::cerr << "exposure: auto, " << exposureEv << " EV\n";
  return exposureEv;
}

namespace {

/// Renders all frames. One that cannot be read is told of, and the others are rendered all the same. Returns
/// how many there were of those.
int renderFrames(const RenderOptions& options, Sequence& sequence) {
  const auto [first, last] = *options.frames;
  framePath(options.file, first);  // a name without a number is wrong for all
  int bad = 0;
  for (int frame = first; frame <= last; ++frame) {
    try {
      sequence.frame(framePath(options.file, frame), frameOutput(options.out, frame));
    } catch (const InputError& error) {
      ++bad;
      std::cerr << error.what() << '\n';
    }
  }
  if (bad > 0) std::cerr << bad << " of " << last - first + 1 << " frames could not be rendered\n";
  return bad;
}

}  // namespace

int renderCommand(const RenderOptions& options) {
  checkOptions(options);
  requireWritable(options.out);
  if (!options.stats.empty()) requireWritable(options.stats);
  const std::string folder = std::filesystem::path(options.out).parent_path().string();
  removeLeftovers(folder.empty() ? "." : folder);
  Sequence sequence(options);
  int bad = 0;
  if (options.frames)
    bad = renderFrames(options, sequence);
  else
    sequence.frame(options.file, options.out);
  sequence.finish();
  return bad > 0 ? kExitInput : kExitDone;
}

int compareCommand(const std::string& picture, const std::string& reference, std::optional<double> tolerance,
                   bool json) {
  const Comparison comparison = comparePictures(readExr(picture), picture, readExr(reference), reference);
  std::cout << (json ? comparisonAsJson(comparison) : comparisonAsText(comparison)) << std::flush;
  return tolerance && !(comparison.relativeRmse <= *tolerance) ? kExitNo : kExitDone;
}

}  // namespace nephele
