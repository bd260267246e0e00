// The brick arrays as the march's source of densities, read with explicit mixes in the order of the exact GPU
// filter. Depends on shaders/shared, the brick arrays and TBB.
#include "preview/twin/march_picture.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace nephele {
namespace {

using namespace shared;

struct ArrayBricks {
  const BrickVolume* volume;

  uint slot(ivec3 brick) const {
    const ivec3 count = volume->brickCount;
    const size_t row =
        static_cast<size_t>(brick.z) * static_cast<size_t>(count.y) + static_cast<size_t>(brick.y);
    return volume->index[row * static_cast<size_t>(count.x) + static_cast<size_t>(brick.x)];
  }

  float density(uint slotPlusOne, vec3 position) const {
    // A position a hair below 0 rounds to the far face of the brick before: hence the upper bound.
    const ivec3 cell = min(ivec3(floor(position)), ivec3(kBrickCells - 1));
    const vec3 f = position - vec3(cell);
    const size_t first = static_cast<size_t>((cell.z * kBrickSamples + cell.y) * kBrickSamples + cell.x);
    const float* s = volume->samples.data() + (slotPlusOne - 1) * static_cast<size_t>(kBrickVolume) + first;
    constexpr int dy = kBrickSamples;
    constexpr int dz = kBrickSamples * kBrickSamples;
    const float y0 = mix(mix(s[0], s[1], f.x), mix(s[dy], s[dy + 1], f.x), f.y);
    const float y1 = mix(mix(s[dz], s[dz + 1], f.x), mix(s[dz + dy], s[dz + dy + 1], f.x), f.y);
    return mix(y0, y1, f.z);
  }
};

}  // namespace

std::vector<TwinPixel> marchPicture(const BrickVolume& bricks, const MarchParameters& parameters, int width,
                                    int height, glm::vec2 subPixel, unsigned number, const SkyArrays& sky) {
  std::vector<TwinPixel> pixels(static_cast<size_t>(width) * static_cast<size_t>(height));
  if (bricks.empty() && parameters.skyForward.w <= 0.0f) return pixels;
  const ArrayBricks source{&bricks};
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    March<ArrayBricks> march{parameters, &source, sky};
    for (int y = rows.begin(); y != rows.end(); ++y) {
      for (int x = 0; x < width; ++x) {
        const vec2 at = vec2(static_cast<float>(x), static_cast<float>(y)) + subPixel;
        const uint random = randomState(static_cast<uint>(x), static_cast<uint>(y), number,
                                        static_cast<uint>(parameters.brickCount.w));
        const auto result = march.marchRay(at, random, number);
        TwinPixel& pixel =
            pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
        pixel = {result.radiance + march.environmentBehind(at, result.opticalDepth),
                 exp(-result.opticalDepth), result.depth, result.depthWeight, result.cost.x};
      }
    }
  });
  return pixels;
}

}  // namespace nephele
