// Bubbles on bubbles [Neyret]: the row cauliflower. Depends on box_tree.h, envelope_field.h and shared text.
#include <cmath>

#include "bake/fields/box_tree.h"
#include "bake/fields/envelope_field.h"
#include "bake/fields/perlin.h"
#include "bake/fields/rows.h"

namespace nephele {
namespace {

/// An ellipsoid, places relative to the cauliflower's centre.
struct Bubble {
  glm::vec3 centre, radii;
  float shortest;
  int scale;            // 0: the first
  float weight = 1.0f;  // what the band limit leaves of it
  float distance(const glm::vec3& p) const {
    return shared::distanceToEllipsoid(p - centre, radii, shortest);
  }
};

Box boxOf(const Bubble& b) {
  const glm::dvec3 centre(b.centre), radii(b.radii);
  // Room for float distances, of the size of the place and the bubble.
  return grown({centre - radii, centre + radii}, 1e-6 * (lengthOf(centre) + lengthOf(radii)));
}

struct Growth {
  glm::dvec3 radii;
  int64_t scales, count;
  double ratio, jitter, upward;
  int upAxis;
  uint32_t seed;
};

/// Numbers in [0, 1) by place in a list; the same on every machine.
class Dice {
 public:
  explicit Dice(uint32_t seed) : seed_(seed) {}
  double roll() {
    constexpr double kBits = 1.0 / 4294967296.0;
    return double(shared::hashCell({next_++, 2, 0}, seed_)) * kBits;
  }
  /// Evenly spread over the unit sphere: the part of a cube's points that lies in the ball, stretched.
  glm::dvec3 direction() {
    while (true) {
      const double x = 2.0 * roll() - 1.0, y = 2.0 * roll() - 1.0, z = 2.0 * roll() - 1.0;
      const double square = x * x + y * y + z * z;
      if (square > 1.0 || square < 1e-6) continue;
      return glm::dvec3(x, y, z) / std::sqrt(square);
    }
  }

 private:
  uint32_t seed_;
  int next_ = 0;
};

/// Lays bubbles on bubbles, parents before children.
class Grower {
 public:
  explicit Grower(const Growth& growth) : growth_(growth), dice_(growth.seed) {}

  std::vector<Bubble> grow() {
    const glm::vec3 radii(growth_.radii);
    bubbles_.push_back({glm::vec3(0.0f), radii, std::min({radii.x, radii.y, radii.z}), 0});
    size_t first = 0;
    for (int64_t scale = 0; scale < growth_.scales; ++scale) {
      const size_t end = bubbles_.size();
      for (size_t parent = first; parent < end; ++parent) layOn(parent);
      first = end;
    }
    return std::move(bubbles_);
  }

 private:
  void layOn(size_t parent) {
    std::vector<glm::dvec3> taken;
    for (int64_t n = 0; n < growth_.count; ++n) {
      const glm::dvec3 at = freeDirection(parent, taken);
      taken.push_back(at);
      const Bubble on = bubbles_[parent];
      const double size = growth_.ratio * (1.0 + growth_.jitter * (2.0 * dice_.roll() - 1.0));
      bubbles_.push_back({on.centre + glm::vec3(at * glm::dvec3(on.radii)), on.radii * float(size),
                          on.shortest * float(size), on.scale + 1});
    }
  }

  /// Of a few directions, the one farthest from those taken [Mitchell 1991]. Low ones are asked for less
  /// often, and those that point back into the parent's own parent are turned round.
  glm::dvec3 freeDirection(size_t parent, const std::vector<glm::dvec3>& taken) {
    constexpr int kTries = 16;
    glm::dvec3 best(0.0);
    double farthest = -1.0;
    for (int n = 0; n < kTries; ++n) {
      const glm::dvec3 candidate = outwards(parent, dice_.direction());
      double nearest = 4.0;
      for (const glm::dvec3& other : taken) {
        const glm::dvec3 apart = candidate - other;
        nearest = std::min(nearest, apart.x * apart.x + apart.y * apart.y + apart.z * apart.z);
      }
      // The weight of a direction straight down is 1 − upward.
      nearest *= 1.0 - growth_.upward * 0.5 * (1.0 - candidate[growth_.upAxis]);
      if (nearest > farthest) {
        farthest = nearest;
        best = candidate;
      }
    }
    return best;
  }

  glm::dvec3 outwards(size_t parent, glm::dvec3 direction) const {
    const glm::dvec3 centre(bubbles_[parent].centre);
    const double dot = centre.x * direction.x + centre.y * direction.y + centre.z * direction.z;
    return dot < 0.0 ? -direction : direction;
  }

  Growth growth_;
  Dice dice_;
  std::vector<Bubble> bubbles_;
};

/// The bubbles that the grid can hold: laid on others and under two voxels thick they are left out, under
/// four weakened. Tells each scale's mean thickness and weight where any of its bubbles was.
std::vector<Bubble> withinBandLimit(std::vector<Bubble> bubbles, const BuildContext& context) {
  struct Scale {
    double count = 0.0, voxels = 0.0, weight = 0.0;
  };
  std::vector<Scale> scales(size_t(bubbles.back().scale) + 1);
  for (Bubble& bubble : bubbles) {
    const double voxels = 2.0 * double(bubble.shortest) / context.voxelSize;
    if (bubble.scale > 0) bubble.weight = float(bandLimit(voxels));
    Scale& scale = scales[size_t(bubble.scale)];
    scale.count += 1.0;
    scale.voxels += voxels;
    scale.weight += double(bubble.weight);
  }
  for (size_t n = 0; context.notes && n < scales.size(); ++n)
    if (const Scale& scale = scales[n]; scale.weight < scale.count)
      context.notes->push_back(
          {"cauliflower", int(n), scale.voxels / scale.count, scale.weight / scale.count});
  std::erase_if(bubbles, [](const Bubble& bubble) { return bubble.weight == 0.0f; });
  return bubbles;
}

std::vector<Box> boxesOf(const std::vector<Bubble>& bubbles) {
  std::vector<Box> boxes;
  for (const Bubble& bubble : bubbles) boxes.push_back(boxOf(bubble));
  return boxes;
}

class Cauliflower final : public Field {
 public:
  Cauliflower(const glm::dvec3& centre, double falloff, std::vector<Bubble> bubbles)
      : centre_(centre), falloff_(falloff), bubbles_(std::move(bubbles)), tree_(boxesOf(bubbles_)) {
    for (const Bubble& bubble : bubbles_) {
      extent_ = hull(extent_, boxOf(bubble));
      reach_ = std::max(reach_, lengthOf(glm::dvec3(bubble.centre)) + lengthOf(glm::dvec3(bubble.radii)));
    }
  }

  void evaluate(const Points& points, float* values) const override {
    const glm::vec3 offset(points.origin - centre_);
    Box box = nothing();
    for (size_t n = 0; n < points.count; ++n) {
      const glm::dvec3 p(offset + glm::vec3(points.x[n], points.y[n], points.z[n]));
      box = hull(box, {p, p});
    }
    std::fill_n(values, points.count, 0.0f);
    const float falloff = float(falloff_);
    forEachNear(box, [&](const Bubble& bubble) {
      for (size_t n = 0; n < points.count; ++n)
        values[n] = std::max(
            values[n],
            bubble.weight *
                shared::envelope(bubble.distance(offset + glm::vec3(points.x[n], points.y[n], points.z[n])),
                                 falloff));
    });
  }

  Interval bounds(const Box& box) const override {
    const Box local{box.low - centre_, box.high - centre_};
    const double room = distanceRoom(local, reach_);
    Interval value{0.0, 0.0};
    forEachNear(grown(local, room), [&](const Bubble& bubble) {
      const glm::dvec3 at(bubble.centre);
      const Box about{local.low - at, local.high - at};
      const auto distance = [&](const glm::dvec3& p) {
        return double(shared::distanceToEllipsoid(glm::vec3(p), bubble.radii, bubble.shortest));
      };
      const Interval whole = envelopeOver(
          {distance(leastMagnitudes(about)) - room, distance(greatestMagnitudes(about)) + room}, falloff_);
      value = maximum(value, bubble.weight == 1.0f ? whole : scaled(whole, double(bubble.weight)));
    });
    return value;
  }

  Box support() const override { return {extent_.low + centre_, extent_.high + centre_}; }

 private:
  template <class Visit>
  void forEachNear(const Box& box, const Visit& visit) const {
    tree_.forEach([&](const Box& node) { return !intersection(node, box).empty(); },
                  [&](uint32_t item) {
                    if (!intersection(boxOf(bubbles_[item]), box).empty()) visit(bubbles_[item]);
                  });
  }

  glm::dvec3 centre_;
  double falloff_;
  std::vector<Bubble> bubbles_;
  BoxTree tree_;
  Box extent_ = nothing();
  double reach_ = 0.0;
};

Complaint validateCauliflower(const Arguments& a) {
  constexpr double kMostBubbles = 2e5;
  double sum = 0.0, last = 1.0;
  for (int64_t scale = 0; scale < a.integer("scales"); ++scale) sum += last *= double(a.integer("count"));
  if (sum > kMostBubbles)
    return {{"count", "'scales' and 'count' ask for " + std::to_string(int64_t(sum)) +
                          " bubbles; at most 200000 are laid"}};
  return complainOfSizes(a, {}, {"radii"});
}

}  // namespace

FieldRow cauliflowerRow() {
  return {
      "cauliflower",
      "Bubbles on bubbles, as on a cumulus: an ellipsoid, smaller ones all over it, smaller ones on each "
      "of those; 1 deep inside any of them, 0 outside all. Bubbles finer than the grid can hold are left "
      "out.",
      {{"center", ParameterType::vector, "Centre of the first.", Value{std::array<double, 3>{0, 0, 0}}, kAny,
        "world units"},
       {"radii", ParameterType::vector, "Half the first one's extent along x, y and z.",
        Value{std::array<double, 3>{0.55, 0.55, 0.42}}, kPositive, "world units"},
       {"scales",
        ParameterType::integer,
        "How often bubbles are laid on bubbles.",
        Value{int64_t{3}},
        {0.0, 6.0, false, false}},
       {"count",
        ParameterType::integer,
        "Bubbles laid on each bubble.",
        Value{int64_t{22}},
        {1.0, 1000.0, false, false}},
       {"ratio",
        ParameterType::number,
        "Size of a bubble over that of the one it lies on.",
        Value{0.42},
        {0.01, 1.0, false, false}},
       {"jitter",
        ParameterType::number,
        "How much sizes differ, as a share.",
        Value{0.3},
        {0.0, 0.9, false, false}},
       {"upward", ParameterType::number, "How much the upper side is preferred; 0: not at all.", Value{0.7},
        kUnit},
       kSeed,
       falloffParameter(0.08)},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        const uint32_t seed = shared::hashCell({int32_t(uint32_t(a.integer("seed"))), 3, 0}, context.seed);
        return std::make_shared<Cauliflower>(
            a.vector("center"), a.number("falloff"),
            withinBandLimit(
                Grower({a.vector("radii"), a.integer("scales"), a.integer("count"), a.number("ratio"),
                        a.number("jitter"), a.number("upward"), context.upAxis, seed})
                    .grow(),
                context));
      },
      validateCauliflower};
}

}  // namespace nephele
