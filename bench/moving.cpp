// nephele_moving FILE.vdb SCENE.yaml [--rest N]: the viewer as the window has it, without a window, in 640 ×
// 360: its error at half the window's sides against its own picture at rest, from five sides, the times of
// one orbit's frames, and how near a picture is 3 s after the last input to that of N samples (1024). Times
// are the machine's at that moment; compare them within one run.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <iostream>
#include <limits>

#include "base/enlarge.h"
#include "base/error.h"
#include "preview/app/orbit_camera.h"
#include "preview/app/viewer.h"
#include "preview/gpu/camera_rays.h"
#include "preview/gpu/egl_context.h"
#include "preview/gpu/moving.h"
#include "preview/gpu/seen_volume.h"
#include "preview/gpu/sharpen.h"
#include "preview/measure/compare.h"
#include "preview/resolve.h"

namespace nephele {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kWidth = 640, kHeight = 360, kFrames = 60;
constexpr double kRestSeconds = 3.0;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double processorSeconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  constexpr double kMicro = 1e-6;
  return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         kMicro * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

class Bench {
 public:
  Bench(const std::string& file, const std::string& sceneFile)
      : bricks_(std::make_shared<BrickVolume>(loadBricks(file))) {
    std::string sentence;
    constexpr double kAspect = static_cast<double>(kWidth) / kHeight;
    view_ = resolveScene(loadScene(sceneFile), *bricks_, kAspect, sentence);
    viewer_.emplace(Filter::hardware, 0u);
    viewer_->setVolume(bricks_);
    screen_ = makeTexture(GL_TEXTURE_2D);
    glTextureStorage2D(screen_.name(), 1, GL_RGBA8, kWidth, kHeight);
    framebuffer_ = makeFramebuffer();
    glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, screen_.name(), 0);
  }

  /// Times of one orbit, at whatever size the machine's load lets the picture keep.
  void orbit() {
    OrbitCamera camera(view_.camera);
    std::vector<double> milliseconds;
    double showing = 1e9;
    for (int frame = 0; frame < kFrames; ++frame) {
      camera.orbit(glm::two_pi<double>() / kFrames, 0.0);
      view_.camera = camera.camera();
      const auto start = Clock::now();
      restart();
      viewer_->work(0.0);
      const double drawn = 1e3 * secondsSince(start);
      viewer_->show({framebuffer_.name(), kWidth, kHeight, 0.0}, {Shown{view_.scene, 0.0}, Shown{}});
      finishGl("showing");
      milliseconds.push_back(1e3 * secondsSince(start));
      showing = std::min(showing, milliseconds.back() - drawn);
    }
    const Picture last = viewer_->read();
    std::sort(milliseconds.begin(), milliseconds.end());
    std::printf(
        "moving: median %.1f ms, least %.1f, 95th of 100 %.1f; showing alone at least %.1f; %dx%d at last\n",
        milliseconds[kFrames / 2], milliseconds.front(), milliseconds[kFrames * 95 / 100], showing,
        last.width, last.height);
  }

  /// The moving picture at half the window's sides, whatever the machine's load: time and error, seen from
  /// all around.
  void half() {
    OrbitCamera camera(view_.camera);
    double worst = 0.0;
    constexpr int kSides = 5;
    for (int side = 0; side < kSides; ++side) {
      view_.camera = camera.camera();
      worst = std::max(worst, halfFromHere());
      camera.orbit(glm::two_pi<double>() / kSides, 0.0);
    }
    view_.camera = camera.camera();
    std::printf("worst relative RMSE %.4f\n", worst);
  }

  void settle(unsigned samples) {
    view_.camera.position += glm::dvec3(1e-4);
    restart();
    const auto start = Clock::now();
    rest(std::numeric_limits<unsigned>::max(), kRestSeconds);
    const double seconds = secondsSince(start);
    const Picture soon = viewer_->read();
    const LaneStats stats = viewer_->stats(Side::edited);
    rest(samples, std::numeric_limits<double>::infinity());
    const double error = comparePictures(soon, "soon", viewer_->read(), "rest").relativeRmse;
    std::printf(
        "at rest: %u samples in %.2f s, %.1f ms each, %.1f densities a pixel; relative RMSE %.4f to %u "
        "samples\n",
        stats.samples, seconds, stats.sampleMilliseconds, stats.densitySamplesPerPixel, error,
        viewer_->stats(Side::edited).samples);
    std::printf("GPU bytes in all %.2f MB\n", static_cast<double>(viewer_->gpuBytes()) * 1e-6);
  }

 private:
  static constexpr unsigned kCompareSamples = 48;

  double halfFromHere() {
    ViewedScene coarse = view_;
    coarse.scene.march = movingMarch(coarse.scene.march, 0.5);
    MarchPass pass(Filter::hardware);
    const BrickAtlas atlas(*bricks_, Filter::hardware, texelFor(coarse.scene.march.precision, *bricks_));
    constexpr int kHalfWidth = kWidth / 2, kHalfHeight = kHeight / 2, kTries = 12;
    Film film(kHalfWidth, kHalfHeight), shown(kHalfWidth, kHalfHeight);
    const SharpenPass sharpen;
    pass.setEnvironment(view_.environmentMap);
    pass.setParameters(marchParameters(coarse, *bricks_, kHalfWidth, kHalfHeight, 0, true));
    pass.prepare(atlas, std::numeric_limits<double>::infinity());
    double wall = 1e9, processor = 1e9;
    for (int i = 0; i < kTries; ++i) {
      film.clear();
      shown.clear();
      const auto start = Clock::now();
      const double before = processorSeconds();
      pass.draw(atlas, film, glm::vec2(0.5f, 0.5f), 0, {0, 0, kHalfWidth, kHalfHeight});
      sharpen.draw(film, shown);
      finishGl("marching");
      wall = std::min(wall, secondsSince(start));
      processor = std::min(processor, processorSeconds() - before);
    }
    const FilmPicture quick = shown.read();
    restart();
    rest(kCompareSamples, std::numeric_limits<double>::infinity());
    const double error =
        comparePictures(enlarged(quick.picture, kWidth, kHeight), "moving", viewer_->read(), "rest")
            .relativeRmse;
    std::printf(
        "%dx%d: least of %d: %.1f ms, %.1f ms of the processor; %.1f densities a pixel; relative RMSE %.4f\n",
        kHalfWidth, kHalfHeight, kTries, 1e3 * wall, 1e3 * processor,
        quick.densitySamples / (kHalfWidth * kHalfHeight), error);
    return error;
  }

  void restart() { viewer_->restart(Side::edited, {view_, View::radiance, {}, kWidth, kHeight}); }

  void rest(unsigned samples, double seconds) {
    constexpr double kNoTolerance = 1e-9;
    viewer_->setGoal({kNoTolerance, samples});
    const auto start = Clock::now();
    constexpr double kSlice = 0.1;
    while (secondsSince(start) < seconds && viewer_->stats(Side::edited).samples < samples)
      viewer_->work(std::min(kSlice, seconds - secondsSince(start)));
  }

  EglContext context_;
  std::shared_ptr<const BrickVolume> bricks_;
  ViewedScene view_;
  std::optional<Viewer> viewer_;
  GlTexture screen_;
  GlFramebuffer framebuffer_;
};

}  // namespace
}  // namespace nephele

int main(int argc, char** argv) {
  return nephele::runGuarded([&] {
    if (argc != 3 && !(argc == 5 && std::strcmp(argv[3], "--rest") == 0))
      throw nephele::InputError({}, "usage: nephele_moving FILE.vdb SCENE.yaml [--rest N]");
    constexpr unsigned kRestSamples = 1024;
    nephele::Bench bench(argv[1], argv[2]);
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    bench.half();
    bench.orbit();
    bench.settle(argc == 5 ? static_cast<unsigned>(std::stoul(argv[4])) : kRestSamples);
    return 0;
  });
}
