// Sites of emitters out of files. Depends on fields (meshes), particles, volume, base.
#include "bake/particle_sources.h"

#include <algorithm>
#include <cmath>

#include "bake/fields/solid.h"
#include "base/error.h"
#include "volume/points.h"

namespace nephele {
namespace {

bool endsIn(const std::string& path, std::string_view extension) {
  return path.size() >= extension.size() &&
         path.compare(path.size() - extension.size(), extension.size(), extension) == 0;
}

class PointSites final : public SiteSource {
 public:
  PointSites(PointSet points, float scale) : points_(std::move(points)), scale_(scale) {}

  uint64_t count() const override { return points_.size(); }

  Site site(uint64_t number, uint32_t) const override {
    const size_t n = size_t(number);
    Site site;
    site.position = scale_ * glm::vec3(points_.x[n], points_.y[n], points_.z[n]);
    if (!points_.vx.empty()) site.velocity = scale_ * glm::vec3(points_.vx[n], points_.vy[n], points_.vz[n]);
    if (!points_.radius.empty()) site.radius = scale_ * points_.radius[n];
    if (!points_.density.empty()) site.density = points_.density[n];
    if (!points_.life.empty()) site.life = points_.life[n];
    if (!points_.temperature.empty()) site.temperature = points_.temperature[n];
    return site;
  }

 private:
  PointSet points_;
  float scale_;
};

double uniform(uint32_t seed, uint64_t n, uint32_t k) {
  uint32_t state = motion::randomState(uint32_t(n), uint32_t(n >> 32), k, seed);
  return double(motion::nextUniform(state));
}

class MeshSites final : public SiteSource {
 public:
  MeshSites(TriangleMesh mesh, double scale, bool surface) : mesh_(std::move(mesh)), scale_(scale) {
    double area = 0.0;
    for (const auto& t : mesh_.triangles) {
      const glm::dvec3 normal = normalOf(t);
      area += std::sqrt(glm::dot(normal, normal));
      areas_.push_back(area);
    }
    if (!surface) inside_.emplace(mesh_, 1.0, glm::dvec3(0.0));
  }

  uint64_t count() const override { return 0; }

  Site site(uint64_t number, uint32_t seed) const override {
    if (inside_) return siteInside(number, seed);
    const double at = uniform(seed, number, 0) * areas_.back();
    const size_t n = size_t(std::upper_bound(areas_.begin(), areas_.end(), at) - areas_.begin());
    const auto& t = mesh_.triangles[std::min(n, areas_.size() - 1)];
    double u = uniform(seed, number, 1), v = uniform(seed, number, 2);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;  // the other half of the parallelogram
    const glm::dvec3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
    const glm::dvec3 normal = normalOf(t);
    Site site;
    site.position = glm::vec3(scale_ * (a + u * (b - a) + v * (c - a)));
    const double length = std::sqrt(glm::dot(normal, normal));
    if (length > 0.0) site.normal = glm::vec3(normal / length);
    return site;
  }

 private:
  glm::dvec3 normalOf(const std::array<uint32_t, 3>& t) const {
    return glm::cross(mesh_.vertices[t[1]] - mesh_.vertices[t[0]],
                      mesh_.vertices[t[2]] - mesh_.vertices[t[0]]);
  }

  Site siteInside(uint64_t number, uint32_t seed) const {
    const Box box = inside_->box();
    // A mesh that fills a hundred-thousandth of its box is found with one failure in 10^4; the last try is
    // kept then.
    constexpr uint32_t kMostTries = 1'000'000;
    glm::dvec3 p = box.centre();
    for (uint32_t n = 0; n < kMostTries; ++n) {
      p = box.low + (box.high - box.low) * glm::dvec3(uniform(seed, number, 3 * n),
                                                      uniform(seed, number, 3 * n + 1),
                                                      uniform(seed, number, 3 * n + 2));
      if (inside_->contains(p)) break;
    }
    Site site;
    site.position = glm::vec3(scale_ * p);
    return site;
  }

  TriangleMesh mesh_;
  double scale_;
  std::vector<double> areas_;  // running sum over triangles
  std::optional<Solid> inside_;
};

}  // namespace

PointSet readPoints(const std::string& path) {
  if (!endsIn(path, ".vdb")) return readPointFile(path);
  PointColumns columns = readVdbPoints(path);
  PointSet points;
  for (const PointSet::Column& column : PointSet::columns())
    if (const auto found = columns.find(column.name); found != columns.end())
      points.*column.values = std::move(found->second);
  checkPoints(points, path, 0);
  return points;
}

void writePoints(const std::string& path, const PointSet& points) {
  if (endsIn(path, ".csv")) return writePointCsv(path, points);
  if (endsIn(path, ".ply")) return writePointPly(path, points);
  PointColumns columns;
  for (const PointSet::Column& column : PointSet::columns()) columns[column.name] = points.*column.values;
  writeVdbPoints(path, columns);
}

SiteSourcePtr makeSiteSource(const Emitter& emitter, const std::string& path) {
  if (emitter.shape == EmitterShape::points) {
    PointSet points = readPoints(path);
    if (points.size() == 0) throw InputError({path}, "holds no points to emit from");
    return std::make_shared<PointSites>(std::move(points), float(emitter.scale));
  }
  if (emitter.shape != EmitterShape::mesh) return nullptr;
  TriangleMesh mesh = readMesh(path);
  if (!emitter.surface) mesh = closedMesh(std::move(mesh), path);
  return std::make_shared<MeshSites>(std::move(mesh), emitter.scale, emitter.surface);
}

}  // namespace nephele
