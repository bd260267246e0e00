// Where a camera ray scatters first: everything along the ray that may scatter is listed with its share of
// the light, and one is chosen. Depends on preview/truth alone.
#include <algorithm>
#include <type_traits>
#include <vector>

#include "preview/truth/channels.h"
#include "preview/truth/looks.h"
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
      : medium_(medium),
        ray_(ray),
        random_(random),
        looks_(looks),
        sigma_(extinction<Value>(medium)),
        clock_(random),
        events_(storage()) {
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
    const Value depth = (cell.control * (t1 - t0)) * sigma_;
    add(meanOf(transmittance_ * absorbed(depth)), t0, t1, cell);
    transmittance_ *= exponential(-depth);
  }

  bool cross(const ControlCell& cell, float t0, float t1) {
    const auto excessAt = [&](float t) {
      ++looks_;
      return (densityIn(medium_, cell, ray_.origin + t * ray_.direction) - cell.control) / cell.residual;
    };
    if (cell.smooth) {  // scatters by the control; looks correct what comes through
      addPiece(cell, t0, t1);
      clock_.cross(cell.residual, t0, t1, random_,
                   [&](float t) { transmittance_ *= notNegative(Value(1.0f) - excessAt(t) * sigma_); });
    } else {  // looks are collisions with what exceeds the minimum
      clock_.cross(cell.residual, t0, t1, random_, [&](float t) {
        addPiece(cell, t0, t);
        const Value collides = std::max(excessAt(t), 0.0f) * sigma_;
        add(meanOf(transmittance_ * collides), t, t, cell);
        transmittance_ *= notNegative(Value(1.0f) - collides);
        t0 = t;
      });
      addPiece(cell, t0, t1);
    }
    const float counts = roulette(largest(transmittance_), random_);
    transmittance_ *= counts;
    return counts > 0.0f;
  }

  float densityAtT(const ControlCell& cell, float t) {
    ++looks_;
    return densityIn(medium_, cell, ray_.origin + t * ray_.direction);
  }

  /// True transmittance over the control's from t0 to t in a smooth cell.
  Value correction(const Event<Value>& event, float t) {
    const ControlCell& cell = *event.cell;
    Value factor(1.0f);
    LookClock clock(random_);
    clock.cross(cell.residual, event.t0, t, random_, [&](float at) {
      factor *= notNegative(Value(1.0f) - (densityAtT(cell, at) - cell.control) / cell.residual * sigma_);
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
      places[i] = drawWithin(event, (static_cast<float>(i) + random_.uniform()) / kPlaces, channel);
      densities[i] = densityAtT(*event.cell, event.t0 + places[i]);
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
      return std::min(-std::log1p(-within * absorbed(rate * length * sigma_)) / (rate * sigma_), length);
    } else {
      const vec3 shares = event.transmittance * absorbed(rate * length * sigma_);
      float rest = channel * (shares.x + shares.y + shares.z);
      int c = 0;
      while (c < 2 && rest >= shares[c]) rest -= shares[c++];
      while (!(shares[c] > 0.0f)) --c;  // rounding may step beyond the last channel that scatters
      return std::min(-std::log1p(-within * absorbed(rate * length * sigma_[c])) / (rate * sigma_[c]),
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
    first.position = ray_.origin + first.distance * ray_.direction;
    // Of the light that collides here, per channel, over the density with which the place was drawn.
    Value arrives = event.transmittance * sigma_;
    if (isPiece) arrives *= exponential((-event.cell->control * apart) * sigma_);
    const Value drawn = arrives * (density * mass_ / meanOf(arrives));
    vec3 collides(smooth ? drawn * correction(event, first.distance) : drawn);
    first.taken = meanOf(collides);
    for (int c = 0; c < 3; ++c)
      collides[c] *= medium_.sigmaT[c] > 0.0f ? medium_.sigmaS[c] / medium_.sigmaT[c] : 0.0f;
    first.weight = collides;
  }

  const TrackedMedium& medium_;
  const TrackedRay& ray_;
  Random& random_;
  uint64_t& looks_;
  Value sigma_;
  LookClock clock_;
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
