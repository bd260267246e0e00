// Whole pictures by the march compiled as C++: the CPU's half of the parity test. Depends on shaders/shared
// and on the brick arrays; links no GL.
#pragma once

#include <vector>

#include "preview/twin/march.h"
#include "volume/brick_layout.h"

namespace nephele {

/// One ray's result, as the GPU writes it before summing.
struct TwinPixel {
  glm::vec3 radiance{0.0f};
  glm::vec3 transmittance{1.0f};
  float depth = 0.0f;  // sum of weighted depths
  float depthWeight = 0.0f;
  float samples = 0.0f;
};

/// Marches one ray a pixel, width × height of them, row 0 at the top; pixel (x, y) is seen through picture
/// position (x, y) + subPixel. `number` is the sample's number and, with the seed in `parameters`, chooses
/// its random numbers. Runs on all threads; the result does not depend on their number. An empty volume gives
/// transmittance 1. `sky` is looked at where the environment is a lat-long picture. `layout` is that of the
/// densities, in whose frame the parameters are, and `heat` that of the temperatures, or nullptr.
std::vector<TwinPixel> marchPicture(const BrickLayout& layout, const BrickLayout* heat,
                                    const shared::MarchParameters& parameters, int width, int height,
                                    glm::vec2 subPixel, unsigned number, const shared::SkyArrays& sky = {});
/// The same over a volume's finest level, kept as `texel`.
std::vector<TwinPixel> marchPicture(const BrickVolume& bricks, const shared::MarchParameters& parameters,
                                    int width, int height, glm::vec2 subPixel, unsigned number,
                                    const shared::SkyArrays& sky = {}, Texel texel = Texel::r32f);

}  // namespace nephele
