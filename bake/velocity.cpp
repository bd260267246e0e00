// Velocities from motion and from fields. Depends on pipeline and motion.h.
#include "bake/velocity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "bake/fields/motion.h"

namespace nephele {
namespace {

class Uniform final : public VectorField {
 public:
  explicit Uniform(const glm::dvec3& velocity) : velocity_(velocity) {}
  void evaluate(const Lattice&, float* x, float* y, float* z) const override {
    std::fill_n(x, kBlockPoints, velocity_.x);
    std::fill_n(y, kBlockPoints, velocity_.y);
    std::fill_n(z, kBlockPoints, velocity_.z);
  }

 private:
  glm::vec3 velocity_;
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
  VectorFieldPtr velocity;
};

/// Σ |value| v / Σ |value|; the plain mean where all values are 0.
class Mean final : public VectorField {
 public:
  explicit Mean(std::vector<Carrier> carriers) : carriers_(std::move(carriers)) {}
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

/// Derives velocities from the leaves up, each shared field once.
class Derivation {
 public:
  explicit Derivation(const BuildContext& context) : context_(context) {}

  /// nullptr where nothing in the field moves.
  VectorFieldPtr of(const FieldSpec& spec) {
    if (const auto known = known_.find(&spec); known != known_.end()) return known->second;
    return known_[&spec] = derive(spec);
  }

 private:
  VectorFieldPtr derive(const FieldSpec& spec) {
    std::vector<std::pair<const FieldSpec*, VectorFieldPtr>> moving;
    for (const auto& [name, children] : spec.children)
      for (const FieldSpecPtr& child : children)
        if (VectorFieldPtr velocity = of(*child)) moving.emplace_back(child.get(), std::move(velocity));
    if (moving.empty()) return ownOf(spec);
    const VectorFieldPtr first = moving.front().second;
    if (std::all_of(moving.begin(), moving.end(), [&](const auto& m) { return m.second == first; }))
      return first;
    std::vector<Carrier> carriers;
    for (auto& [child, velocity] : moving)
      carriers.push_back({buildField(*child, context_), std::move(velocity)});
    return std::make_shared<Mean>(std::move(carriers));
  }

  /// Equal speeds are one object, so that they are known as equal.
  VectorFieldPtr ownOf(const FieldSpec& spec) {
    if (!spec.row->motion) return nullptr;
    const glm::dvec3 speed = meanScroll(spec.row->motion(Arguments(spec.values)), context_);
    if (speed == glm::dvec3(0.0)) return nullptr;
    VectorFieldPtr& known = uniform_[{speed.x, speed.y, speed.z}];
    if (!known) known = std::make_shared<Uniform>(speed);
    return known;
  }

  BuildContext context_;
  std::map<const FieldSpec*, VectorFieldPtr> known_;
  std::map<std::array<double, 3>, VectorFieldPtr> uniform_;
};

}  // namespace

VectorFieldPtr buildVelocity(const Asset& asset, const BuildContext& context) {
  if (asset.velocityFields.size() == 3) {
    std::array<FieldPtr, 3> fields;
    for (size_t axis = 0; axis < 3; ++axis) fields[axis] = buildField(*asset.velocityFields[axis], context);
    return std::make_shared<Components>(std::move(fields));
  }
  if (!asset.velocityFromMotion) return nullptr;
  if (VectorFieldPtr derived = Derivation(context).of(*asset.density)) return derived;
  return std::make_shared<Uniform>(glm::dvec3(0.0));
}

}  // namespace nephele
