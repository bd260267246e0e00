// The table's rows in the order of the docs, and looking them up. Depends on table.h and rows.h.
#include "bake/fields/table.h"

#include "bake/fields/rows.h"

namespace nephele {

std::span<const FieldRow> fieldTable() {
  static const std::vector<FieldRow> kRows{
      perlinRow(),       worleyRow(),        perlinWorleyRow(), valueRow(),     fbmRow(),
      ridgedRow(),       billowRow(),        warpRow(),         transformRow(), curlRow(),
      sphereRow(),       ellipsoidRow(),     boxRow(),          capsuleRow(),   torusRow(),
      planeRow(),        meshRow(),          cauliflowerRow(),  constantRow(),  linearRow(),
      exponentialRow(),  heightProfileRow(), weatherMapRow(),   remapRow(),     addRow(),
      multiplyRow(),     minRow(),           maxRow(),          mixRow(),       unionRow(),
      intersectionRow(), differenceRow(),    smoothUnionRow()};
  return kRows;
}

const FieldRow* findField(std::string_view name) {
  for (const FieldRow& row : fieldTable())
    if (row.name == name) return &row;
  return nullptr;
}

const Parameter* listParameter(const FieldRow& row) {
  for (const Parameter& parameter : row.parameters)
    if (parameter.type == ParameterType::fields) return &parameter;
  return nullptr;
}

const Value& Arguments::at(std::string_view name) const {
  const auto found = values_.find(name);
  if (found == values_.end() && given_ == Given::some) throw Missing{};
  NEPHELE_CHECK_EQ(found != values_.end() ? name : std::string_view("no such parameter"), name);
  return found->second;
}

glm::dvec3 Arguments::vector(std::string_view name) const {
  const auto& v = std::get<std::array<double, 3>>(at(name));
  return {v[0], v[1], v[2]};
}

}  // namespace nephele
