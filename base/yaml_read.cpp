// Typed readings of YAML nodes, with ranges and sentences. Depends on base alone.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "base/yaml.h"

namespace nephele::yaml {
namespace {

std::string shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// How a scalar reads in a sentence: quoted and not too long.
std::string found(const Node& node) {
  if (node.kind != Kind::scalar) return describe(node);
  constexpr size_t kLongest = 40;
  const std::string text =
      node.scalar.size() > kLongest ? node.scalar.substr(0, kLongest) + "…" : node.scalar;
  return std::string("'") + text + "'" + (node.quoted ? " in quotes" : "");
}

enum class NumberText { number, notFinite, outOfRange, none };

/// Drops one '+' before a number, which YAML allows and from_chars does not.
std::string_view withoutPlus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && (text[1] == '.' || (text[1] >= '0' && text[1] <= '9')))
    text.remove_prefix(1);
  return text;
}

bool isInfinityOrNan(std::string_view text) {
  std::string lower;
  for (const char c : text) lower += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  std::string_view rest = lower;
  if (!rest.empty() && (rest[0] == '-' || rest[0] == '+')) rest.remove_prefix(1);
  if (!rest.empty() && rest[0] == '.') rest.remove_prefix(1);
  return rest == "inf" || rest == "infinity" || rest == "nan";
}

NumberText parseNumber(const Node& node, double& value) {
  if (node.kind != Kind::scalar || node.quoted) return NumberText::none;
  if (isInfinityOrNan(node.scalar)) return NumberText::notFinite;
  const std::string_view text = withoutPlus(node.scalar);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || end != text.data() + text.size()) return NumberText::none;
  if (error == std::errc::result_out_of_range) return NumberText::outOfRange;
  return error == std::errc() && std::isfinite(value) ? NumberText::number : NumberText::none;
}

void complainOfRange(const Node& node, const std::string& what, const Range& range, Diagnostics& out) {
  out.add(node.where, what + " must be " + describe(range) + ", found " + node.scalar);
}

}  // namespace

std::string describe(const Node& node) {
  double value = 0.0;
  switch (node.kind) {
    case Kind::null:
      return "nothing";
    case Kind::sequence:
      return "a list";
    case Kind::map:
      return "a map";
    case Kind::scalar:
      break;
  }
  return parseNumber(node, value) == NumberText::none ? "text" : "a number";
}

std::string describe(const Range& range) {
  const bool hasLow = std::isfinite(range.low), hasHigh = std::isfinite(range.high);
  if (hasLow && hasHigh && !range.lowOpen && !range.highOpen)
    return shown(range.low) + " to " + shown(range.high);
  std::string text;
  if (hasLow) text += (range.lowOpen ? "greater than " : "at least ") + shown(range.low);
  if (hasLow && hasHigh) text += " and ";
  if (hasHigh) text += (range.highOpen ? "less than " : "at most ") + shown(range.high);
  return text;
}

bool contains(const Range& range, double value) {
  const bool aboveLow = range.lowOpen ? value > range.low : value >= range.low;
  const bool belowHigh = range.highOpen ? value < range.high : value <= range.high;
  return aboveLow && belowHigh;
}

std::optional<double> readNumber(const Node& node, const std::string& what, const Range& range,
                                 Diagnostics& out) {
  double value = 0.0;
  switch (parseNumber(node, value)) {
    case NumberText::none:
      out.add(node.where, what + " must be a number, found " + found(node));
      return std::nullopt;
    case NumberText::notFinite:
      out.add(node.where, what + " must be a finite number, found " + found(node));
      return std::nullopt;
    case NumberText::outOfRange:
      out.add(node.where, what + " is too large or too small for a number: " + found(node));
      return std::nullopt;
    case NumberText::number:
      break;
  }
  if (contains(range, value)) return value;
  complainOfRange(node, what, range, out);
  return std::nullopt;
}

std::optional<long long> readInteger(const Node& node, const std::string& what, const Range& range,
                                     Diagnostics& out) {
  double asNumber = 0.0;
  if (parseNumber(node, asNumber) != NumberText::number) {
    out.add(node.where, what + " must be a whole number, found " + found(node));
    return std::nullopt;
  }
  const std::string_view text = withoutPlus(node.scalar);
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) {
    out.add(node.where, what + " is too large for a whole number: " + found(node));
    return std::nullopt;
  }
  if (error != std::errc() || end != text.data() + text.size()) {
    out.add(node.where, what + " must be a whole number, found " + found(node));
    return std::nullopt;
  }
  if (contains(range, static_cast<double>(value))) return value;
  complainOfRange(node, what, range, out);
  return std::nullopt;
}

std::optional<bool> readBoolean(const Node& node, const std::string& what, Diagnostics& out) {
  if (node.kind == Kind::scalar && !node.quoted && node.scalar == "true") return true;
  if (node.kind == Kind::scalar && !node.quoted && node.scalar == "false") return false;
  out.add(node.where, what + " must be true or false, found " + found(node));
  return std::nullopt;
}

std::optional<std::string> readText(const Node& node, const std::string& what, Diagnostics& out) {
  if (node.kind == Kind::scalar) return node.scalar;
  out.add(node.where, what + " must be text, found " + describe(node));
  return std::nullopt;
}

std::optional<std::vector<double>> readNumbers(const Node& node, const std::string& what, size_t count,
                                               const Range& range, Diagnostics& out) {
  const std::string wanted = what + " must be a list of " + std::to_string(count) + " numbers";
  if (node.kind != Kind::sequence) {
    out.add(node.where, wanted + ", found " + found(node));
    return std::nullopt;
  }
  if (node.items.size() != count) {
    out.add(node.where, wanted + ", found " + std::to_string(node.items.size()));
    return std::nullopt;
  }
  std::vector<double> values;
  for (const NodePtr& item : node.items)
    if (const auto value = readNumber(*item, what, range, out)) values.push_back(*value);
  if (values.size() != count) return std::nullopt;
  return values;
}

MapReader::MapReader(const Node& node, std::string what, Diagnostics& out)
    : node_(node),
      what_(std::move(what)),
      out_(out),
      isMap_(node.kind == Kind::map || node.kind == Kind::null) {
  if (!isMap_) out_.add(node_.where, what_ + " must be a map, found " + found(node_));
}

const Entry* MapReader::lookUp(std::string_view key) const {
  const auto found = std::find_if(node_.entries.begin(), node_.entries.end(),
                                  [key](const Entry& entry) { return entry.key == key; });
  return isMap_ && found != node_.entries.end() ? &*found : nullptr;
}

bool MapReader::has(std::string_view key) const { return lookUp(key) != nullptr; }

NodePtr MapReader::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  const Entry* entry = lookUp(key);
  return entry ? entry->value : nullptr;
}

SourceLocation MapReader::where(std::string_view key) const {
  const Entry* entry = lookUp(key);
  return entry ? entry->where : node_.where;
}

namespace {
std::string quoted(std::string_view key) { return std::string("'").append(key) + "'"; }
std::array<double, 3> asArray(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }
}  // namespace

double MapReader::number(std::string_view key, double fallback, const Range& range) {
  const NodePtr node = find(key);
  return node ? readNumber(*node, quoted(key), range, out_).value_or(fallback) : fallback;
}

long long MapReader::integer(std::string_view key, long long fallback, const Range& range) {
  const NodePtr node = find(key);
  return node ? readInteger(*node, quoted(key), range, out_).value_or(fallback) : fallback;
}

bool MapReader::boolean(std::string_view key, bool fallback) {
  const NodePtr node = find(key);
  return node ? readBoolean(*node, quoted(key), out_).value_or(fallback) : fallback;
}

std::string MapReader::text(std::string_view key, std::string fallback) {
  const NodePtr node = find(key);
  return node ? readText(*node, quoted(key), out_).value_or(fallback) : fallback;
}

std::string MapReader::choice(std::string_view key, std::string fallback,
                              const std::vector<std::string>& choices) {
  const NodePtr node = find(key);
  if (!node) return fallback;
  const auto value = readText(*node, quoted(key), out_);
  if (!value) return fallback;
  if (std::find(choices.begin(), choices.end(), *value) != choices.end()) return *value;
  std::string list;
  for (const std::string& choice : choices) list += (list.empty() ? "" : ", ") + choice;
  const std::vector<std::string_view> views(choices.begin(), choices.end());
  out_.add(node->where, quoted(key) + " must be one of " + list + ", found " + found(*node),
           didYouMean(*value, views));
  return fallback;
}

std::array<double, 3> MapReader::vector3(std::string_view key, std::array<double, 3> fallback,
                                         const Range& range) {
  const NodePtr node = find(key);
  if (!node) return fallback;
  const auto values = readNumbers(*node, quoted(key), fallback.size(), range, out_);
  return values ? asArray(*values) : fallback;
}

std::array<double, 3> MapReader::numberOrRgb(std::string_view key, std::array<double, 3> fallback,
                                             const Range& range) {
  const NodePtr node = find(key);
  if (!node) return fallback;
  if (node->kind == Kind::sequence) return vector3(key, fallback, range);
  const auto value = readNumber(*node, quoted(key) + " (or a list of 3)", range, out_);
  return value ? std::array<double, 3>{*value, *value, *value} : fallback;
}

void MapReader::finish() {
  if (!isMap_) return;
  const std::vector<std::string_view> candidates(known_.begin(), known_.end());
  for (const Entry& entry : node_.entries) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    out_.add(entry.where, "unknown key '" + entry.key + "' in " + what_, didYouMean(entry.key, candidates));
  }
}

}  // namespace nephele::yaml
