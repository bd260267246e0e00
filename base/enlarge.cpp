// Mixing four pixels. Depends on base alone.
#include "base/enlarge.h"

#include <algorithm>
#include <cmath>

namespace nephele {
namespace {

/// Where a pixel's centre lies among `from` pixels: the lower neighbour, the upper one and its share.
struct Place {
  size_t low, high;
  double share;
};

Place placeOf(int pixel, int from, int to) {
  const double at = std::clamp((pixel + 0.5) * from / to - 0.5, 0.0, static_cast<double>(from - 1));
  const int low = static_cast<int>(at);
  return {static_cast<size_t>(low), static_cast<size_t>(std::min(low + 1, from - 1)), at - low};
}

}  // namespace

Picture enlarged(const Picture& small, int width, int height) {
  Picture big;
  big.width = width;
  big.height = height;
  for (const std::string& name : small.names) big.add(name);
  const size_t row = static_cast<size_t>(small.width);
  for (int y = 0; y < height; ++y) {
    const Place v = placeOf(y, small.height, height);
    for (int x = 0; x < width; ++x) {
      const Place u = placeOf(x, small.width, width);
      const size_t to = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      for (size_t plane = 0; plane < small.planes.size(); ++plane) {
        const std::vector<float>& from = small.planes[plane];
        const auto mixed = [&](size_t line) {
          return std::lerp(double{from[line * row + u.low]}, double{from[line * row + u.high]}, u.share);
        };
        big.planes[plane][to] = static_cast<float>(std::lerp(mixed(v.low), mixed(v.high), v.share));
      }
    }
  }
  return big;
}

}  // namespace nephele
