// A closed mesh as an envelope: the row mesh. Depends on solid.h, envelope_field.h and shared text.
#include <cmath>

#include "bake/fields/envelope_field.h"
#include "bake/fields/rows.h"
#include "bake/fields/solid.h"

namespace nephele {
namespace {

/// Above this many triangles near a block, the tree finds a point's nearest sooner than trying them all.
constexpr size_t kFewTriangles = 48;

/// Whether points are inside, the crossings of the last one's column kept: on a lattice z runs fastest, and
/// eight points share one.
class Column {
 public:
  bool contains(const Solid& solid, const glm::dvec3& p) {
    if (p.x != x_ || p.y != y_) solid.crossings(p.x, p.y, crossings_);
    x_ = p.x;
    y_ = p.y;
    return windsRound(crossings_, p.z);
  }

 private:
  double x_ = std::numeric_limits<double>::quiet_NaN(), y_ = x_;
  std::vector<Solid::Crossing> crossings_;
};

class MeshField final : public Field {
 public:
  MeshField(Solid solid, double falloff) : solid_(std::move(solid)), falloff_(falloff) {}

  void evaluate(const Points& points, float* values) const override {
    Box box = nothing();
    for (size_t n = 0; n < points.count; ++n) box = hull(box, {place(points, n), place(points, n)});
    const glm::dvec3 centre = box.centre();
    const double reach = lengthOf(box.halfSize()) * (1.0 + kRoom);
    uint32_t nearest = 0;
    const double apart = solid_.distance(centre, nearest);
    // Where the surface passes the block by, all of it is on one side.
    const bool oneSided = apart > reach, inside = oneSided && solid_.contains(centre);
    if (oneSided && (!inside || apart - reach > falloff_)) {
      std::fill_n(values, points.count, inside ? 1.0f : 0.0f);
      return;
    }
    std::vector<Solid::Triangle> close;
    const bool few = solid_.near(centre, (apart + 2.0 * reach) * (1.0 + kRoom), kFewTriangles, close);
    Column column;
    for (size_t n = 0; n < points.count; ++n) {
      const glm::dvec3 p = place(points, n);
      values[n] = 0.0f;
      if (!inside && !column.contains(solid_, p)) continue;
      const double distance = few ? leastDistance(p, close) : solid_.distance(p, nearest);
      values[n] = shared::envelope(-float(distance), float(falloff_));
    }
  }

  Interval bounds(const Box& box) const override {
    const glm::dvec3 centre = box.centre();
    const double apart = solid_.distance(centre), distance = solid_.contains(centre) ? -apart : apart;
    // The distance becomes a float; beside that, doubles round by one part in 10^12 of the coordinates.
    const double way = lengthOf(box.halfSize());
    const double reach = way + kRoom * (apart + way) + 1e-12 * lengthOf(greatestMagnitudes(box));
    return envelopeOver({distance - reach, distance + reach}, falloff_);
  }

  Box support() const override { return solid_.box(); }

 private:
  static constexpr double kRoom = 1e-6;

  static glm::dvec3 place(const Points& points, size_t n) {
    return points.origin + glm::dvec3(double(points.x[n]), double(points.y[n]), double(points.z[n]));
  }

  static double leastDistance(const glm::dvec3& p, const std::vector<Solid::Triangle>& triangles) {
    double square = std::numeric_limits<double>::infinity();
    for (const Solid::Triangle& t : triangles) square = std::min(square, squaredDistance(p, t));
    return std::sqrt(square);
  }

  Solid solid_;
  double falloff_;
};

Complaint validateMesh(const Arguments& a) {
  closedMesh(readMesh(a.file("file")), a.file("file"));
  return complainOfSizes(a, {"scale"});
}

}  // namespace

FieldRow meshRow() {
  return {"mesh",
          "1 deep inside a closed mesh, 0 from its surface outwards. Parts that overlap leave a seam at the "
          "surfaces inside; unite them first.",
          {{"file", ParameterType::file, "An OBJ or PLY file.", std::nullopt},
           {"scale", ParameterType::number, "World units for one unit of the file.", Value{1.0}, kPositive},
           {"center", ParameterType::vector, "Where the file's origin goes.",
            Value{std::array<double, 3>{0, 0, 0}}, kAny, "world units"},
           falloffParameter(0.2)},
          [](const Arguments& a, const BuildContext&) -> FieldPtr {
            const std::string& path = a.file("file");
            return std::make_shared<MeshField>(
                Solid(closedMesh(readMesh(path), path), a.number("scale"), a.vector("center")),
                a.number("falloff"));
          },
          validateMesh};
}

}  // namespace nephele
