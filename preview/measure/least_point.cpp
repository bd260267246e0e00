// Nelder and Mead's simplex, and a lattice to start it from. Depends on least_point.h alone.
#include "preview/measure/least_point.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace nephele {

UnitPoint leastOf(const std::function<double(const UnitPoint&)>& cost, const UnitPoint& start,
                  double tolerance, size_t most) {
  struct Corner {
    UnitPoint at;
    double cost;
  };
  size_t spent = 0;
  const auto corner = [&](UnitPoint at) {
    for (double& factor : at) factor = std::clamp(factor, 0.0, 1.0);  // the nearest point of the cube
    ++spent;
    return Corner{at, cost(at)};
  };
  constexpr double kFirstEdge = 0.2;
  std::vector<Corner> simplex{corner(start)};
  for (size_t axis = 0; axis < start.size(); ++axis) {
    UnitPoint at = start;
    at[axis] += at[axis] > 0.5 ? -kFirstEdge : kFirstEdge;
    simplex.push_back(corner(at));
  }
  const auto byCost = [](const Corner& a, const Corner& b) { return a.cost < b.cost; };
  const auto spread = [&] {
    double widest = 0.0;
    for (size_t axis = 0; axis < start.size(); ++axis)
      for (const Corner& c : simplex) widest = std::max(widest, std::abs(c.at[axis] - simplex[0].at[axis]));
    return widest;
  };
  for (std::sort(simplex.begin(), simplex.end(), byCost); spent < most && spread() > tolerance;
       std::sort(simplex.begin(), simplex.end(), byCost)) {
    Corner& worst = simplex.back();
    UnitPoint middle{};
    for (size_t i = 0; i + 1 < simplex.size(); ++i)
      for (size_t axis = 0; axis < middle.size(); ++axis)
        middle[axis] += simplex[i].at[axis] / static_cast<double>(simplex.size() - 1);
    // From the worst corner through the middle of the others: 1 is its mirror image, −½ half-way back.
    const auto through = [&](double times) {
      UnitPoint at{};
      for (size_t axis = 0; axis < at.size(); ++axis)
        at[axis] = middle[axis] + times * (middle[axis] - worst.at[axis]);
      return corner(at);
    };
    const Corner mirrored = through(1.0);
    if (mirrored.cost < simplex[0].cost) {
      const Corner farther = through(2.0);
      worst = farther.cost < mirrored.cost ? farther : mirrored;
    } else if (mirrored.cost < simplex[simplex.size() - 2].cost) {
      worst = mirrored;
    } else {
      const Corner nearer = through(mirrored.cost < worst.cost ? 0.5 : -0.5);
      if (nearer.cost < std::min(worst.cost, mirrored.cost)) {
        worst = nearer;
        continue;
      }
      for (size_t i = 1; i < simplex.size(); ++i) {
        for (size_t axis = 0; axis < start.size(); ++axis)
          simplex[i].at[axis] = 0.5 * (simplex[i].at[axis] + simplex[0].at[axis]);
        simplex[i] = corner(simplex[i].at);
      }
    }
  }
  return simplex[0].at;
}

UnitPoint leastOfCube(const std::function<double(const UnitPoint&)>& cost, int side, double tolerance,
                      size_t most) {
  using Found = std::pair<double, UnitPoint>;
  std::vector<Found> lattice;
  const auto place = [side](int i) { return static_cast<double>(i) / (side - 1); };
  std::array<int, std::tuple_size_v<UnitPoint>> digits{};
  for (bool more = true; more;) {
    UnitPoint at{};
    std::transform(digits.begin(), digits.end(), at.begin(), place);
    lattice.emplace_back(cost(at), at);
    size_t axis = 0;
    while (axis < digits.size() && ++digits[axis] == side) digits[axis++] = 0;
    more = axis < digits.size();
  }
  std::sort(lattice.begin(), lattice.end());
  constexpr size_t kStarts = 3;
  Found best = lattice.front();
  for (size_t start = 0; start < std::min(kStarts, lattice.size()); ++start) {
    const UnitPoint at = leastOf(cost, lattice[start].second, tolerance, most);
    best = std::min(best, Found{cost(at), at});
  }
  return best.second;
}

}  // namespace nephele
