// Pareto fronts. Depends on front.h alone.
#include "base/front.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nephele {

std::vector<size_t> paretoFront(const std::vector<CostAndError>& points, double leastGain) {
  std::vector<size_t> order(points.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::pair(points[a].cost, points[a].error) < std::pair(points[b].cost, points[b].error);
  });
  std::vector<size_t> front;
  for (const size_t i : order)
    if (front.empty() || points[i].error < (1.0 - leastGain) * points[front.back()].error) front.push_back(i);
  return front;
}

size_t kneeOf(const std::vector<CostAndError>& points, const std::vector<size_t>& front) {
  if (front.size() < 3) return 0;
  constexpr double kLeast = 1e-9;  // keeps an error of 0 on the axis
  const auto x = [&](size_t i) { return std::log(std::max(points[front[i]].cost, kLeast)); };
  const auto y = [&](size_t i) { return std::log(std::max(points[front[i]].error, kLeast)); };
  const size_t last = front.size() - 1;
  const double dx = x(last) - x(0), dy = y(last) - y(0);
  size_t knee = 0;
  double farthest = 0.0;
  for (size_t i = 1; i < last; ++i) {
    const double below = (x(i) - x(0)) * dy - (y(i) - y(0)) * dx;  // > 0 below the line, times its length
    if (below > farthest) {
      farthest = below;
      knee = i;
    }
  }
  return knee;
}

bool onFront(const std::vector<size_t>& front, size_t point) {
  return std::find(front.begin(), front.end(), point) != front.end();
}

bool isKnee(const std::vector<size_t>& front, size_t knee, size_t point) {
  return !front.empty() && front[knee] == point;
}

}  // namespace nephele
