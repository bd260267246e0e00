// Every row of the field table in its variants, and values of a field here and there: what must be equal in
// every bit on every machine. Depends on field_samples.h.
#pragma once

#include "tests/bake/field_samples.h"

namespace nephele::test {

struct Variant {
  std::string name;
  FieldPtr field;
};

/// The row with its defaults, and once more for each choice of a parameter, for a period and for evolving.
inline std::vector<Variant> variantsOf(const FieldRow& row) {
  const BuildContext context{0.01, 2, 7, nullptr, 1.5};
  std::vector<Variant> variants{{std::string(row.name), makeField(std::string(row.name), {}, context)}};
  const auto add = [&](const std::string& name, const std::string& shown, const Value& value) {
    variants.push_back({std::string(row.name) + " " + name + " " + shown,
                        makeField(std::string(row.name), {{name, value}}, context)});
  };
  for (const Parameter& parameter : row.parameters) {
    const std::string name(parameter.name);
    for (const std::string& choice : parameter.choices) add(name, choice, choice);
    if (name == "period") add(name, "3", int64_t{3});
    if (name == "evolve") add(name, "0.7", 0.7);
  }
  return variants;
}

/// Blocks from a tenth of the samples' voxels to a fifth of a unit a voxel, near and far; each on its lattice
/// and at its points, in whole vectors and not.
inline std::vector<float> valuesOf(const Field& field) {
  std::vector<float> all;
  float values[kBlockPoints];
  for (const double spacing : {0.0011, 0.013, 0.17})
    for (const double far : {0.0, 1e6})
      for (int n = 0; n < 6; ++n) {
        const Lattice lattice{glm::dvec3(0.37 * n - 1.1 + far, 0.23 * n - 0.9, 0.6 - 0.31 * n - far),
                              spacing};
        field.evaluate(lattice, values);
        all.insert(all.end(), values, values + kBlockPoints);
        const LatticePoints block(lattice);
        Points points = block.points();
        points.count -= size_t(n);
        field.evaluate(points, values);
        all.insert(all.end(), values, values + points.count);
      }
  return all;
}

}  // namespace nephele::test
