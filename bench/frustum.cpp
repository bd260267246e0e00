// OpenVDB's FrustumRasterizer. Compiled as C++17: its reductions do not meet what TBB asks of them in C++20.
#include "bench/frustum.h"

#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointCount.h>
#include <openvdb/points/PointRasterizeFrustum.h>

namespace nephele::bench {

namespace points = openvdb::points;

struct Frustum::State {
  double radius, voxelSize;
  points::PointDataGrid::Ptr points;
};

Frustum::Frustum(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z,
                 double radius, double voxelSize)
    : state_(new State{radius, voxelSize, nullptr}) {
  openvdb::initialize();
  std::vector<openvdb::Vec3s> positions;
  for (size_t n = 0; n < x.size(); ++n) positions.emplace_back(x[n], y[n], z[n]);
  const points::PointAttributeVector<openvdb::Vec3s> wrapped(positions);
  // Their own choice of a grid that holds a handful of points a voxel.
  constexpr int kPointsPerVoxel = 8;
  const float size = points::computeVoxelSize(wrapped, kPointsPerVoxel);
  state_->points = points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(
      positions, *openvdb::math::Transform::createLinearTransform(double(size)));
}

Frustum::~Frustum() = default;

uint64_t Frustum::rasterize() {
  const auto transform = openvdb::math::Transform::createLinearTransform(state_->voxelSize);
  points::FrustumRasterizerSettings settings(*transform);
  settings.useRadius = true;
  settings.radiusScale = float(state_->radius);
  points::FrustumRasterizer<points::PointDataGrid> rasterizer(settings);
  rasterizer.addPoints(state_->points);
  return rasterizer.rasterizeUniformDensity(points::RasterMode::ACCUMULATE)->activeVoxelCount();
}

}  // namespace nephele::bench
