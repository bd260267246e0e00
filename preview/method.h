// A method finds radiance along rays: one interface, and one table row for each method that the project
// knows. Depends on scene and volume/bricks.h; knows no GL. Charts and commands reach methods through this
// alone.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/picture.h"
#include "preview/filter.h"
#include "preview/viewed_scene.h"
#include "volume/bricks.h"

namespace nephele {

/// What is fixed while a method lives.
struct MethodOptions {
  Filter filter = Filter::hardware;
  uint64_t vramBytes = 0;  // of GPU memory at most; 0: as much as there is
};

/// One picture to make.
struct PictureRequest {
  int width = 960;
  int height = 540;
  unsigned samples = 4;  // a pixel
  unsigned seed = 0;
  bool quiet = false;  // no progress bar
  /// Only every stride-th pixel of the picture, from the one at stride/2 on, along each axis: the result has
  /// strided(width, stride) × strided(height, stride) of them, each as wide as in the whole picture. From 1
  /// to the shorter edge.
  int stride = 1;
  // The rest is for methods that know truth (`reference`).
  std::optional<int> bounces{};  // scatterings after the first; none: all
  double error = 0.0;            // above 0: samples until the picture's noise is at most this relative RMSE
  unsigned mostSamples = 0;      // towards that error, a pixel; 0: without bound
};

/// Pixels that a stride leaves of `length`.
constexpr int strided(int length, int stride) { return (length - stride / 2 + stride - 1) / stride; }

/// What a picture cost.
struct PictureCost {
  double milliseconds = 0.0;            // from the first draw to the last pixel read back
  double millisecondsPreparing = 0.0;   // of these, what does not grow with pixels and samples
  double millisecondsUpload = 0.0;      // of these, bricks to the GPU
  double densitySamplesPerPixel = 0.0;  // densities read for the whole picture / pixels
  double densitiesPreparing = 0.0;      // of these, all in all, read whatever the pixels and samples
  uint64_t gpuBytes = 0;                // bricks, index, light cache, picture, parameters
  uint64_t volumeBytes = 0;             // the same without the picture
  std::string texel;                    // of the atlas: "r8", "r16f", "r32f"; empty where there is none
  std::vector<size_t> bricksOfLevel;    // bricks with density read from each level, finest first
  double voxelPixels = 0.0;             // that voxels were allowed to cover when levels were chosen
  double skipsChecked = 0.0;            // densities that march: { check_skips } read besides
  double skipsWrong = 0.0;              // of those, where a skip or a bound was wrong
  double relativeError = 0.0;           // the picture's own noise as relative RMSE, where the method knows it
  double pathsPerPixel = 0.0;           // that truth was sampled by
};

/// One way to find radiance. Used from the thread that made it.
class Method {
 public:
  virtual ~Method() = default;
  /// Takes a volume in; must be called before render, and may be called again for another frame of a
  /// sequence.
  virtual void setVolume(const BrickVolume& bricks) = 0;
  /// Renders linear radiance and alpha, premultiplied, with planes R, G, B, A, transmittance.R, .G, .B,
  /// depth; a method may add further planes behind. An empty volume gives a picture without medium. Throws
  /// InputError for settings that cannot be rendered, else WorldError.
  virtual Picture render(const ViewedScene& view, const PictureRequest& request, PictureCost& cost) = 0;

  /// Who computed: GL_RENDERER, and the seconds that starting the driver and building the shaders took.
  std::string renderer;
  double secondsDriver = 0.0;
  double secondsShaders = 0.0;
};

struct MethodRow {
  std::string_view name;
  std::string_view sentence;
  std::unique_ptr<Method> (*make)(const MethodOptions&);  // nullptr: known, not built yet
};

/// Every method of MODEL.md, section 2, in its order.
std::span<const MethodRow> methods();

/// The row of that name. Throws InputError where it is unknown ("did you mean") or not built yet.
const MethodRow& findMethod(const std::string& name);

}  // namespace nephele
