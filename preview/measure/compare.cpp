// Picture errors. Depends on base and nlohmann_json.
#include "preview/measure/compare.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "base/error.h"

namespace nephele {
namespace {

constexpr float kSeenAlpha = 1e-3f;
constexpr double kFloorShare =
    1e-3;  // of the reference's maximum: darker pairs count as if they were this bright
constexpr double kTailShare = 0.99;

const std::vector<float>& planeOf(const Picture& picture, const std::string& pictureName,
                                  const std::string& name) {
  const int at = picture.find(name);
  if (at < 0) throw InputError({pictureName}, "the picture has no channel '" + name + "'");
  const std::vector<float>& plane = picture.planes[static_cast<size_t>(at)];
  for (float value : plane)
    if (!std::isfinite(value))
      throw InputError({pictureName}, "channel '" + name + "' holds a value that is not finite");
  return plane;
}

double ratio(double numerator, double denominator) {
  if (numerator == 0.0) return 0.0;
  return denominator != 0.0 ? numerator / denominator
                            : std::copysign(std::numeric_limits<double>::infinity(), numerator);
}

/// Adds one channel's share to the means, and its relative pair errors to `pairs`.
void addChannel(const std::vector<float>& x, const std::vector<float>& r, const std::vector<size_t>& seen,
                Comparison& comparison, std::vector<double>& pairs, double floor) {
  constexpr double kChannels = 3.0;
  double squares = 0.0, differences = 0.0, sum = 0.0;
  for (size_t i : seen) {
    const double difference = double{x[i]} - double{r[i]};
    squares += difference * difference;
    differences += difference;
    sum += double{r[i]};
    const double scale = std::max({std::abs(double{x[i]}), std::abs(double{r[i]}), floor});
    pairs.push_back(ratio(std::abs(difference), scale));
  }
  const double count = static_cast<double>(seen.size());
  comparison.relativeRmse += ratio(std::sqrt(squares / count), std::abs(sum / count)) / kChannels;
  comparison.bias += ratio(differences / count, std::abs(sum / count)) / kChannels;
}

Comparison plainComparison(const Picture& picture, const std::string& pictureName, const Picture& reference,
                           const std::string& referenceName) {
  if (picture.width != reference.width || picture.height != reference.height)
    throw InputError({pictureName}, "the picture is " + std::to_string(picture.width) + "x" +
                                        std::to_string(picture.height) + " pixels and '" + referenceName +
                                        "' is " + std::to_string(reference.width) + "x" +
                                        std::to_string(reference.height));
  const std::vector<size_t> seen = seenPixels(picture, reference);
  Comparison comparison;
  comparison.pixels = seen.size();
  double brightest = 0.0;
  for (const char* name : {"R", "G", "B"})
    for (float value : planeOf(reference, referenceName, name))
      brightest = std::max(brightest, std::abs(double{value}));
  std::vector<double> pairs;
  for (const char* name : {"R", "G", "B"}) {
    const std::vector<float>& x = planeOf(picture, pictureName, name);
    if (!seen.empty())
      addChannel(x, planeOf(reference, referenceName, name), seen, comparison, pairs,
                 kFloorShare * brightest);
  }
  if (pairs.empty()) return comparison;
  std::sort(pairs.begin(), pairs.end());
  comparison.p99 = pairs[static_cast<size_t>(kTailShare * static_cast<double>(pairs.size() - 1))];
  comparison.maximum = pairs.back();
  return comparison;
}

}  // namespace

std::vector<size_t> seenPixels(const Picture& a, const Picture& b) {
  const int alphaA = a.find("A"), alphaB = b.find("A");
  const size_t count = static_cast<size_t>(a.width) * static_cast<size_t>(a.height);
  std::vector<size_t> seen;
  for (size_t i = 0; i < count; ++i) {
    const bool inA = alphaA < 0 || a.planes[static_cast<size_t>(alphaA)][i] > kSeenAlpha;
    const bool inB = alphaB < 0 || b.planes[static_cast<size_t>(alphaB)][i] > kSeenAlpha;
    if (inA || inB) seen.push_back(i);
  }
  return seen;
}

bool hasHalves(const Picture& picture) {
  return picture.find("half1.R") >= 0 && picture.find("half2.B") >= 0;
}

Comparison comparePictures(const Picture& picture, const std::string& pictureName, const Picture& reference,
                           const std::string& referenceName) {
  Comparison comparison = plainComparison(picture, pictureName, reference, referenceName);
  if (hasHalves(reference)) comparison.relativeRmse = compareWithHalves(picture, reference).relativeRmse;
  return comparison;
}

NoisyError compareWithHalves(const Picture& picture, const Picture& reference) {
  const Comparison plain = plainComparison(picture, "picture", reference, "reference");
  NoisyError error;
  error.bias = plain.bias;
  error.p99 = plain.p99;
  const std::vector<size_t> seen = seenPixels(picture, reference);
  if (seen.empty()) return error;
  const double count = static_cast<double>(seen.size());
  // Squares relative to the channel's mean, pixel by pixel, averaged over channels.
  std::vector<double> squares(seen.size());
  for (const std::string name : {"R", "G", "B"}) {
    const std::vector<float>& x = planeOf(picture, "picture", name);
    const std::vector<float>& a = planeOf(reference, "reference", "half1." + name);
    const std::vector<float>& b = planeOf(reference, "reference", "half2." + name);
    double mean = 0.0;
    for (const size_t i : seen) mean += 0.5 * (double{a[i]} + double{b[i]}) / count;
    if (!(mean > 0.0)) continue;  // a black channel has no relative error
    for (size_t k = 0; k < seen.size(); ++k) {
      const size_t i = seen[k];
      squares[k] += (double{x[i]} - double{a[i]}) * (double{x[i]} - double{b[i]}) / (3.0 * mean * mean);
    }
  }
  double mean = 0.0, variance = 0.0;
  for (const double square : squares) mean += square / count;
  for (const double square : squares) variance += (square - mean) * (square - mean) / count;
  constexpr double kInterval = 1.96;  // standard deviations of a normal mean
  const double apart = kInterval * std::sqrt(variance / count);
  error.relativeRmse = std::sqrt(std::max(mean, 0.0));
  error.low = std::sqrt(std::max(mean - apart, 0.0));
  error.high = std::sqrt(std::max(mean + apart, 0.0));
  return error;
}

std::string comparisonAsText(const Comparison& comparison) {
  std::ostringstream out;
  out << "relative RMSE " << comparison.relativeRmse << ", bias " << comparison.bias << ", p99 "
      << comparison.p99 << ", max " << comparison.maximum << " over " << comparison.pixels << " pixels\n";
  return out.str();
}

std::string comparisonAsJson(const Comparison& comparison) {
  // JSON has no infinity: such a figure becomes null.
  return nlohmann::ordered_json{{"pixels", comparison.pixels},
                                {"relative_rmse", comparison.relativeRmse},
                                {"bias", comparison.bias},
                                {"p99", comparison.p99},
                                {"max", comparison.maximum}}
             .dump(2) +
         "\n";
}

}  // namespace nephele
