// Files, settings and pictures of the desk. Depends on all of preview, volume and nlohmann_json.
#include "preview/app/desk.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "preview/app/heap.h"
#include "preview/app/scene_file.h"
#include "preview/measure/trust.h"
#include "preview/resolve.h"
#include "preview/temperature.h"

namespace nephele {
namespace {

constexpr std::string_view kMethod = "march";  // that the window draws by
constexpr size_t kMostUndo = 200;
constexpr double kNoticeSeconds = 8.0;
constexpr double kFirstPictureSeconds = 0.03;

}  // namespace

FirstVolume openFirst(const RenderOptions& options) {
  FirstVolume first;
  first.scene = openScene(options.scene, options.stepVoxels);
  first.key = {options.file, options.grid, first.scene.emission.grid};
  first.stamp = stampOf(options.file);
  BrickVolume volume = openVolume(options.file, options.grid);
  Emission emission = first.scene.emission;
  if (emission.on == Switch(false)) emission.on.reset();  // the panel may switch it on
  addTemperature(volume, emission);
  first.volume = std::make_shared<const BrickVolume>(std::move(volume));
  return first;
}

Desk::Desk(const AppOptions& options, const FirstVolume& first, Window& window, ReadAhead& reader)
    : options_(options),
      window_(window),
      firstScene_(first.scene),
      document_(first.key, first.volume, first.stamp, reader),
      viewer_(options.render.filter, options.render.seed, options.render.vramBytes),
      history_(kMostUndo),
      orbit_(Camera{}) {
  state_.settings.scene = first.scene;
  viewer_.setVolume(first.volume);
}

void Desk::begin() {
  adopt(true);
  if (width_ > 0 && height_ > 0 && work(kFirstPictureSeconds))
    state_.settings.exposureEv = exposureFor(options_.render, viewer_.read());
  writeStats();
}

void Desk::adopt(bool otherFile) {
  const BrickVolume& volume = document_.volume();
  window_.setTitle("Nephele: " + std::filesystem::path(volume.path).filename().string());
  brickFacts_ = brickFactsOf(volume);
  if (otherFile) {
    Scene scene = state_.settings.scene;
    scene.camera = firstScene_.camera;
    scene.cameraUpGiven = firstScene_.cameraUpGiven;
    scene.medium = firstScene_.medium;
    if (!scene.octaves.factorsGiven) {  // they may be another file's
      const std::optional<int> count = scene.octaves.count;
      scene.octaves = firstScene_.octaves;
      scene.octaves.count = count == fittedCount_ ? std::nullopt : count;
    }
    std::string sentence;
    const ViewedScene view = resolveScene(scene, volume, aspect(), sentence);
    say(sentence);
    std::cerr << describeLight(view) << '\n';
    fittedCount_ = scene.octaves.count ? std::nullopt : view.scene.octaves.count;
    state_.settings.scene = view.scene;
    state_.settings.medium = view.medium;
    state_.settings.environmentMap = view.environmentMap;
    state_.up = view.up;
    state_.sceneFile = sceneFileFor(options_.folder, volume.path);
    state_.kept.reset();
    viewer_.endSplit();
    liveSource_ = liveSourceOf(volume);
    state_.settings.particles.reset();
    if (liveSource_) state_.settings.particles = liveSource_->system;
    history_ = History<Settings>(kMostUndo);
    firstCamera_ = view.camera;
    orbit_ = OrbitCamera(firstCamera_);
  }
  restart();
}

void Desk::exposeOther() {
  const bool chosen = options_.render.scene.empty() && !options_.render.exposureEv;
  if (!chosen || width_ < 1 || height_ < 1 || state_.view != View::radiance) return;
  if (work(kFirstPictureSeconds)) state_.settings.exposureEv = chooseExposure(viewer_.read());
}

double Desk::aspect() const {
  int width = 0, height = 0;
  window_.framebufferSize(width, height);
  return width > 0 && height > 0 ? static_cast<double>(width) / height : 1.0;
}

LaneRequest Desk::request(const Settings& settings) const {
  return {{settings.scene, orbit_.camera(), settings.medium, state_.up, settings.environmentMap},
          state_.view,
          state_.slice,
          width_,
          height_};
}

void Desk::restart() {
  window_.framebufferSize(width_, height_);
  ++restarts_;
  const bool known = std::exchange(statsKnown_, false);
  if (document_.heat() != state_.settings.scene.emission.grid)
    document_.chooseHeat(state_.settings.scene.emission.grid);
  if (width_ < 1 || height_ < 1) return;
  followLive();
  followSun(state_.settings.scene, state_.settings.medium, document_.volume(), state_.up);
  viewer_.setGoal(state_.goal);
  viewer_.restart(Side::edited, request(state_.settings));
  if (state_.kept) viewer_.restart(Side::kept, request(*state_.kept));
  if (known) writeStats();
}

std::array<Shown, kSideCount> Desk::shown() const {
  const Settings& kept = state_.kept.value_or(state_.settings);
  return {{{state_.settings.scene, state_.settings.exposureEv}, {kept.scene, kept.exposureEv}}};
}

Screen Desk::screen(int width, int height) const {
  return {0, width, height, state_.kept ? state_.divider : 0.0};
}

void Desk::show(int width, int height) {
  viewer_.show(screen(width, height), shown());
  if (viewer_.stats(Side::edited).samples > 0 || std::exchange(shownRestart_, restarts_) == restarts_) return;
  pace_.shown(std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count());
}

bool Desk::work(double seconds) {
  int width = 0, height = 0;
  window_.framebufferSize(width, height);
  if (width != width_ || height != height_) restart();
  bool more = false;
  try {
    more = viewer_.work(seconds);
  } catch (const InputError& error) {  // a setting or a size that cannot be drawn: the window goes on
    say(error.what());
  }
  const bool known = !more || viewer_.stats(Side::edited).noise > 0.0;
  if (known && !std::exchange(statsKnown_, known)) writeStats();
  return more;
}

void Desk::lookAtFiles() {
  document_.lookAtFiles();
  if (live_ && live_->playing()) writeStats();
}

bool Desk::advance(double seconds) {
  fly(seconds);
  const DocumentNews news = document_.advance(seconds);
  takeNews(news);
  const bool moving = advanceLive(seconds) || news.volume != nullptr || window_.flight().any();
  if (noticeSeconds_ > 0.0 && (noticeSeconds_ -= seconds) <= 0.0) {
    state_.notice.clear();
    return true;
  }
  return moving || !news.notice.empty();
}

void Desk::takeNews(const DocumentNews& news) {
  if (!news.volume) {
    if (!news.notice.empty()) say(news.notice);
    return;
  }
  live_.reset();
  try {
    viewer_.setVolume(news.volume);
  } catch (const std::exception& error) {  // too large for the GPU: the volume before stays
    say(error.what());
    return;
  }
  for (const std::string& note : news.volume->notes) std::cerr << note << '\n';
  std::string complaint;
  try {
    adopt(news.otherFile);
    if (news.otherFile) exposeOther();
  } catch (const InputError& error) {  // its metadata holds no medium: the one before stays
    complaint = error.what();
    firstCamera_ = framed(*news.volume, orbit_.camera().fov);
    orbit_ = OrbitCamera(firstCamera_);
    restart();
  }
  for (const std::string& sentence : {news.notice, complaint})
    if (!sentence.empty()) say(sentence);
  // While a sequence plays, its next frame takes the place of this one.
  if (!document_.timeline().playing()) returnFreeMemory();
  writeStats();
}

std::optional<double> Desk::due() const {
  std::optional<double> due = document_.timeline().due();
  if (const auto live = live_ ? live_->due() : std::nullopt) due = std::min(due.value_or(*live), *live);
  if (noticeSeconds_ > 0.0) due = std::min(due.value_or(noticeSeconds_), noticeSeconds_);
  return due;
}

void Desk::say(const std::string& notice) {
  state_.notice = notice;
  noticeSeconds_ = kNoticeSeconds;
  std::cerr << notice << '\n';
}

UiFacts Desk::facts() const {
  UiFacts facts{document_,
                viewer_.stats(Side::edited),
                viewer_.gpuBytes(),
                pace_.perSecond(),
                history_.undoSteps(),
                history_.redoSteps(),
                {},
                {}};
  facts.warnings = document_.volume().notes;
  if (!live_) {  // the map knows still volumes alone
    const ViewedScene view = request(state_.settings).view;
    for (std::string& warning :
         trustWarnings(kMethod, sceneFactsOf(brickFacts_, document_.volume(), view), view, trustTable()))
      facts.warnings.push_back(std::move(warning));
  }
  if (live_) {
    facts.live =
        LiveFacts{live_->playing(), live_->frame(), live_->alive(), leftOutLive(*state_.settings.particles)};
    facts.gpuBytes += live_->gpuBytes();
  }
  if (facts.stats.raysCutShort > 0.0)
    facts.warnings.push_back("the driver cut " + std::to_string(std::llround(facts.stats.raysCutShort)) +
                             " rays short and the picture is wrong: take longer steps");
  return facts;
}

void Desk::noteShown(uint64_t presses) {
  if (std::exchange(pressesShown_, presses) != presses) writeStats();
}

void Desk::writeStats() const {
  if (options_.render.stats.empty()) return;
  const GlCounts counts = glCounts();
  const LaneStats lane = viewer_.stats(Side::edited);
  const std::optional<Texel> texel = viewer_.texel();
  const nlohmann::ordered_json stats{{"pictures_begun", restarts_},
                                     {"presses_shown", pressesShown_},
                                     {"live_frame", live_ ? live_->frame() : 0},
                                     {"ms_per_frame", lane.sampleMilliseconds},
                                     {"samples", lane.samples},
                                     {"samples_per_pixel", lane.densitySamplesPerPixel},
                                     {"noise", lane.noise},
                                     {"noise_known", statsKnown_},
                                     {"gpu_bytes", viewer_.gpuBytes()},
                                     {"gpu_volume_bytes", viewer_.volumeBytes()},
                                     {"gpu_texel", texel ? nameOf(*texel) : ""},
                                     {"moving_frames", pace_.frames()},
                                     {"moving_per_second", pace_.perSecond()},
                                     {"moving_median_ms", 1e3 * pace_.medianSeconds()},
                                     {"moving_width", lane.quickWidth},
                                     {"moving_height", lane.quickHeight},
                                     {"gl_objects_made", counts.made},
                                     {"gl_objects_alive", counts.made - counts.destroyed},
                                     {"gl_renderer", glRenderer()}};
  writeText(options_.render.stats, stats.dump(2) + "\n");
}

}  // namespace nephele
