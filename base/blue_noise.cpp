// Void and cluster: the points of a binary pattern are ranked by how crowded they are. Depends on base.
#include "base/blue_noise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/error.h"

namespace nephele {
namespace {

constexpr int kReach = 6;  // beyond, the Gaussian is below 4e-4
constexpr double kDeviation = 1.5;

/// A binary pattern on a torus and, at every place, the sum of the Gaussians of its points.
class Pattern {
 public:
  explicit Pattern(int edge)
      : edge_(edge), points_(size_t(edge) * size_t(edge), 0), crowding_(points_.size(), 0) {
    for (int y = -kReach; y <= kReach; ++y)
      for (int x = -kReach; x <= kReach; ++x)
        // Whole numbers: sums then do not depend on the order of changes.
        kernel_.push_back(std::lround(kOne * std::exp(-(x * x + y * y) / (2.0 * kDeviation * kDeviation))));
    for (int row = 0; row < edge_; ++row) extremes_.push_back(extremesOf(row));
  }

  void set(size_t at, bool point) {
    points_[at] = point;
    const int x0 = static_cast<int>(at) % edge_, y0 = static_cast<int>(at) / edge_;
    size_t k = 0;
    for (int y = -kReach; y <= kReach; ++y)
      for (int x = -kReach; x <= kReach; ++x, ++k) {
        const int wx = (x0 + x + edge_) % edge_, wy = (y0 + y + edge_) % edge_;
        crowding_[static_cast<size_t>(wy * edge_ + wx)] += point ? kernel_[k] : -kernel_[k];
      }
    for (int y = -kReach; y <= kReach; ++y) {
      const int row = (y0 + y + edge_) % edge_;
      extremes_[static_cast<size_t>(row)] = extremesOf(row);
    }
  }

  /// The point in the thickest crowd, or the free place in the widest void.
  size_t tightest() const { return extreme(&Extremes::tightest, 1); }
  size_t widest() const { return extreme(&Extremes::widest, -1); }
  size_t size() const { return points_.size(); }
  bool has(size_t at) const { return points_[at]; }

 private:
  /// Of one row; points_.size() where it has no such place. Rows change seldom: most are looked up.
  struct Extremes {
    size_t tightest = 0, widest = 0;
  };

  Extremes extremesOf(int row) const {
    const size_t edge = static_cast<size_t>(edge_), first = static_cast<size_t>(row) * edge;
    const size_t none = points_.size();
    Extremes found{none, none};
    for (size_t i = first; i < first + edge; ++i) {
      size_t& best = points_[i] ? found.tightest : found.widest;
      const bool further =
          best == none || (points_[i] ? crowding_[i] > crowding_[best] : crowding_[i] < crowding_[best]);
      if (further) best = i;
    }
    return found;
  }

  size_t extreme(size_t Extremes::*which, int64_t sign) const {
    size_t best = points_.size();
    for (const Extremes& row : extremes_) {
      const size_t at = row.*which;
      if (at == points_.size()) continue;
      if (best == points_.size() || sign * crowding_[at] > sign * crowding_[best]) best = at;
    }
    return best;
  }

  static constexpr double kOne = 1e9;
  int edge_;
  std::vector<bool> points_;
  std::vector<int64_t> crowding_;
  std::vector<int64_t> kernel_;
  std::vector<Extremes> extremes_;  // per row
};

/// A tenth of all places, scattered by a recurrence and then moved from crowds into voids until that changes
/// nothing.
Pattern prototype(int edge) {
  Pattern pattern(edge);
  constexpr size_t kShare = 10;
  constexpr double kStep = 0.7548776662466927;  // 1/p, p³ = p + 1: an even start
  double at = 0.5;
  for (size_t placed = 0; placed < pattern.size() / kShare;) {
    at += kStep * kStep + kStep / static_cast<double>(edge);
    at -= std::floor(at);
    const size_t place = static_cast<size_t>(at * static_cast<double>(pattern.size()));
    if (pattern.has(place)) continue;
    pattern.set(place, true);
    ++placed;
  }
  for (size_t moves = 0; moves < pattern.size(); ++moves) {
    const size_t from = pattern.tightest();
    pattern.set(from, false);
    const size_t to = pattern.widest();
    pattern.set(to, true);
    if (to == from) break;
  }
  return pattern;
}

}  // namespace

std::vector<float> blueNoiseTile(int edge) {
  constexpr int kSmallest = 16;
  NEPHELE_CHECK_LE(kSmallest, edge);
  const Pattern start = prototype(edge);
  std::vector<size_t> rank(start.size());
  size_t points = 0;
  for (size_t i = 0; i < start.size(); ++i) points += start.has(i);
  Pattern fewer = start;
  for (size_t left = points; left > 0; --left) {
    const size_t place = fewer.tightest();
    fewer.set(place, false);
    rank[place] = left - 1;
  }
  Pattern more = start;
  for (size_t next = points; next < start.size(); ++next) {
    const size_t place = more.widest();
    more.set(place, true);
    rank[place] = next;
  }
  std::vector<float> tile(rank.size());
  for (size_t i = 0; i < rank.size(); ++i)
    tile[i] = (static_cast<float>(rank[i]) + 0.5f) / static_cast<float>(rank.size());
  return tile;
}

}  // namespace nephele
