// Tracking through the control grid. Depends on volume/bricks.h and GLM.
#include "preview/truth/tracking.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "preview/truth/along_ray.h"
#include "preview/truth/walk_cells.h"

namespace nephele::truth {
namespace {

using glm::vec3;

/// Residual ratio tracking along one ray.
template <class Value>
class Residual {
 public:
  Residual(const TrackedMedium& medium, const TrackedRay& ray, Random& random, uint64_t& looks)
      : along_(medium, ray, random, looks) {}

  /// Crosses [t0, t1] of a cell. False where Russian roulette ends the ray.
  bool cross(const ControlCell& cell, float t0, float t1) {
    column_ += cell.control * (t1 - t0);
    along_.clock.cross(cell.residual, t0, t1, along_.random, [&](float t) {
      factor_ *= notNegative(Value(1.0f) - along_.excessAt(cell, t) * along_.sigma);
    });
    const float depth = smallest(along_.sigma) * column_;
    if (depth < looked_ && largest(factor_) > kSmall) return true;
    looked_ = depth + 1.0f;
    const float counts = roulette(largest(transmittance()), along_.random);
    factor_ *= counts;
    return counts > 0.0f;
  }

  Value transmittance() const { return factor_ * exponential(-column_ * along_.sigma); }

 private:
  AlongRay<Value> along_;
  // Neither the control nor the looks alone let through so little before a ray is worth weighing.
  static constexpr float kSmall = 0.05f, kFirstDepth = 3.0f;
  float looked_ = kFirstDepth;  // the depth from which on it is weighed again
  float column_ = 0.0f;         // ∫ control ds
  Value factor_{1.0f};          // true transmittance over the control's
};

template <class Value>
vec3 transmittanceAs(const TrackedMedium& medium, const TrackedRay& ray, Random& random, uint64_t& looks) {
  Residual<Value> residual(medium, ray, random, looks);
  walkCells(medium.grid, ray,
            [&](const ControlCell& cell, float t0, float t1) { return residual.cross(cell, t0, t1); });
  return vec3(residual.transmittance());
}

/// Weights of the two outcomes at a tentative collision, per channel: `real` and `null` sum to 1. Returns the
/// probability of the first one that keeps them together.
float realProbability(const vec3& weight, const vec3& real) {
  const float all = weight.x + weight.y + weight.z;
  return all > 0.0f ? glm::dot(weight, real) / all : 0.0f;
}

}  // namespace

float densityIn(const TrackedMedium& medium, const ControlCell& cell, const vec3& position) {
  const BrickVolume& bricks = *medium.bricks;
  constexpr float kEdge = kBrickCells;
  vec3 corner = cell.corner;
  size_t slot = cell.slot;
  if (slot == kManyBricks) {
    const glm::ivec3 n = bricks.brickCount;
    const glm::ivec3 brick = glm::clamp(glm::ivec3(position / kEdge), glm::ivec3(0), n - 1);
    const uint32_t entry =
        bricks
            .index[(static_cast<size_t>(brick.z) * static_cast<size_t>(n.y) + static_cast<size_t>(brick.y)) *
                       static_cast<size_t>(n.x) +
                   static_cast<size_t>(brick.x)];
    if (entry == 0) return 0.0f;
    slot = entry - 1;
    corner = vec3(brick) * kEdge;
  }
  // A place on a face may round to either side of it.
  const vec3 local = glm::clamp(position - corner, vec3(0.0f), vec3(kEdge));
  const int x = std::min(static_cast<int>(local.x), kBrickCells - 1);
  const int y = std::min(static_cast<int>(local.y), kBrickCells - 1);
  const int z = std::min(static_cast<int>(local.z), kBrickCells - 1);
  const float fx = local.x - static_cast<float>(x), fy = local.y - static_cast<float>(y),
              fz = local.z - static_cast<float>(z);
  constexpr int kRow = kBrickSamples, kLayer = kBrickSamples * kBrickSamples;
  const float* s =
      bricks.samples.data() + slot * static_cast<size_t>(kBrickVolume) + z * kLayer + y * kRow + x;
  const auto along = [fx](const float* p) { return p[0] + fx * (p[1] - p[0]); };
  const float low = along(s) + fy * (along(s + kRow) - along(s));
  const float high = along(s + kLayer) + fy * (along(s + kLayer + kRow) - along(s + kLayer));
  return low + fz * (high - low);
}

vec3 transmittance(const TrackedMedium& medium, const TrackedRay& ray, Random& random, uint64_t& looks) {
  return medium.grey ? transmittanceAs<float>(medium, ray, random, looks)
                     : transmittanceAs<vec3>(medium, ray, random, looks);
}

vec3 scatteredShare(const TrackedMedium& medium) {
  vec3 share(0.0f);
  for (int c = 0; c < 3; ++c)
    if (medium.sigmaT[c] > 0.0f) share[c] = medium.sigmaS[c] / medium.sigmaT[c];
  return share;
}

vec3 absorbedShare(const TrackedMedium& medium) {
  vec3 share(0.0f);
  for (int c = 0; c < 3; ++c)
    if (medium.sigmaT[c] > 0.0f) share[c] = (medium.sigmaT[c] - medium.sigmaS[c]) / medium.sigmaT[c];
  return share;
}

bool nextCollision(const TrackedMedium& medium, TrackedRay& ray, vec3& weight, Random& random,
                   uint64_t& looks, vec3* arriving) {
  float toLook = random.exponential();
  bool found = false;
  const vec3 share = medium.sigmaT / medium.sigmaMax;
  walkCells(medium.grid, ray, [&](const ControlCell& cell, float t0, float t1) {
    const float rate = cell.maximum * medium.sigmaMax;
    float ahead = rate * (t1 - t0);
    while (toLook < ahead) {
      ahead -= toLook;
      const vec3 position = ray.origin + (t1 - ahead / rate) * ray.direction;
      const float u = random.uniform();
      if (medium.grey) {  // below the certain minimum no look is needed
        found = u * cell.maximum < cell.minimum;
        if (!found) {
          ++looks;
          found = u * cell.maximum < densityIn(medium, cell, position);
        }
      } else {
        ++looks;
        const vec3 real = share * std::min(densityIn(medium, cell, position) / cell.maximum, 1.0f);
        const float probability = realProbability(weight, real);
        found = u < probability;
        weight *= found ? real / probability : (vec3(1.0f) - real) / (1.0f - probability);
      }
      if (found) {
        ray.origin = position;
        if (arriving != nullptr) *arriving = weight;
        weight *= scatteredShare(medium);
        return false;
      }
      toLook = random.exponential();
    }
    toLook -= ahead;
    return true;
  });
  return found;
}

}  // namespace nephele::truth
