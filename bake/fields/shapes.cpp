// Envelopes from signed distances: the row sphere. Depends on field.h and shared text.
#include <cmath>

#include "bake/fields/rows.h"
#include "bake/fields/shared_text.h"

namespace nephele {
namespace {

double lengthOf(const glm::dvec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

class Sphere final : public Field {
 public:
  Sphere(const glm::dvec3& centre, double radius, double falloff)
      : centre_(centre), radius_(radius), falloff_(falloff) {}

  void evaluate(const Points& points, float* values) const override {
    const glm::vec3 offset(points.origin - centre_);
    for (size_t n = 0; n < points.count; ++n) {
      const glm::vec3 p = offset + glm::vec3(points.x[n], points.y[n], points.z[n]);
      values[n] = shared::envelope(shared::distanceToSphere(p, float(radius_)), float(falloff_));
    }
  }

  Interval bounds(const Box& box) const override {
    const glm::dvec3 low = box.low - centre_, high = box.high - centre_;
    glm::dvec3 nearest(0.0), farthest(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      nearest[axis] = low[axis] > 0.0 ? low[axis] : (high[axis] < 0.0 ? high[axis] : 0.0);
      farthest[axis] = std::max(std::abs(low[axis]), std::abs(high[axis]));
    }
    // Rounding of the offset, the length and the difference, all of the size of the farthest distance or the
    // radius.
    const double room = 1e-6 * (lengthOf(farthest) + radius_);
    const double least = lengthOf(nearest) - radius_ - room, most = lengthOf(farthest) - radius_ + room;
    return {valueAt(most), valueAt(least)};
  }

  Box support() const override { return grown({centre_, centre_}, radius_ * (1.0 + 1e-6)); }

 private:
  /// The envelope at a signed distance; falls with it.
  double valueAt(double distance) const {
    if (falloff_ <= 0.0) return distance < 0.0 ? 1.0 : 0.0;
    return std::clamp(-distance / falloff_, 0.0, 1.0);
  }

  glm::dvec3 centre_;
  double radius_, falloff_;
};

}  // namespace

FieldRow sphereRow() {
  return {"sphere",
          "1 deep inside a sphere, 0 from its surface outwards, falling over `falloff`.",
          {{"center", ParameterType::vector, "Centre.", Value{std::array<double, 3>{0, 0, 0}}, kAny,
            "world units"},
           {"radius", ParameterType::number, "Radius.", Value{1.0}, kPositive, "world units"},
           {"falloff", ParameterType::number,
            "Depth below the surface at which the value reaches 1; 0: a hard edge.", Value{1.0}, kNonNegative,
            "world units"}},
          [](const Arguments& a, const BuildContext&) -> FieldPtr {
            return std::make_shared<Sphere>(a.vector("center"), a.number("radius"), a.number("falloff"));
          }};
}

}  // namespace nephele
