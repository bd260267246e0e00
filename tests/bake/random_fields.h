// Fields with random parameters, drawn from the table alone: any size, any distance from the origin, nested.
// A new row is drawn without a new line here. Depends on field_samples.h.
#pragma once

#include <cmath>
#include <random>

#include "tests/bake/field_samples.h"

namespace nephele::test {

/// Where a field lies and how large it is: `size` world units stand for one of the table's defaults.
struct World {
  glm::dvec3 centre{0.0};
  double size = 1.0;
};

class FieldDrawer {
 public:
  explicit FieldDrawer(uint64_t seed) : random_(seed) {}

  /// Sizes from 1e-6 to 1e6 world units, about the origin or up to 1e7 away from it.
  World drawWorld() {
    World world;
    world.size = std::pow(10.0, double(3 * whole(-2, 2)));
    const double far = oneIn(3) ? 1e7 : oneIn(2) ? 100.0 * world.size : 0.0;
    world.centre = far * glm::dvec3(between(-1, 1), between(-1, 1), between(-1, 1));
    return world;
  }

  /// The row with random parameters that go together, in that world.
  FieldPtr draw(const std::string& name, const World& world) {
    world_ = world;
    context_ = {world.size * std::pow(10.0, between(-2.5, -0.5)), whole(1, 2), uint32_t(random_()), nullptr,
                between(0.0, 10.0)};
    return drawRow(name, 0);
  }

  /// 10^-3 … 10 across, mostly within two of the world's centre; one in four flat along an axis or more.
  Box drawBox() {
    const double size = std::pow(10.0, between(-3.0, 1.0)) * world_.size;
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
      const double centre = world_.centre[axis] + world_.size * between(-2.0, 2.0);
      const double half = oneIn(10) ? 0.0 : 0.5 * size * between(0.1, 1.0);
      box.low[axis] = centre - half;
      box.high[axis] = centre + half;
    }
    return box;
  }

  double between(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  int whole(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
  bool oneIn(int n) { return whole(1, n) == 1; }

 private:
  FieldPtr drawRow(const std::string& name, int depth) {
    const FieldRow* const row = findField(name);
    NEPHELE_CHECK_EQ(row != nullptr ? name : std::string("no such field"), name);
    constexpr int kTries = 1000;
    for (int n = 0; n < kTries; ++n) {
      std::map<std::string, Value, std::less<>> values;
      for (const Parameter& parameter : row->parameters)
        values.emplace(parameter.name, drawValue(*row, parameter, depth));
      Arguments arguments(std::move(values));
      if (row->validate == nullptr || !row->validate(arguments)) return row->build(arguments, context_);
    }
    throw std::runtime_error(name + ": no parameters go together");
  }

  Value drawValue(const FieldRow& row, const Parameter& parameter, int depth) {
    switch (parameter.type) {
      case ParameterType::number:
        // The one length that goes by another unit: world units for one of a mesh's own.
        if (row.name == "mesh" && parameter.name == "scale") return world_.size * between(0.3, 3.0);
        return number(parameter, std::get<double>(*parameter.fallback), context_.upAxis);
      case ParameterType::integer:
        return integer(parameter);
      case ParameterType::choice:
        return parameter.choices[size_t(whole(0, int(parameter.choices.size()) - 1))];
      case ParameterType::pair: {
        auto pair = std::get<std::array<double, 2>>(*parameter.fallback);
        for (int n = 0; n < 2; ++n)  // along the ground
          pair[size_t(n)] = number(parameter, pair[size_t(n)], n == 0 ? 0 : 3 - context_.upAxis);
        return pair;
      }
      case ParameterType::vector:
        return vector(parameter);
      case ParameterType::curve:
        return curve();
      case ParameterType::file:
        return InputFile{examples::sampleFile(row.name), {}};
      case ParameterType::field:
        return child(depth);
      case ParameterType::fields:
        break;
    }
    std::vector<FieldPtr> list;
    for (int n = whole(1, 3); n > 0; --n) list.push_back(child(depth));
    return list;
  }

  /// A length that may have either sign is a place along `axis`; one that is never negative is a size.
  double number(const Parameter& parameter, double fallback, int axis) {
    const Range& range = parameter.range;
    const bool length = parameter.unit.starts_with("world units");
    if (length && range.low < 0.0 && std::isfinite(range.low))  // a speed; one in ten far too fast
      return oneIn(2) ? fallback : between(-1.0, 1.0) * (oneIn(10) ? range.high : world_.size);
    if (std::isfinite(range.low) && std::isfinite(range.high))
      return oneIn(2) ? fallback : between(range.low, range.high);
    if (std::isfinite(range.low)) {
      if (!range.lowOpen && oneIn(6)) return range.low;
      return fallback * std::pow(10.0, between(-0.7, 0.5)) * (length ? world_.size : 1.0);
    }
    if (parameter.unit == "world units")
      return world_.centre[axis] + world_.size * (fallback + between(-0.5, 0.5));
    return oneIn(6) ? 0.0 : oneIn(3) ? fallback : between(-2.0, 2.0);
  }

  int64_t integer(const Parameter& parameter) {
    const int64_t fallback = std::get<int64_t>(*parameter.fallback);
    if (parameter.range.low < 0.0) return int64_t(uint32_t(random_()));  // seeds
    if (oneIn(4)) return fallback;
    constexpr double kFew = 3.0;
    return whole(int(parameter.range.low), int(std::min(parameter.range.high, parameter.range.low + kFew)));
  }

  std::array<double, 3> vector(const Parameter& parameter) {
    auto v = std::get<std::array<double, 3>>(*parameter.fallback);
    const bool direction = parameter.unit.empty() && !std::isfinite(parameter.range.low);
    if (direction && oneIn(2)) {  // none, or along an axis
      const double length = double(whole(-1, 1));
      v[size_t(whole(0, 2))] = length;
      return v;
    }
    for (int axis = 0; axis < 3; ++axis) v[size_t(axis)] = number(parameter, v[size_t(axis)], axis);
    return v;
  }

  Curve curve() {
    Curve points;
    double x = between(-0.5, 0.5);
    for (int n = whole(1, 5); n > 0; --n, x += between(0.001, 0.5))
      points.push_back({x, oneIn(3) ? 0.0 : between(-1.0, 2.0)});
    return points;
  }

  FieldPtr child(int depth) {
    constexpr const char* kLeaves[] = {"sphere", "ellipsoid", "plane",  "constant",
                                       "linear", "perlin",    "worley", "fbm"};
    constexpr const char* kNodes[] = {"add", "multiply",     "warp",      "remap",
                                      "mix", "smooth_union", "difference"};
    if (depth < 1 && oneIn(3)) return drawRow(kNodes[whole(0, int(std::size(kNodes)) - 1)], depth + 1);
    return drawRow(kLeaves[whole(0, int(std::size(kLeaves)) - 1)], depth + 1);
  }

  std::mt19937_64 random_;
  World world_;
  BuildContext context_;
};

}  // namespace nephele::test
