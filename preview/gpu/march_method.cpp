// Headless pictures by the march. Depends on preview/method.h, base and gpu.
#include "preview/gpu/march_method.h"

#include <chrono>
#include <cstdio>
#include <limits>
#include <optional>

#include "base/progress.h"
#include "preview/gpu/accumulator.h"
#include "preview/gpu/camera_rays.h"
#include "preview/gpu/egl_context.h"
#include "preview/gpu/seen_volume.h"

namespace nephele {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kProgressSeconds = 0.1;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Some drivers end a shader's loops without a word: llvmpipe after 65535 iterations a pixel.
void refuseCutRays(const FilmPicture& result) {
  if (result.raysCutShort == 0.0) return;
  char count[32];
  std::snprintf(count, sizeof count, "%.0f", result.raysCutShort);
  throw WorldError(std::string("the driver (") + glRenderer() + ") cut " + count +
                   " rays short, so the picture would be wrong; take longer steps (march: step, shadow_step, "
                   "shadow_growth)");
}

/// Rays through every stride-th pixel alone, from the one at stride/2 on.
void takeEvery(int stride, shared::MarchParameters& p) {
  const auto thin = [stride](glm::vec4& corner, glm::vec4& dx, glm::vec4& dy) {
    const float first = static_cast<float>(stride / 2), times = static_cast<float>(stride);
    corner += first * (dx + dy);
    dx *= times;
    dy *= times;
  };
  thin(p.originCorner, p.originDx, p.originDy);  // w of both steps is 0
  thin(p.directionCorner, p.directionDx, p.directionDy);
  thin(p.rayCorner, p.rayDx, p.rayDy);
}

class MarchMethod : public Method {
 public:
  MarchMethod(const MethodOptions& options, MarchKind kind) : kind_(kind) {
    const auto start = Clock::now();
    context_.emplace();
    secondsDriver = secondsSince(start);
    pass_.emplace(options.filter, std::vector<TextChange>{}, MarchWrites::radiance, kind);
    limits_.bytes = options.vramBytes;
    renderer = glRenderer();
  }

  // What goes with it is this context's.
  ~MarchMethod() override { context_->makeCurrent(); }

  void setVolume(const BrickVolume& bricks) override {
    useContext();
    volume_.reset();  // two volumes at once may be more than the GPU holds
    volume_.emplace(bricks, pass_->filter(), limits_);
    bricks_ = &bricks;
  }

  Picture render(const ViewedScene& view, const PictureRequest& request, PictureCost& cost) override {
    NEPHELE_CHECK_EQ(volume_.has_value(), true);
    useContext();
    auto start = Clock::now();
    const BrickAtlas& atlas = atlasFor(view, request);
    const int width = strided(request.width, request.stride),
              height = strided(request.height, request.stride);
    shared::MarchParameters parameters = marchParameters(view, *bricks_, atlas.layout().frame, request.width,
                                                         request.height, request.seed, true);
    takeEvery(request.stride, parameters);
    pass_->setParameters(parameters);
    pass_->setEnvironment(view.environmentMap);
    const double secondsUploading = secondsSince(start);
    cost.millisecondsUpload = secondsUploading * 1e3;
    secondsShaders += pass_->compile(atlas);
    start = Clock::now();
    const Film film(width, height);
    pass_->prepare(atlas, std::numeric_limits<double>::infinity());
    const double cacheDensities = pass_->takeCacheDensities();
    SkipCheck skips = pass_->takeSkipCheck();
    cost.millisecondsPreparing = (secondsUploading + secondsSince(start)) * 1e3;
    Accumulator accumulator(width, height, request.samples, request.seed,
                            1.0f / static_cast<float>(request.stride));
    {
      Progress progress("rendering", accumulator.pixelsTotal(), request.quiet);
      for (uint64_t before = 0; !accumulator.done();) {
        accumulator.advance(*pass_, atlas, film, kProgressSeconds);
        const SkipCheck piece = pass_->takeSkipCheck();  // before counts of 32 bits run over
        skips.checked += piece.checked;
        skips.wrong += piece.wrong;
        progress.advance(accumulator.pixelsDone() - before);
        before = accumulator.pixelsDone();
      }
    }
    FilmPicture result = film.read();
    refuseCutRays(result);
    cost.milliseconds = (secondsUploading + secondsSince(start)) * 1e3;
    cost.densitiesPreparing = cacheDensities;
    cost.densitySamplesPerPixel =
        (result.densitySamples + cacheDensities) / (static_cast<double>(width) * height);
    cost.gpuBytes = volume_->gpuBytes() + film.gpuBytes() + pass_->gpuBytes();
    cost.volumeBytes = volume_->gpuBytes() + pass_->gpuBytes();
    cost.bricksOfLevel.assign(atlas.layout().bricksOfLevel.begin(), atlas.layout().bricksOfLevel.end());
    while (!cost.bricksOfLevel.empty() && cost.bricksOfLevel.back() == 0) cost.bricksOfLevel.pop_back();
    cost.skipsChecked = skips.checked;
    cost.skipsWrong = skips.wrong;
    cost.voxelPixels = atlas.layout().pixels;
    cost.texel = std::string(nameOf(atlas.layout().texel));
    return std::move(result.picture);
  }

 private:
  /// Another method's context may be current.
  void useContext() const {
    if (!context_->makeCurrent()) throw WorldError("eglMakeCurrent failed without a surface");
  }

  /// Voxels are walked as they are stored, however small they are in the picture.
  const BrickAtlas& atlasFor(const ViewedScene& view, const PictureRequest& request) {
    ViewedScene seen = view;
    if (kind_ == MarchKind::dda) seen.scene.march.levelPixels = 0.0;
    const BrickAtlas& atlas = volume_->atlasFor(0, seen, request.width, request.height, false);
    const BrickLayout& layout = atlas.layout();
    if (kind_ == MarchKind::dda && (layout.frame.level > 0 || layout.mostRise > 0))
      throw InputError({},
                       "--method dda walks the finest voxels, and --vram leaves no memory for all of them");
    return atlas;
  }

  MarchKind kind_;
  std::optional<EglContext> context_;  // before what needs it, so that it goes after
  std::optional<MarchPass> pass_;
  GpuLimits limits_;
  std::optional<SeenVolume> volume_;
  const BrickVolume* bricks_ = nullptr;
};

}  // namespace

std::unique_ptr<Method> makeMarchMethod(const MethodOptions& options) {
  return std::make_unique<MarchMethod>(options, MarchKind::march);
}

std::unique_ptr<Method> makeCubeMethod(const MethodOptions& options) {
  return std::make_unique<MarchMethod>(options, MarchKind::cube);
}

std::unique_ptr<Method> makeDdaMethod(const MethodOptions& options) {
  return std::make_unique<MarchMethod>(options, MarchKind::dda);
}

}  // namespace nephele
