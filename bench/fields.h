// Fields made from the table for benchmarks. Depends on the table alone.
#pragma once

#include <string>

#include "bake/fields/table.h"
#include "bench/sample_files.h"

namespace nephele::bench {

/// The row at its defaults; required child fields are fBm, lists a sphere and fBm.
inline FieldPtr fieldForBench(const std::string& name, double voxelSize) {
  const FieldRow* row = findField(name);
  NEPHELE_CHECK_EQ(row != nullptr, true);
  std::map<std::string, Value, std::less<>> values;
  for (const Parameter& parameter : row->parameters) {
    if (parameter.fallback)
      values.emplace(parameter.name, *parameter.fallback);
    else if (parameter.type == ParameterType::file)
      values.emplace(parameter.name, InputFile{sampleFile(name), {}});
    else if (parameter.type == ParameterType::field)
      values.emplace(parameter.name, fieldForBench("fbm", voxelSize));
    else if (parameter.type == ParameterType::fields)
      values.emplace(parameter.name, std::vector<FieldPtr>{fieldForBench("sphere", voxelSize),
                                                           fieldForBench("fbm", voxelSize)});
  }
  return row->build(Arguments(std::move(values)), {voxelSize, 2, 0, nullptr});
}

}  // namespace nephele::bench
