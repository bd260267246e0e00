// Orders at nodes, and their squares. Depends on what its header names.
#include "preview/measure/octave_form.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "preview/measure/compare.h"

namespace nephele {
namespace {

// Shares of extinction 1, ½, … 2^-(kHalvings): below the last, columns of 10^3 optical depths are all seen
// through, and the order is linear in the share.
constexpr int kHalvings = 12;
constexpr int kShares = kHalvings + 2;  // and 0
constexpr int kLobes = 6;
constexpr size_t kNodes = size_t{kShares} * kLobes;
constexpr int kCubic = 4;  // points of a cubic
constexpr size_t kChannels = 3;

double shareAt(int node) { return node <= kHalvings ? std::exp2(-node) : 0.0; }

/// Chebyshev–Lobatto, from 0 to 1.
double lobeAt(int node) { return 0.5 - 0.5 * std::cos(std::numbers::pi * node / (kLobes - 1)); }

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

/// Radiance of one pixel and channel at every node: light through each share of the extinction, scattered
/// by each lobe.
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
    for (int node = 0; node < kShares; ++node) even_.push_back(drawn(shareAt(node), 0.0));
    for (int node = 0; node < kLobes; ++node) unshaded_.push_back(drawn(0.0, lobeAt(node)));
  }

  const Picture& first() const { return first_; }

  AtNodes at(size_t channel, size_t pixel) const {
    const auto added = [&](const Picture& picture) {
      return double{picture.planes[channel][pixel]} - double{first_.planes[channel][pixel]};
    };
    AtNodes nodes{};
    const double reached = added(unshaded_.front());  // by the even lobe, c = 0
    if (!(reached > 0.0)) return nodes;
    for (int lobe = 0; lobe < kLobes; ++lobe) {
      const double turned = added(unshaded_[static_cast<size_t>(lobe)]) / reached;
      for (int share = 0; share < kShares; ++share)
        nodes[static_cast<size_t>(share * kLobes + lobe)] = turned * added(even_[static_cast<size_t>(share)]);
    }
    return nodes;
  }

 private:
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
  std::vector<Picture> even_, unshaded_;
};

/// What `count` orders beyond the first weigh at each node.
std::vector<double> nodeWeights(const OctaveFactors& factors, int count) {
  std::vector<double> weights(kNodes, 0.0);
  double a = 1.0, b = 1.0, c = 1.0;
  for (int order = 0; order <= count; ++order) {
    const std::array<double, kShares> shares = shareWeights(a);
    const std::array<double, kLobes> lobes = lobeWeights(c);
    for (size_t share = 0; share < shares.size(); ++share)
      for (size_t lobe = 0; lobe < lobes.size(); ++lobe)
        weights[share * kLobes + lobe] += b * shares[share] * lobes[lobe];
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
        form.mixed_[n] += 0.5 * scale * x[n] * (double{one[i]} + double{two[i]});
        for (size_t m = 0; m < kNodes; ++m) form.squares_[n * kNodes + m] += scale * x[n] * x[m];
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
    for (size_t m = 0; m < kNodes; ++m) row += squares_[n * kNodes + m] * weights[m];
    sum += weights[n] * (row - 2.0 * mixed_[n]);
  }
  return sum;
}

}  // namespace nephele
