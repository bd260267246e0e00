// OpenVDB's FrustumRasterizer as the other side of a comparison. No OpenVDB in this header.
#pragma once

#include <memory>
#include <vector>

namespace nephele::bench {

/// Points of one radius, sorted into OpenVDB's grid of points before any clock starts.
class Frustum {
 public:
  Frustum(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z,
          double radius, double voxelSize);
  ~Frustum();
  /// Adds up spheres of density 1 on a grid of `voxelSize`; returns its active voxels.
  uint64_t rasterize();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nephele::bench
