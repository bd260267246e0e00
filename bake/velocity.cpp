// Velocities from motion and from fields. Depends on pipeline and motion.h.
#include "bake/velocity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "bake/fields/motion.h"
#include "bake/fields/transform.h"

namespace nephele {
namespace {

/// A velocity of a field that can be placed by a transform along with the field.
class Flow : public VectorField {
 public:
  virtual std::shared_ptr<const Flow> placed(const Placement& placement, const glm::dvec3& scroll) const = 0;
};
using FlowPtr = std::shared_ptr<const Flow>;

class Uniform final : public Flow {
 public:
  explicit Uniform(const glm::dvec3& velocity) : velocity_(velocity) {}
  FlowPtr placed(const Placement& placement, const glm::dvec3& scroll) const override {
    return std::make_shared<Uniform>(placement.worldFromLocal * velocity_ + scroll);
  }
  void evaluate(const Lattice&, float* x, float* y, float* z) const override {
    std::fill_n(x, kBlockPoints, float(velocity_.x));
    std::fill_n(y, kBlockPoints, float(velocity_.y));
    std::fill_n(z, kBlockPoints, float(velocity_.z));
  }

 private:
  glm::dvec3 velocity_;
};

/// Three fields, one a component.
class Components final : public VectorField {
 public:
  explicit Components(std::array<FieldPtr, 3> fields) : fields_(std::move(fields)) {}
  void evaluate(const Lattice& lattice, float* x, float* y, float* z) const override {
    float* const out[3] = {x, y, z};
    for (size_t axis = 0; axis < 3; ++axis) fields_[axis]->evaluate(lattice, out[axis]);
  }

 private:
  std::array<FieldPtr, 3> fields_;
};

/// A velocity and the field that carries it.
struct Carrier {
  FieldPtr field;
  FlowPtr velocity;
};

/// Σ |value| v / Σ |value|; the plain mean where all values are 0.
class Mean final : public Flow {
 public:
  explicit Mean(std::vector<Carrier> carriers) : carriers_(std::move(carriers)) {}
  FlowPtr placed(const Placement& placement, const glm::dvec3& scroll) const override {
    std::vector<Carrier> moved;
    for (const Carrier& carrier : carriers_)
      moved.push_back({placedField(carrier.field, placement), carrier.velocity->placed(placement, scroll)});
    return std::make_shared<Mean>(std::move(moved));
  }
  void evaluate(const Lattice& lattice, float* x, float* y, float* z) const override {
    // Weighted sums along x, y, z and of the weights; then the same unweighted.
    float weighted[4][kBlockPoints] = {}, plain[3][kBlockPoints] = {};
    for (const Carrier& carrier : carriers_) {
      float v[3][kBlockPoints], value[kBlockPoints];
      carrier.velocity->evaluate(lattice, v[0], v[1], v[2]);
      carrier.field->evaluate(lattice, value);
      for (size_t n = 0; n < size_t(kBlockPoints); ++n) {
        const float weight = std::abs(value[n]);
        for (size_t axis = 0; axis < 3; ++axis) {
          weighted[axis][n] += weight * v[axis][n];
          plain[axis][n] += v[axis][n];
        }
        weighted[3][n] += weight;
      }
    }
    float* const out[3] = {x, y, z};
    const float count = float(carriers_.size());
    for (size_t axis = 0; axis < 3; ++axis)
      for (size_t n = 0; n < size_t(kBlockPoints); ++n)
        out[axis][n] = weighted[3][n] > 0.0f ? weighted[axis][n] / weighted[3][n] : plain[axis][n] / count;
  }

 private:
  std::vector<Carrier> carriers_;
};

/// Derives velocities from the leaves up, each shared field once for each size of voxel that it is read with.
class Derivation {
 public:
  /// nullptr where nothing in the field moves.
  FlowPtr of(const FieldSpec& spec, const BuildContext& context) {
    const std::pair key{&spec, context.voxelSize};
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    return known_[key] = derive(spec, context);
  }

 private:
  FlowPtr derive(const FieldSpec& spec, const BuildContext& context) {
    const BuildContext inner = spec.row->inner ? spec.row->inner(Arguments(spec.values), context) : context;
    std::vector<std::pair<const FieldSpec*, FlowPtr>> moving;
    for (const auto& [name, children] : spec.children)
      for (const FieldSpecPtr& child : children)
        if (FlowPtr velocity = of(*child, inner)) moving.emplace_back(child.get(), std::move(velocity));
    if (moving.empty()) return ownOf(spec, context);
    const FlowPtr first = moving.front().second;
    if (spec.row->name == "transform")
      return first->placed(placementOf(Arguments(spec.values), context), ownSpeed(spec, context));
    if (std::all_of(moving.begin(), moving.end(), [&](const auto& m) { return m.second == first; }))
      return first;
    std::vector<Carrier> carriers;
    for (auto& [child, velocity] : moving)
      carriers.push_back({buildField(*child, inner), std::move(velocity)});
    return std::make_shared<Mean>(std::move(carriers));
  }

  /// Equal speeds are one object, so that they are known as equal.
  FlowPtr ownOf(const FieldSpec& spec, const BuildContext& context) {
    const glm::dvec3 speed = ownSpeed(spec, context);
    if (speed == glm::dvec3(0.0)) return nullptr;
    FlowPtr& known = uniform_[{speed.x, speed.y, speed.z}];
    if (!known) known = std::make_shared<Uniform>(speed);
    return known;
  }

  static glm::dvec3 ownSpeed(const FieldSpec& spec, const BuildContext& context) {
    return spec.row->motion ? meanScroll(spec.row->motion(Arguments(spec.values)), context) : glm::dvec3(0.0);
  }

  std::map<std::pair<const FieldSpec*, double>, FlowPtr> known_;
  std::map<std::array<double, 3>, FlowPtr> uniform_;
};

}  // namespace

VectorFieldPtr buildVelocity(const Asset& asset, const BuildContext& context) {
  if (asset.velocityFields.size() == 3) {
    std::array<FieldPtr, 3> fields;
    for (size_t axis = 0; axis < 3; ++axis) fields[axis] = buildField(*asset.velocityFields[axis], context);
    return std::make_shared<Components>(std::move(fields));
  }
  if (!asset.velocityFromMotion) return nullptr;
  if (VectorFieldPtr derived = Derivation().of(*asset.density, context)) return derived;
  return std::make_shared<Uniform>(glm::dvec3(0.0));
}

}  // namespace nephele
