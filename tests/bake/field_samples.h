// Fields made from the table for tests: every row with its defaults, child fields filled with noise and
// shapes, files with samples, so that a new row is tested without a new line here.
#pragma once

#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bake/field_examples.h"
#include "bake/fields/table.h"

namespace nephele::test {

inline FieldPtr makeField(const std::string& name, std::map<std::string, Value, std::less<>> given = {},
                          const BuildContext& context = {0.01, 2, 0, nullptr}) {
  const FieldRow* row = findField(name);
  NEPHELE_CHECK_EQ(row != nullptr ? name : std::string("no such field"), name);
  for (const Parameter& parameter : row->parameters) {
    if (given.contains(parameter.name)) continue;
    if (parameter.fallback) {
      given.emplace(parameter.name, *parameter.fallback);
    } else if (parameter.type == ParameterType::file) {
      given.emplace(parameter.name, InputFile{examples::sampleFile(name), {}});
    } else if (parameter.type == ParameterType::field) {
      given.emplace(parameter.name,
                    makeField("fbm", {{"cell_size", 0.7}, {"seed", int64_t(parameter.name.size())}}));
    } else if (parameter.type == ParameterType::fields) {
      given.emplace(parameter.name, std::vector<FieldPtr>{makeField("sphere", {{"radius", 0.9}}),
                                                          makeField("perlin", {{"cell_size", 0.3}}),
                                                          makeField("constant", {{"value", 0.25}})});
    }
  }
  return row->build(Arguments(std::move(given)), context);
}

/// The names of all rows, in the table's order.
inline std::vector<std::string> fieldNames() {
  std::vector<std::string> list;
  for (const FieldRow& row : fieldTable()) list.emplace_back(row.name);
  return list;
}

/// A place in the cube that reaches as far as `reach` on either side of the origin.
inline glm::dvec3 randomPoint(std::mt19937_64& random, double reach) {
  std::uniform_real_distribution<double> place(-reach, reach);
  return {place(random), place(random), place(random)};
}

/// Random points of a box, as offsets from its low corner.
template <size_t kCount>
struct PointsInBox {
  float x[kCount], y[kCount], z[kCount];

  PointsInBox(std::mt19937_64& random, const glm::dvec3& size) {
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (size_t n = 0; n < kCount; ++n) {
      x[n] = float(size.x) * unit(random);
      y[n] = float(size.y) * unit(random);
      z[n] = float(size.z) * unit(random);
    }
  }
  Points from(const glm::dvec3& low) const { return {low, kCount, x, y, z}; }
};

inline float valueAt(const Field& field, const glm::dvec3& p) {
  const float zero = 0.0f;
  float value = 0.0f;
  field.evaluate(Points{p, 1, &zero, &zero, &zero}, &value);
  return value;
}

}  // namespace nephele::test
