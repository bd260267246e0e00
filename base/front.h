// What is worth its cost: the Pareto front of costs and errors, and its knee. Depends on nothing.
#pragma once

#include <cstddef>
#include <vector>

namespace nephele {

struct CostAndError {
  double cost = 0.0, error = 0.0;
};

/// What a dearer point has to take off the error, as a share of it, to be shown on a chart's front: less is
/// not worth naming.
inline constexpr double kWorthNaming = 0.02;

/// Indices of the points that no other beats in both, by growing cost and falling error. Of equal points the
/// first stands for all; one joins if it errs by more than the share `leastGain` less than the one before it.
std::vector<size_t> paretoFront(const std::vector<CostAndError>& points, double leastGain = 0.0);

/// The place in `front` of the point farthest below the line between its ends, on logarithmic axes; 0 where
/// the front has no points between its ends.
size_t kneeOf(const std::vector<CostAndError>& points, const std::vector<size_t>& front);

/// Whether a point is on a front, and whether it is the one at `knee` on it.
bool onFront(const std::vector<size_t>& front, size_t point);
bool isKnee(const std::vector<size_t>& front, size_t knee, size_t point);

}  // namespace nephele
