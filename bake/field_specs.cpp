// Reading fields out of YAML by the field table. Depends on fields and base.
#include "bake/field_specs.h"

#include <algorithm>
#include <filesystem>

#include "base/figures.h"
#include "base/files.h"
#include "base/hash.h"

namespace nephele {
namespace {

std::string inQuotes(std::string_view text) { return "'" + std::string(text) + "'"; }

// Fields are built, bounded and evaluated by functions that call each other as deep; names and aliases count
// too.
constexpr int kMostNested = 100;

// A field that a name or an alias stands for is evaluated at each use: 14 sums of eight of the one before
// come to 10^12. Samples have below 60.
constexpr double kMostUses = 10000.0;

std::string tooMany(double uses) {
  return "this comes to " + number(uses, 3) +
         " fields, counting each use of a name or an alias; more than 10000 are not evaluated";
}

std::string tooDeep() { return "fields are nested deeper than " + std::to_string(kMostNested) + " levels"; }

bool looksLikeNumber(const yaml::Node& node) {
  return !node.quoted && !node.scalar.empty() &&
         (std::isdigit(static_cast<unsigned char>(node.scalar.front())) ||
          std::string_view("+-.").find(node.scalar.front()) != std::string_view::npos);
}

/// Reads [[x, y], …] with growing x.
std::optional<Curve> readCurve(const yaml::Node& node, const std::string& what, const Range& range,
                               Diagnostics& out) {
  if (node.kind != yaml::Kind::sequence || node.items.empty()) {
    out.add(node.where, what + " must be a list of points [x, y], not " + yaml::describe(node));
    return std::nullopt;
  }
  Curve curve;
  bool good = true;
  for (const yaml::NodePtr& item : node.items) {
    const auto point = yaml::readNumbers(*item, "a point of " + what, 2, range, out);
    good = good && point;
    if (!point) continue;
    if (!curve.empty() && (*point)[0] <= curve.back()[0]) {
      out.add(item->where, "the points of " + what + " must have growing first numbers");
      good = false;
    }
    curve.push_back({(*point)[0], (*point)[1]});
  }
  if (!good) return std::nullopt;
  return curve;
}

/// Reads a file's name, relative to `folder`, and hashes what the file holds.
std::optional<InputFile> readFile(const yaml::Node& node, const std::string& what, const std::string& folder,
                                  Diagnostics& out) {
  const auto name = yaml::readText(node, what, out);
  if (!name) return std::nullopt;
  const std::string path = (std::filesystem::path(folder) / *name).string();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    out.add(node.where, what + " names no file: " + inQuotes(path));
    return std::nullopt;
  }
  Hasher hasher;
  hasher.text(readWhole(path));
  return InputFile{path, hasher.hex()};
}

/// Reads the types that hold no fields.
std::optional<Value> readPlain(const Parameter& parameter, const std::string& what, const yaml::Node& node,
                               const std::string& folder, Diagnostics& out) {
  switch (parameter.type) {
    case ParameterType::number:
      if (const auto v = yaml::readNumber(node, what, parameter.range, out)) return Value{*v};
      return std::nullopt;
    case ParameterType::integer:
      if (const auto v = yaml::readInteger(node, what, parameter.range, out)) return Value{int64_t(*v)};
      return std::nullopt;
    case ParameterType::pair:
      if (const auto v = yaml::readNumbers(node, what, 2, parameter.range, out))
        return Value{std::array<double, 2>{(*v)[0], (*v)[1]}};
      return std::nullopt;
    case ParameterType::vector:
      if (const auto v = yaml::readNumbers(node, what, 3, parameter.range, out))
        return Value{std::array<double, 3>{(*v)[0], (*v)[1], (*v)[2]}};
      return std::nullopt;
    case ParameterType::curve:
      if (auto v = readCurve(node, what, parameter.range, out)) return Value{std::move(*v)};
      return std::nullopt;
    case ParameterType::file:
      if (auto v = readFile(node, what, folder, out)) return Value{std::move(*v)};
      return std::nullopt;
    case ParameterType::choice: {
      const auto v = yaml::readText(node, what, out);
      if (!v) return std::nullopt;
      if (std::find(parameter.choices.begin(), parameter.choices.end(), *v) != parameter.choices.end())
        return Value{*v};
      std::vector<std::string_view> choices(parameter.choices.begin(), parameter.choices.end());
      out.add(node.where, what + " has no choice " + inQuotes(*v), didYouMean(*v, choices));
      return std::nullopt;
    }
    case ParameterType::field:
    case ParameterType::fields:
      break;
  }
  failCheck(__FILE__, __LINE__, "a parameter that holds fields is read elsewhere",
            std::string(parameter.name), "plain");
}

}  // namespace

void FieldReader::setNamed(const yaml::Node& fields) {
  if (fields.kind == yaml::Kind::null) return;
  if (fields.kind != yaml::Kind::map) {
    out_.add(fields.where, "'fields' must be a map of named fields, not " + yaml::describe(fields));
    return;
  }
  for (const yaml::Entry& entry : fields.entries) {
    if (findField(entry.key))
      out_.add(entry.where, "a named field must not be called like a built-in field: " + inQuotes(entry.key));
    else
      named_[entry.key] = entry.value;
  }
}

void FieldReader::readRest() {
  for (const auto& [name, node] : named_)
    if (!readNames_.contains(name)) readNamed(name, node->where);
}

std::vector<std::string_view> FieldReader::knownNames() const {
  std::vector<std::string_view> names;
  for (const FieldRow& row : fieldTable()) names.push_back(row.name);
  for (const auto& [name, node] : named_) names.push_back(name);
  return names;
}

FieldSpecPtr FieldReader::read(const yaml::NodePtr& node, const std::string& what) {
  if (const auto found = readNodes_.find(node.get()); found != readNodes_.end()) return found->second;
  if (depth_ >= kMostNested) {
    out_.add(node->where, tooDeep());
    return readNodes_[node.get()] = nullptr;
  }
  ++depth_;
  const FieldSpecPtr spec = readNew(*node, what);
  --depth_;
  readNodes_[node.get()] = spec;
  return spec;
}

yaml::NodePtr FieldReader::withoutNames(const yaml::NodePtr& node) const {
  if (node->kind == yaml::Kind::scalar) {
    const auto named = looksLikeNumber(*node) ? named_.end() : named_.find(node->scalar);
    return named == named_.end() ? node : withoutNames(named->second);
  }
  const auto eachItem = [this](yaml::Node list) {
    for (yaml::NodePtr& item : list.items) item = withoutNames(item);
    return std::make_shared<yaml::Node>(std::move(list));
  };
  yaml::Node field = *node;
  yaml::Entry& entry = field.entries.front();
  if (entry.value->kind == yaml::Kind::sequence) {
    entry.value = eachItem(*entry.value);
  } else {
    yaml::Node body = *entry.value;
    for (yaml::Entry& value : body.entries)
      for (const Parameter& parameter : findField(entry.key)->parameters) {
        if (value.key != parameter.name) continue;
        if (parameter.type == ParameterType::field) value.value = withoutNames(value.value);
        if (parameter.type == ParameterType::fields) value.value = eachItem(*value.value);
      }
    entry.value = std::make_shared<yaml::Node>(std::move(body));
  }
  return std::make_shared<yaml::Node>(std::move(field));
}

FieldSpecPtr FieldReader::readNew(const yaml::Node& node, const std::string& what) {
  if (node.kind == yaml::Kind::scalar) return readName(node, what);
  if (node.kind != yaml::Kind::map || node.entries.size() != 1) {
    out_.add(
        node.where,
        what + " must be one field, as in { sphere: { radius: 1 } }, a number or a field's name, not " +
            (node.kind == yaml::Kind::map && node.entries.size() > 1 ? std::string("a map of several keys")
                                                                     : yaml::describe(node)));
    return nullptr;
  }
  const yaml::Entry& entry = node.entries.front();
  if (const FieldRow* row = findField(entry.key)) return readRow(*row, *entry.value, entry.where);
  out_.add(entry.where, "unknown field " + inQuotes(entry.key), didYouMean(entry.key, knownNames()));
  return nullptr;
}

FieldSpecPtr FieldReader::readName(const yaml::Node& node, const std::string& what) {
  if (looksLikeNumber(node)) {
    const auto value = yaml::readNumber(node, what, kAny, out_);
    if (!value) return nullptr;
    auto spec = std::make_shared<FieldSpec>();
    spec->row = findField("constant");
    spec->where = node.where;
    spec->values.emplace("value", *value);
    return spec;
  }
  if (named_.contains(node.scalar)) return readNamed(node.scalar, node.where);
  if (const FieldRow* row = findField(node.scalar)) return readRow(*row, yaml::Node{}, node.where);
  out_.add(node.where, "unknown field " + inQuotes(node.scalar), didYouMean(node.scalar, knownNames()));
  return nullptr;
}

FieldSpecPtr FieldReader::readNamed(const std::string& name, const SourceLocation& from) {
  if (const auto found = readNames_.find(name); found != readNames_.end()) return found->second;
  if (const auto start = std::find(path_.begin(), path_.end(), name); start != path_.end()) {
    std::string cycle;
    for (auto at = start; at != path_.end(); ++at) cycle += *at + " -> ";
    out_.add(from, "a field cannot be made of itself: " + cycle + name);
    return nullptr;
  }
  path_.push_back(name);
  const FieldSpecPtr spec = read(named_.at(name), "field " + inQuotes(name));
  path_.pop_back();
  readNames_[name] = spec;
  return spec;
}

FieldSpecPtr FieldReader::readRow(const FieldRow& row, const yaml::Node& body, const SourceLocation& where) {
  auto spec = std::make_shared<FieldSpec>();
  spec->row = &row;
  spec->where = where;
  bool good = true;
  const std::string rowName = inQuotes(row.name);
  if (body.kind == yaml::Kind::sequence && listParameter(row)) {
    good = readFields(*listParameter(row), rowName, body, *spec);
    for (const Parameter& parameter : row.parameters)
      if (parameter.fallback) spec->values.emplace(parameter.name, *parameter.fallback);
  } else if (body.kind == yaml::Kind::map || body.kind == yaml::Kind::null) {
    yaml::MapReader reader(body, rowName, out_);
    for (const Parameter& parameter : row.parameters) {
      const yaml::NodePtr node = reader.find(parameter.name);
      const std::string what = inQuotes(parameter.name) + " of " + rowName;
      if (node) {
        spec->places[std::string(parameter.name)] = reader.where(parameter.name);
        good = readParameter(parameter, what, node, *spec) && good;
      } else if (parameter.fallback) {
        spec->values.emplace(parameter.name, *parameter.fallback);
      } else {
        out_.add(where, rowName + " needs " + inQuotes(parameter.name));
        good = false;
      }
    }
    reader.finish();
  } else {
    out_.add(body.where, rowName + " takes a map of parameters, not " + yaml::describe(body));
    good = false;
  }
  // Also where something is missing: all that is wrong is told at once.
  good = validate(row, *spec, body, good ? Arguments::Given::all : Arguments::Given::some) && good;
  if (!good) return nullptr;
  for (const auto& [name, children] : spec->children)
    for (const FieldSpecPtr& child : children) {
      spec->height = std::max(spec->height, child->height + 1);
      spec->uses += child->uses;
    }
  if (spec->height > kMostNested) {
    out_.add(where, tooDeep());
    return nullptr;
  }
  if (spec->uses > kMostUses) {
    out_.add(where, tooMany(spec->uses));
    return nullptr;
  }
  return spec;
}

bool FieldReader::validate(const FieldRow& row, const FieldSpec& spec, const yaml::Node& body,
                           Arguments::Given given) {
  if (!row.validate) return true;
  Complaint complaint;
  try {
    complaint = row.validate(Arguments(spec.values, given));
  } catch (const Arguments::Missing&) {  // told already, and needed to go on
    return false;
  } catch (const InputError& error) {  // in a file that the recipe names
    for (const Diagnostic& d : error.diagnostics()) out_.add(d.where, d.sentence, d.hint);
    return false;
  }
  if (!complaint) return true;
  yaml::MapReader places(body, std::string(row.name), out_);
  const SourceLocation place = places.where(complaint->first);
  out_.add(place.line > 0 ? place : spec.where, complaint->second);
  return false;
}

bool FieldReader::readParameter(const Parameter& parameter, const std::string& what,
                                const yaml::NodePtr& node, FieldSpec& spec) {
  if (parameter.type == ParameterType::fields) return readFields(parameter, what, *node, spec);
  if (parameter.type == ParameterType::field) {
    FieldSpecPtr child = read(node, what);
    if (!child) return false;
    spec.children[std::string(parameter.name)] = {std::move(child)};
    return true;
  }
  const auto value = readPlain(parameter, what, *node, folder_, out_);
  if (!value) return false;
  spec.values.emplace(parameter.name, *value);
  return true;
}

bool FieldReader::readFields(const Parameter& parameter, const std::string& what, const yaml::Node& node,
                             FieldSpec& spec) {
  if (node.kind != yaml::Kind::sequence || node.items.empty()) {
    out_.add(node.where,
             what + " takes a list of at least one field, not " +
                 (node.kind == yaml::Kind::sequence ? std::string("an empty list") : yaml::describe(node)));
    return false;
  }
  auto& children = spec.children[std::string(parameter.name)];
  bool good = true;
  for (const yaml::NodePtr& item : node.items) {
    children.push_back(read(item, "an input of " + what));
    good = good && children.back() != nullptr;
  }
  return good;
}

}  // namespace nephele
