// Fields made from the table for tests: every row with its defaults, child fields filled with noise and
// shapes, files with samples, so that a new row is tested without a new line here.
#pragma once

#include <map>
#include <memory>
#include <string>

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

inline float valueAt(const Field& field, const glm::dvec3& p) {
  const float zero = 0.0f;
  float value = 0.0f;
  field.evaluate(Points{p, 1, &zero, &zero, &zero}, &value);
  return value;
}

}  // namespace nephele::test
