// Orders at nodes, and their squares. Depends on what its header names.
#include "preview/measure/octave_form.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "preview/measure/compare.h"

namespace nephele {
namespace {

// Shares of extinction 1, ½, … 2^-(kHalvings): below the last, columns of 10^3 optical depths are all seen
// through, and the order is linear in the share.
constexpr int kHalvings = 12;
constexpr int kShares = kHalvings + 2;  // and 0
constexpr int kLobes = 6;
constexpr int kDoublings = 4;
constexpr int kClosed = kDoublings + 2;  // powers 0, 1, 2, 4, 8 and 16 of what an open place leaves
constexpr size_t kNodes = size_t{kShares} * kLobes * kClosed;
constexpr int kCubic = 4;  // points of a cubic
constexpr size_t kChannels = 3;

double shareAt(int node) { return node <= kHalvings ? std::exp2(-node) : 0.0; }

/// Chebyshev–Lobatto, from 0 to 1.
double lobeAt(int node) { return 0.5 - 0.5 * std::cos(std::numbers::pi * node / (kLobes - 1)); }

size_t nodeOf(size_t share, size_t lobe, size_t closed) { return (share * kLobes + lobe) * kClosed + closed; }

/// Lagrange's weights at `x` of `count` nodes.
template <class Node>
void addLagrange(double x, int first, int count, const Node& nodeAt, double* weights) {
  for (int i = first; i < first + count; ++i) {
    double weight = 1.0;
    for (int j = first; j < first + count; ++j)
      if (j != i) weight *= (x - nodeAt(j)) / (nodeAt(i) - nodeAt(j));
    weights[i] += weight;
  }
}

std::array<double, kShares> shareWeights(double share) {
  std::array<double, kShares> weights{};
  const double least = shareAt(kHalvings);
  if (share < least) {
    weights[kHalvings] = share / least;
    weights[kHalvings + 1] = 1.0 - share / least;
    return weights;
  }
  const double place = std::min(-std::log2(share), double{kHalvings});
  const int first = std::clamp(static_cast<int>(place) - 1, 0, kHalvings + 1 - kCubic);
  addLagrange(
      place, first, kCubic, [](int node) { return static_cast<double>(node); }, weights.data());
  return weights;
}

std::array<double, kLobes> lobeWeights(double share) {
  std::array<double, kLobes> weights{};
  addLagrange(share, 0, kLobes, lobeAt, weights.data());
  return weights;
}

/// Adds the power `power` of what lies between 0 and 1: powers fall as light does through columns, so they
/// are interpolated alike.
void addPower(int power, double weight, std::array<double, kClosed>& weights) {
  if (power == 0) {
    weights[0] += weight;
    return;
  }
  const double place = std::log2(power);
  const int first = std::clamp(static_cast<int>(place) - 1, 0, kDoublings + 1 - kCubic);
  std::array<double, kClosed> cubic{};
  addLagrange(
      place, first, kCubic, [](int node) { return static_cast<double>(node); }, cubic.data() + 1);
  for (size_t i = 0; i < cubic.size(); ++i) weights[i] += weight * cubic[i];
}

/// (1 − d openness)^order = ((1 − d) + d (1 − openness))^order by powers of 1 − openness.
std::array<double, kClosed> closedWeights(double d, int order) {
  std::array<double, kClosed> weights{};
  double choices = 1.0;
  for (int power = 0; power <= order; ++power) {
    addPower(power, choices * std::pow(d, power) * std::pow(1.0 - d, order - power), weights);
    choices = choices * (order - power) / (power + 1);
  }
  return weights;
}

/// Radiance of one pixel and channel at every node: light through each share of the extinction, scattered
/// by each lobe, times each power of 1 − openness.
using AtNodes = std::array<double, kNodes>;

/// Pictures of one order: what a second order of given factors adds to the first.
class Orders {
 public:
  Orders(Method& march, const ViewedScene& view, const PictureRequest& request)
      : march_(march), view_(view), request_(request) {
    view_.scene.octaves.count = 0;
    PictureCost cost;
    first_ = march_.render(view_, request_, cost);
    view_.scene.octaves.count = 1;
    view_.scene.octaves.b = 1.0;
    view_.scene.octaves.d = 0.0;
    for (int node = 0; node < kShares; ++node) even_.push_back(drawn(shareAt(node), 0.0));
    for (int node = 0; node < kLobes; ++node) unshaded_.push_back(drawn(0.0, lobeAt(node)));
    view_.scene.octaves.d = 1.0;
    for (const int share : kClosedShares)
      for (int power = 1; power <= kMostPowerDrawn; power *= 2)
        closed_.push_back(drawnPower(shareAt(share), power));
  }

  const Picture& first() const { return first_; }

  AtNodes at(size_t channel, size_t pixel) const {
    const auto added = [&](const Picture& picture) {
      return double{picture.planes[channel][pixel]} - double{first_.planes[channel][pixel]};
    };
    AtNodes nodes{};
    const double reached = added(unshaded_.front());  // by the even lobe, c = 0
    if (!(reached > 0.0)) return nodes;
    std::array<double, kShares> even{};
    for (size_t share = 0; share < even.size(); ++share) even[share] = added(even_[share]);
    const auto left = leftAt(channel, pixel, even, reached);
    for (size_t lobe = 0; lobe < kLobes; ++lobe) {
      const double turned = added(unshaded_[lobe]) / reached;
      for (size_t share = 0; share < even.size(); ++share)
        for (size_t closed = 0; closed < kClosed; ++closed)
          nodes[nodeOf(share, lobe, closed)] = turned * even[share] * left[share][closed];
    }
    return nodes;
  }

 private:
  // Shares at which powers of 1 − openness are drawn; between them they leave of light what is mixed of both.
  static constexpr int kClosedShares[] = {0, 2, 4, 8, kShares - 1};
  static constexpr int kMostPowerDrawn = 8;
  static constexpr size_t kPowersDrawn = 4;  // 1, 2, 4, 8

  /// What each power of 1 − openness leaves of the light through each share.
  std::array<std::array<double, kClosed>, kShares> leftAt(size_t channel, size_t pixel,
                                                          const std::array<double, kShares>& even,
                                                          double reached) const {
    // Of light that hardly comes through, shares are rounding.
    constexpr double kLeastLight = 1e-6;
    const auto drawnAt = [&](size_t at) {
      std::array<double, kClosed> left{};
      left[0] = 1.0;
      const double whole = std::max(even[static_cast<size_t>(kClosedShares[at])], kLeastLight * reached);
      for (size_t power = 0; power < kPowersDrawn; ++power)
        left[power + 1] = std::clamp(
            double{closed_[at * kPowersDrawn + power].planes[channel][pixel]} / whole, 0.0, left[power]);
      const double eighth = left[kPowersDrawn], fourth = left[kPowersDrawn - 1];
      left[kPowersDrawn + 1] = fourth > 0.0 ? eighth * (eighth / fourth) * (eighth / fourth) : 0.0;
      return left;
    };
    std::array<std::array<double, kClosed>, kShares> all{};
    for (size_t at = 0; at + 1 < std::size(kClosedShares); ++at) {
      const auto from = drawnAt(at), to = drawnAt(at + 1);
      const int first = kClosedShares[at], last = kClosedShares[at + 1];
      for (int share = first; share <= last; ++share)
        for (size_t closed = 0; closed < kClosed; ++closed)
          all[static_cast<size_t>(share)][closed] =
              from[closed] + (to[closed] - from[closed]) * (share - first) / (last - first);
    }
    return all;
  }

  /// Light through a share of the extinction times a power of 1 − openness: the last of so many orders.
  Picture drawnPower(double share, int power) {
    const auto upTo = [&](int count) {
      view_.scene.octaves.count = count;
      return drawn(std::pow(share, 1.0 / power), 0.0);
    };
    Picture last = upTo(power);
    const Picture before = power > 1 ? upTo(power - 1) : first_;
    for (size_t channel = 0; channel < kChannels; ++channel)
      for (size_t i = 0; i < last.planes[channel].size(); ++i)
        last.planes[channel][i] -= before.planes[channel][i];
    return last;
  }

  Picture drawn(double a, double c) {
    view_.scene.octaves.a = a;
    view_.scene.octaves.c = c;
    PictureCost cost;
    return march_.render(view_, request_, cost);
  }

  Method& march_;
  ViewedScene view_;
  const PictureRequest& request_;
  Picture first_;
  std::vector<Picture> even_, unshaded_, closed_;
};

/// What `count` orders beyond the first weigh at each node.
std::vector<double> nodeWeights(const OctaveFactors& factors, int count) {
  std::vector<double> weights(kNodes, 0.0);
  double a = 1.0, b = 1.0, c = 1.0;
  for (int order = 0; order <= count; ++order) {
    const std::array<double, kShares> shares = shareWeights(a);
    const std::array<double, kLobes> lobes = lobeWeights(c);
    const std::array<double, kClosed> closed = closedWeights(factors[kOpenness], order);
    for (size_t share = 0; share < shares.size(); ++share)
      for (size_t lobe = 0; lobe < lobes.size(); ++lobe)
        for (size_t power = 0; power < closed.size(); ++power)
          weights[nodeOf(share, lobe, power)] += b * shares[share] * lobes[lobe] * closed[power];
    a *= factors[0];
    b *= factors[1];
    c *= factors[2];
  }
  return weights;
}

}  // namespace

OctaveForm::OctaveForm() : squares_(kNodes * kNodes, 0.0), mixed_(kNodes, 0.0) {}

OctaveForm OctaveForm::of(Method& march, const ViewedScene& view, const PictureRequest& request,
                          const Picture& truth) {
  static constexpr const char* kHalves[kChannels][2] = {
      {"half1.R", "half2.R"}, {"half1.G", "half2.G"}, {"half1.B", "half2.B"}};
  const Orders orders(march, view, request);
  const std::vector<size_t> seen = seenPixels(orders.first(), truth);
  OctaveForm form;
  for (size_t channel = 0; channel < kChannels; ++channel) {
    const auto half = [&](size_t which) -> const std::vector<float>& {
      return truth.planes[static_cast<size_t>(truth.find(kHalves[channel][which]))];
    };
    const std::vector<float>&one = half(0), &two = half(1);
    double sum = 0.0;
    for (const size_t i : seen) sum += 0.5 * (double{one[i]} + double{two[i]});
    if (!(sum > 0.0)) continue;  // a black channel has no relative error
    const double count = static_cast<double>(seen.size()), mean = sum / count,
                 scale = 1.0 / (static_cast<double>(kChannels) * count * mean * mean);
    for (const size_t i : seen) {
      const AtNodes x = orders.at(channel, i);
      form.constant_ += scale * double{one[i]} * double{two[i]};
      for (size_t n = 0; n < kNodes; ++n) {
        if (x[n] == 0.0) continue;
        form.mixed_[n] += 0.5 * scale * x[n] * (double{one[i]} + double{two[i]});
        for (size_t m = 0; m <= n; ++m) form.squares_[n * kNodes + m] += scale * x[n] * x[m];
      }
    }
  }
  return form;
}

void OctaveForm::add(const OctaveForm& other) {
  for (size_t i = 0; i < squares_.size(); ++i) squares_[i] += other.squares_[i];
  for (size_t i = 0; i < mixed_.size(); ++i) mixed_[i] += other.mixed_[i];
  constant_ += other.constant_;
}

double OctaveForm::at(const OctaveFactors& factors, int count) const {
  const std::vector<double> weights = nodeWeights(factors, count);
  double sum = constant_;
  for (size_t n = 0; n < kNodes; ++n) {
    if (weights[n] == 0.0) continue;
    double row = 0.0;
    for (size_t m = 0; m < n; ++m) row += squares_[n * kNodes + m] * weights[m];
    sum += weights[n] * (2.0 * row + squares_[n * kNodes + n] * weights[n] - 2.0 * mixed_[n]);
  }
  return sum;
}

}  // namespace nephele
