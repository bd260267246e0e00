// The least point of a function of four numbers in the unit cube. Depends on nothing.
#pragma once

#include <array>
#include <cstddef>
#include <functional>

namespace nephele {

using UnitPoint = std::array<double, 4>;  // each in [0, 1]

/// The point in [0, 1]⁴ at which `cost` is least: Nelder and Mead (1965) from `start`, until the simplex is
/// smaller than `tolerance` along each axis or `most` evaluations are spent. What it costs outside is not
/// asked.
UnitPoint leastOf(const std::function<double(const UnitPoint&)>& cost, const UnitPoint& start,
                  double tolerance, size_t most);

/// The same from the three least points of a lattice of `side` points along each axis, so that a valley
/// beside the deepest one does not hold it. Meant for functions that cost little: `side`⁴ evaluations and 3
/// `most`.
UnitPoint leastOfCube(const std::function<double(const UnitPoint&)>& cost, int side, double tolerance,
                      size_t most);

}  // namespace nephele
