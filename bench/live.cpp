// nephele_live [--particles N] [--edge N] [--radius VOXELS] [--size WxH]: live particles without a window,
// each frame moved, rebuilt and marched as the window does while they play; milliseconds of each stage,
// waiting for the GPU between stages, then of whole frames without that. Times are the machine's at that
// moment; compare them within one run.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>

#include "base/error.h"
#include "preview/app/viewer.h"
#include "preview/gpu/camera_rays.h"
#include "preview/gpu/egl_context.h"
#include "preview/gpu/live_grid.h"
#include "preview/gpu/moving.h"
#include "preview/render_command.h"
#include "preview/resolve.h"

namespace nephele {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  int particles = 100'000, edge = 64, width = 480, height = 270;
  double radius = 1.5;
};

constexpr int kFrames = 48;

double millisecondsSince(Clock::time_point start) {
  return 1e3 * std::chrono::duration<double>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// A ball of particles that eddies carry about, all of them alive all the time.
ParticleSystem systemOf(const Options& options, double voxelSize) {
  ParticleSystem system;
  Emitter emitter;
  emitter.radius = 0.8;
  emitter.bursts = {{0.0, static_cast<double>(options.particles)}};
  emitter.particleRadius = options.radius * voxelSize;
  emitter.density = 3.0;
  emitter.life = 1e6;
  system.emitters = {emitter};
  system.forces.drag = 1.0;
  system.forces.curlSpeed = 0.4;
  system.forces.curlCellSize = 0.5;
  system.forces.curlOctaves = 2;
  system.forces.vortices = {{{0, 0, 0}, {0, 0, 1}, 1.0, 1.0}};
  return system;
}

class Bench {
 public:
  explicit Bench(const Options& options)
      : options_(options),
        box_(liveBox({glm::dvec3(-1.0), glm::dvec3(1.0)}, options.edge)),
        motion_(systemOf(options, box_.voxelSize), SimulationSettings{}),
        viewer_(Filter::hardware, 0) {
    mostMass_ = mostMass(motion_.system(), motion_.rings());
    BrickVolume like;
    like.maximum = like.meanActive = 1.0;
    auto volume = std::make_shared<BrickVolume>(liveVolume(box_, like));
    Scene scene = openScene({}, {});
    scene.medium = Medium{};
    scene.medium->sigmaS = Rgb{8.0, 8.0, 8.0};
    std::string sentence;
    view_ = resolveScene(scene, *volume, static_cast<double>(options.width) / options.height, sentence);
    std::cerr << describeLight(view_) << '\n';
    viewer_.setLiveVolume(volume);
    screen_ = makeTexture(GL_TEXTURE_2D);
    glTextureStorage2D(screen_.name(), 1, GL_RGBA8, options.width, options.height);
    framebuffer_ = makeFramebuffer();
    glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, screen_.name(), 0);
  }

  void stages() {
    std::vector<double> move, rebuild, picture;
    for (int frame = 0; frame < kFrames; ++frame) {
      move.push_back(timed([&] { step(); }));
      rebuild.push_back(timed([&] { motionToGrid(); }));
      picture.push_back(timed([&] { draw(); }));
    }
    std::printf("%d particles of radius %.2g voxels, %d^3 voxels, %dx%d: median ms a frame\n",
                options_.particles, options_.radius, options_.edge, options_.width, options_.height);
    std::printf("  move (%d steps) %.1f   rebuild %.1f   picture %.1f\n", int(motion_.system().substeps),
                median(move), median(rebuild), median(picture));
  }

  /// The same with a moving picture of every pixel, where the window takes fewer when they take too long.
  void wholePictures() {
    MarchPass pass(Filter::hardware);
    Film film(options_.width, options_.height);
    ViewedScene moving = view_;
    moving.scene.march = movingMarch(moving.scene.march, 1.0);
    pass.setEnvironment(view_.environmentMap);
    std::vector<double> all, picture;
    for (int frame = 0; frame < kFrames; ++frame)
      all.push_back(timed([&] {
        step();
        motionToGrid();
        picture.push_back(timed([&] {
          film.clear();
          pass.setParameters(
              marchParameters(moving, viewer_.volume(), options_.width, options_.height, 0, true));
          pass.prepare(*viewer_.liveAtlas(), kMovingCacheSeconds);
          pass.draw(*viewer_.liveAtlas(), film, {0.5f, 0.5f}, 0, {0, 0, options_.width, options_.height});
        }));
      }));
    std::printf(
        "  with every pixel of %dx%d: median %.1f ms (picture %.1f), worst %.1f: %.1f frames a second\n",
        options_.width, options_.height, median(all), median(picture),
        *std::max_element(all.begin(), all.end()), 1e3 / median(all));
  }

  void frames() {
    std::vector<double> all;
    for (int frame = 0; frame < kFrames; ++frame)
      all.push_back(timed([&] {
        step();
        motionToGrid();
        draw();
      }));
    const Picture seen = viewer_.read();
    std::printf(
        "  whole frames: median %.1f ms, worst %.1f: %.1f frames a second; the moving picture is %dx%d\n",
        median(all), *std::max_element(all.begin(), all.end()), 1e3 / median(all), seen.width, seen.height);
    std::printf("  %u alive, %.2f MB on the GPU beside the picture's %.2f\n", motion_.status().alive,
                static_cast<double>(motion_.gpuBytes() + grid_.gpuBytes()) * 1e-6,
                static_cast<double>(viewer_.gpuBytes()) * 1e-6);
  }

 private:
  template <class Body>
  static double timed(const Body& body) {
    const auto start = Clock::now();
    body();
    finishGl("a stage of live particles");
    return millisecondsSince(start);
  }

  void step() {
    for (int64_t n = 0; n < motion_.system().substeps; ++n) motion_.step();
  }
  void motionToGrid() { grid_.rebuild(motion_, box_, mostMass_, *viewer_.liveAtlas()); }
  void draw() {
    viewer_.restart(Side::edited, {view_, View::radiance, {}, options_.width, options_.height});
    viewer_.work(0.0);
    viewer_.show({framebuffer_.name(), options_.width, options_.height, 0.0},
                 {Shown{view_.scene, 0.0}, Shown{}});
  }

  EglContext context_;  // first, so that it goes last
  Options options_;
  LiveBox box_;
  LiveMotion motion_;
  LiveGrid grid_;
  Viewer viewer_;
  double mostMass_ = 0.0;
  ViewedScene view_;
  GlTexture screen_;
  GlFramebuffer framebuffer_;
};

Options optionsOf(int argc, char** argv) {
  Options options;
  for (int n = 1; n + 1 < argc; n += 2) {
    const std::string name = argv[n], value = argv[n + 1];
    if (name == "--particles")
      options.particles = std::stoi(value);
    else if (name == "--edge")
      options.edge = std::stoi(value);
    else if (name == "--radius")
      options.radius = std::stod(value);
    else if (name == "--size" && value.find('x') != std::string::npos)
      options.width = std::stoi(value), options.height = std::stoi(value.substr(value.find('x') + 1));
    else
      throw InputError({}, "usage: nephele_live [--particles N] [--edge N] [--radius VOXELS] [--size WxH]");
  }
  return options;
}

}  // namespace
}  // namespace nephele

int main(int argc, char** argv) {
  return nephele::runGuarded([&] {
    nephele::Bench bench(nephele::optionsOf(argc, argv));
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    bench.stages();
    bench.frames();
    bench.wholePictures();
    return 0;
  });
}
