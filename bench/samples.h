// Fields by name, for benchmarks. Depends on the table.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bake/field_examples.h"
#include "bake/fields/table.h"

namespace nephele::bench {

/// The row of that name with what is given and its defaults elsewhere, for voxels of `voxelSize`.
inline FieldPtr makeField(const std::string& name, std::map<std::string, Value, std::less<>> given,
                          double voxelSize = 1.0) {
  BuildContext context;
  context.voxelSize = voxelSize;
  const FieldRow* const row = findField(name);
  NEPHELE_CHECK_EQ(row != nullptr ? name : std::string("no such field"), name);
  for (const Parameter& parameter : row->parameters)
    if (parameter.fallback) given.emplace(parameter.name, *parameter.fallback);
  return row->build(Arguments(std::move(given)), context);
}

inline FieldPtr constant(double value) { return makeField("constant", {{"value", value}}); }

/// Row `name` over a list of inputs.
inline FieldPtr fold(const std::string& name, std::vector<FieldPtr> inputs) {
  return makeField(name, {{"inputs", std::move(inputs)}});
}

}  // namespace nephele::bench
