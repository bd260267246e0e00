// nephele_densities FILE.vdb SCENE.yaml [--truth N]: densities read a pixel by the march as the scene has it,
// those of its light cache among them, against fixed steps with marched shadows, at 1 and 4 samples a pixel.
// Counts, no clock: the same on every machine. Fixed steps are counted twice: as a march that skips nothing
// reads them, and without those that lie in empty bricks. Depends on preview.
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "base/error.h"
#include "preview/measure/compare.h"
#include "preview/method.h"
#include "preview/resolve.h"

namespace nephele {
namespace {

constexpr int kWidth = 320, kHeight = 180;
constexpr double kPercent = 100.0;

/// Steps of one length, the scene's, along the view and towards lights, each lit; nothing from a cache or a
/// coarser level. What is empty is skipped all the same.
MarchSettings fixedSteps(MarchSettings march) {
  march.adaptive = false;
  march.shadowGrowth = 1.0;
  march.lightCache = false;
  march.levelPixels = march.stepPixels = 0.0;
  return march;
}

class Bench {
 public:
  Bench(const std::string& file, unsigned truthSamples)
      : bricks_(loadBricks(file)), method_(findMethod("march").make({})), truthSamples_(truthSamples) {
    method_->setVolume(bricks_);
  }

  void compare(const char* title, const Scene& scene) {
    std::string sentence;
    const ViewedScene asked = resolveScene(scene, bricks_, static_cast<double>(kWidth) / kHeight, sentence);
    ViewedScene fixed = asked, fine = asked;
    fixed.scene.march = fine.scene.march = fixedSteps(asked.scene.march);
    // Right on the mean with fewer steps lit: drivers end loops as long as those that light each.
    fine.scene.march.adaptive = true;
    fine.scene.march.stepVoxels *= 0.5;
    fine.scene.march.shadowStepVoxels *= 0.5;
    constexpr double kTruthGrowth = 1.02;  // these too
    fine.scene.march.shadowGrowth = kTruthGrowth;
    std::printf("%s, truth by half the steps and %u samples a pixel\n", title, truthSamples_);
    PictureCost cost;
    constexpr unsigned kOtherSeed = 1;
    const Picture truth = render(fine, truthSamples_, kOtherSeed, cost);
    for (const unsigned samples : {1u, 4u}) {
      const double read = row("fixed", fixed, samples, truth);
      const double ours = row("ours", asked, samples, truth);
      const double all = read + skippedBy(fixed, samples);
      std::printf(
          "  %.1f times fewer than the %.1f of fixed steps; %.1f times without those in empty bricks\n",
          all / ours, all, read / ours);
    }
  }

 private:
  Picture render(const ViewedScene& view, unsigned samples, unsigned seed, PictureCost& cost) {
    PictureRequest request;
    request.width = kWidth;
    request.height = kHeight;
    request.samples = samples;
    request.seed = seed;
    request.quiet = true;
    return method_->render(view, request, cost);
  }

  /// Densities a pixel that fixed steps would have read in what was skipped, along the view and towards
  /// lights. The check counts those, and the view's own once more: as many as without light.
  double skippedBy(const ViewedScene& fixed, unsigned samples) {
    ViewedScene checked = fixed, dark = fixed;
    checked.scene.march.checkSkips = true;
    dark.scene.lights.clear();
    dark.scene.environment = {};
    PictureCost cost, ofTheView;
    render(checked, samples, 0, cost);
    render(dark, samples, 0, ofTheView);
    return cost.skipsChecked / (kWidth * kHeight) - ofTheView.densitySamplesPerPixel;
  }

  /// Densities read a pixel.
  double row(const char* name, const ViewedScene& view, unsigned samples, const Picture& truth) {
    PictureCost cost;
    const Picture picture = render(view, samples, 0, cost);
    const Comparison error = comparePictures(picture, name, truth, "truth");
    std::printf(
        "%u a pixel, %-5s %9.1f densities a pixel (%.1f for the light cache), error %.2f%%, bias %+.2f%%\n",
        samples, name, cost.densitySamplesPerPixel, cost.densitiesPreparing / (kWidth * kHeight),
        kPercent * error.relativeRmse, kPercent * error.bias);
    return cost.densitySamplesPerPixel;
  }

  BrickVolume bricks_;
  std::unique_ptr<Method> method_;
  unsigned truthSamples_;
};

}  // namespace
}  // namespace nephele

int main(int argc, char** argv) {
  return nephele::runGuarded([&] {
    if (argc != 3 && !(argc == 5 && std::strcmp(argv[3], "--truth") == 0))
      throw nephele::InputError({}, "usage: nephele_densities FILE.vdb SCENE.yaml [--truth N]");
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    constexpr unsigned kTruthSamples = 64;
    nephele::Bench bench(argv[1], argc == 5 ? static_cast<unsigned>(std::stoul(argv[4])) : kTruthSamples);
    const nephele::Scene scene = nephele::loadScene(argv[2]);
    bench.compare("as the scene says", scene);
    nephele::Scene suns = scene;
    suns.environment = {};
    bench.compare("under its suns alone", suns);
    return 0;
  });
}
