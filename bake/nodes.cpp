// The field table as text. Depends on fields and base.
#include "bake/nodes.h"

#include <algorithm>
#include <sstream>

#include "bake/fields/table.h"
#include "base/yaml.h"

namespace nephele {
namespace {

std::string_view nameOf(ParameterType type) {
  switch (type) {
    case ParameterType::number:
      return "number";
    case ParameterType::integer:
      return "integer";
    case ParameterType::choice:
      return "choice";
    case ParameterType::pair:
      return "[a, b]";
    case ParameterType::vector:
      return "[x, y, z]";
    case ParameterType::curve:
      return "[[x, y], ...]";
    case ParameterType::file:
      return "file";
    case ParameterType::field:
      return "field";
    case ParameterType::fields:
      return "list of fields";
  }
  failCheck(__FILE__, __LINE__, "a parameter type has a name", std::to_string(int(type)), "named");
}

template <size_t N>
void put(std::ostream& out, const std::array<double, N>& list) {
  for (size_t n = 0; n < N; ++n) out << (n == 0 ? "[" : ", ") << list[n];
  out << ']';
}

std::string shown(const Value& value) {
  std::ostringstream out;
  std::visit(
      [&out](const auto& v) {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, Curve>) {
          for (size_t n = 0; n < v.size(); ++n) put(out << (n == 0 ? "[" : ", "), v[n]);
          out << ']';
        } else if constexpr (std::is_same_v<T, std::array<double, 2>> ||
                             std::is_same_v<T, std::array<double, 3>>) {
          put(out, v);
        } else if constexpr (std::is_same_v<T, double> || std::is_same_v<T, int64_t> ||
                             std::is_same_v<T, std::string>) {
          out << v;
        }
      },
      value);
  return out.str();
}

}  // namespace

std::string parameterKind(const Parameter& parameter) {
  std::string text(nameOf(parameter.type));
  for (const std::string& choice : parameter.choices)
    text += (choice == parameter.choices.front() ? ": " : " | ") + choice;
  if (!parameter.unit.empty()) text += ", " + std::string(parameter.unit);
  if (const std::string range = yaml::describe(parameter.range); !range.empty()) text += ", " + range;
  return text + (parameter.fallback ? ", default " + shown(*parameter.fallback) : ", required");
}

std::string nodesAsText() {
  size_t width = 0;
  for (const FieldRow& row : fieldTable()) width = std::max(width, row.name.size());
  std::string text;
  for (const FieldRow& row : fieldTable())
    text += std::string(row.name) + std::string(width + 2 - row.name.size(), ' ') +
            std::string(row.sentence) + "\n";
  return text;
}

std::string nodeAsText(const std::string& name) {
  const FieldRow* row = findField(name);
  if (!row) {
    std::vector<std::string_view> names;
    for (const FieldRow& known : fieldTable()) names.push_back(known.name);
    throw InputError({}, "unknown field '" + name + "'", didYouMean(name, names));
  }
  std::string text = std::string(row->name) + ": " + std::string(row->sentence) + "\n";
  for (const Parameter& parameter : row->parameters)
    text += "  " + std::string(parameter.name) + "  (" + parameterKind(parameter) + ")\n      " +
            std::string(parameter.sentence) + "\n";
  return text;
}

}  // namespace nephele
