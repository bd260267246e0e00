// Where a camera ray scatters first: everything along the ray that may scatter is listed with its share of
// the light, and one is chosen. Depends on preview/truth alone.
#include <algorithm>
#include <type_traits>
#include <vector>

#include "preview/truth/along_ray.h"
#include "preview/truth/walk_cells.h"

namespace nephele::truth {
namespace {

using glm::vec3;

/// A piece of the ray that scatters by its control, or (t0 = t1) a look that found more than the control.
template <class Value>
struct Event {
  float until;  // masses up to and with this one; a mass is the share of the light that scatters here, mean
                // over channels
  float t0, t1;
  const ControlCell* cell;
  Value transmittance;  // at t0
};

template <class Value>
class EventList {
 public:
  EventList(const TrackedMedium& medium, const TrackedRay& ray, Random& random, uint64_t& looks)
      : along_(medium, ray, random, looks), events_(storage()) {
    events_.clear();
    walkCells(medium.grid, ray,
              [&](const ControlCell& cell, float t0, float t1) { return cross(cell, t0, t1); });
  }

  FirstScattering choose(float u, float channel) {
    FirstScattering first;
    first.transmittance = vec3(transmittance_);
    if (!(mass_ > 0.0f)) return first;
    const float target = u * mass_;
    const auto found =
        std::upper_bound(events_.begin(), events_.end(), target,
                         [](float value, const Event<Value>& event) { return value < event.until; });
    const auto event = found == events_.end() ? std::prev(found) : found;
    const float before = event == events_.begin() ? 0.0f : std::prev(event)->until;
    const float within = std::min((target - before) / (event->until - before), kBelowOne);
    first.found = true;
    place(*event, within, channel, first);
    return first;
  }

 private:
  static constexpr float kBelowOne = 0x1.fffffep-1f;

  /// One list a thread: rays come by the million.
  static std::vector<Event<Value>>& storage() {
    thread_local std::vector<Event<Value>> events;
    return events;
  }

  void add(float mass, float t0, float t1, const ControlCell& cell) {
    if (!(mass > 0.0f)) return;
    mass_ += mass;
    events_.push_back({mass_, t0, t1, &cell, transmittance_});
  }

  /// Scattering by the control over [t0, t1].
  void addPiece(const ControlCell& cell, float t0, float t1) {
    const Value depth = (cell.control * (t1 - t0)) * along_.sigma;
    add(meanOf(transmittance_ * absorbed(depth)), t0, t1, cell);
    transmittance_ *= exponential(-depth);
  }

  bool cross(const ControlCell& cell, float t0, float t1) {
    if (cell.smooth) {  // scatters by the control; looks correct what comes through
      addPiece(cell, t0, t1);
      along_.clock.cross(cell.residual, t0, t1, along_.random, [&](float t) {
        transmittance_ *= notNegative(Value(1.0f) - along_.excessAt(cell, t) * along_.sigma);
      });
    } else {  // looks are collisions with what exceeds the minimum
      along_.clock.cross(cell.residual, t0, t1, along_.random, [&](float t) {
        addPiece(cell, t0, t);
        const Value collides = std::max(along_.excessAt(cell, t), 0.0f) * along_.sigma;
        add(meanOf(transmittance_ * collides), t, t, cell);
        transmittance_ *= notNegative(Value(1.0f) - collides);
        t0 = t;
      });
      addPiece(cell, t0, t1);
    }
    const float counts = roulette(largest(transmittance_), along_.random);
    transmittance_ *= counts;
    return counts > 0.0f;
  }

  /// True transmittance over the control's from t0 to t in a smooth cell.
  Value correction(const Event<Value>& event, float t) {
    const ControlCell& cell = *event.cell;
    Value factor(1.0f);
    LookClock clock(along_.random);
    clock.cross(cell.residual, event.t0, t, along_.random, [&](float at) {
      factor *= notNegative(Value(1.0f) - along_.excessAt(cell, at) * along_.sigma);
    });
    return factor;
  }

  /// In a smooth cell: of a few places drawn from the control, one in each part, one by its true density
  /// (resampled importance sampling [Talbot et al. 2005]). `apart` becomes its distance from t0; returns the
  /// mean of true density over control.
  float placeByDensity(const Event<Value>& event, float within, float channel, float& apart) {
    constexpr int kPlaces = 4;
    float places[kPlaces], densities[kPlaces], sum = 0.0f;
    for (int i = 0; i < kPlaces; ++i) {
      places[i] = drawWithin(event, (static_cast<float>(i) + along_.random.uniform()) / kPlaces, channel);
      densities[i] = along_.densityAt(*event.cell, event.t0 + places[i]);
      sum += densities[i];
    }
    float rest = within * sum;  // in order of distance, so that even numbers stay even
    int chosen = 0;
    while (chosen + 1 < kPlaces && rest >= densities[chosen]) rest -= densities[chosen++];
    apart = places[chosen];
    return sum / (kPlaces * event.cell->control);
  }

  /// Distance from t0 at which the control scatters, drawn from the channels' mean.
  float drawWithin(const Event<Value>& event, float within, float channel) const {
    const float rate = event.cell->control, length = event.t1 - event.t0;
    if constexpr (std::is_same_v<Value, float>) {
      return std::min(-std::log1p(-within * absorbed(rate * length * along_.sigma)) / (rate * along_.sigma),
                      length);
    } else {
      const vec3 shares = event.transmittance * absorbed(rate * length * along_.sigma);
      float rest = channel * (shares.x + shares.y + shares.z);
      int c = 0;
      while (c < 2 && rest >= shares[c]) rest -= shares[c++];
      while (!(shares[c] > 0.0f)) --c;  // rounding may step beyond the last channel that scatters
      return std::min(
          -std::log1p(-within * absorbed(rate * length * along_.sigma[c])) / (rate * along_.sigma[c]),
          length);
    }
  }

  void place(const Event<Value>& event, float within, float channel, FirstScattering& first) {
    const bool isPiece = event.t1 > event.t0, smooth = event.cell->smooth;
    float apart = 0.0f, density = 1.0f;
    if (smooth)
      density = placeByDensity(event, within, channel, apart);
    else if (isPiece)
      apart = drawWithin(event, within, channel);
    first.distance = event.t0 + apart;
    first.position = along_.ray.origin + first.distance * along_.ray.direction;
    // Of the light that collides here, per channel, over the density with which the place was drawn.
    Value arrives = event.transmittance * along_.sigma;
    if (isPiece) arrives *= exponential((-event.cell->control * apart) * along_.sigma);
    const Value drawn = arrives * (density * mass_ / meanOf(arrives));
    const vec3 collides(smooth ? drawn * correction(event, first.distance) : drawn);
    first.taken = meanOf(collides);
    first.weight = collides * scatteredShare(along_.medium);
    first.absorbed = collides * absorbedShare(along_.medium);
  }

  AlongRay<Value> along_;
  std::vector<Event<Value>>& events_;
  Value transmittance_{1.0f};
  float mass_ = 0.0f;
};

}  // namespace

FirstScattering firstScattering(const TrackedMedium& medium, const TrackedRay& ray, float u, float channel,
                                Random& random, uint64_t& looks) {
  if (medium.grey) return EventList<float>(medium, ray, random, looks).choose(u, channel);
  return EventList<vec3>(medium, ray, random, looks).choose(u, channel);
}

}  // namespace nephele::truth
