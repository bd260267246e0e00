// Builds located nodes from yaml-cpp's events, and reads typed values from them. Depends on base and
// yaml-cpp.
#include "base/yaml.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>

#include "base/files.h"

namespace nephele::yaml {
namespace {

constexpr size_t kDeepest = 200;
constexpr size_t kLargestTextBytes = size_t{64} << 20;

/// Turns the parser's events into nodes. Refuses by InputError what cannot be read on; collects duplicate
/// keys.
class Builder : public YAML::EventHandler {
 public:
  Builder(std::string fileName, Diagnostics& out) : fileName_(std::move(fileName)), out_(out) {}

  NodePtr root() const { return root_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ > 0)
      throw InputError(placeOf(mark), "a file holds one YAML document; a second begins here");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    auto node = make(Kind::null, placeOf(mark), anchor);
    // The parser places a missing value at whatever comes next; its key is what people look for.
    if (!frames_.empty() && frames_.back().hasKey) node->where = frames_.back().keyWhere;
    place(node, node->where, 1);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end() || found->second.height == 0)
      throw InputError(placeOf(mark), "an alias stands inside the value that it names");
    if (frames_.size() + found->second.height > kDeepest) refuseDepth(placeOf(mark));
    if (expectsKey()) refuseKey(placeOf(mark));
    place(found->second.node, placeOf(mark), found->second.height);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    checkTag(mark, tag);
    if (expectsKey()) return takeKey(placeOf(mark), value);
    auto node = make(Kind::scalar, placeOf(mark), anchor);
    node->scalar = value;
    node->quoted = tag == "!";
    place(node, node->where, 1);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    checkTag(mark, tag);
    open(Kind::sequence, mark, anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    checkTag(mark, tag);
    open(Kind::map, mark, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Frame {
    std::shared_ptr<Node> node;
    YAML::anchor_t anchor = 0;
    size_t height = 1;  // levels below and including this one, through aliases too
    bool hasKey = false;
    std::string key;
    SourceLocation keyWhere;
    std::map<std::string, SourceLocation, std::less<>> firstPlaces;
  };
  struct Anchored {
    NodePtr node;
    size_t height = 0;  // 0 while the node is still open
  };

  SourceLocation placeOf(const YAML::Mark& mark) const { return {fileName_, mark.line + 1, mark.column + 1}; }
  bool expectsKey() const {
    return !frames_.empty() && frames_.back().node->kind == Kind::map && !frames_.back().hasKey;
  }
  [[noreturn]] void refuseDepth(SourceLocation where) const {
    throw InputError(std::move(where), "nested deeper than " + std::to_string(kDeepest) + " levels");
  }
  [[noreturn]] static void refuseKey(SourceLocation where) {
    throw InputError(std::move(where), "a key must be text");
  }
  /// yaml-cpp gives "?" to plain and "!" to quoted scalars, and "" to what else has no tag.
  void checkTag(const YAML::Mark& mark, const std::string& tag) const {
    if (!tag.empty() && tag != "?" && tag != "!")
      throw InputError(placeOf(mark), "tags such as '" + tag + "' are not used here");
  }

  std::shared_ptr<Node> make(Kind kind, SourceLocation where, YAML::anchor_t anchor) {
    auto node = std::make_shared<Node>();
    node->kind = kind;
    node->where = std::move(where);
    if (anchor != 0)
      anchors_[anchor] = {node, kind == Kind::null || kind == Kind::scalar ? size_t{1} : size_t{0}};
    return node;
  }

  void takeKey(SourceLocation where, const std::string& key) {
    if (key == "<<") throw InputError(where, "merge keys ('<<') are not read", "write the keys out");
    Frame& frame = frames_.back();
    frame.hasKey = true;
    frame.key = key;
    frame.keyWhere = std::move(where);
  }

  void open(Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (frames_.size() >= kDeepest) refuseDepth(placeOf(mark));
    if (expectsKey()) refuseKey(placeOf(mark));
    Frame frame;
    frame.node = make(kind, placeOf(mark), anchor);
    frame.anchor = anchor;
    frames_.push_back(std::move(frame));
  }

  void close() {
    Frame frame = std::move(frames_.back());
    frames_.pop_back();
    if (frame.anchor != 0) anchors_[frame.anchor].height = frame.height;
    place(frame.node, frame.node->where, frame.height);
  }

  /// Puts a finished value where it belongs; `height` counts its levels.
  void place(const NodePtr& node, const SourceLocation& where, size_t height) {
    if (frames_.empty()) {
      root_ = node;
      return;
    }
    if (expectsKey()) refuseKey(where);
    Frame& frame = frames_.back();
    frame.height = std::max(frame.height, height + 1);
    if (frame.node->kind == Kind::sequence) {
      frame.node->items.push_back(node);
      return;
    }
    frame.hasKey = false;
    const auto [first, isNew] = frame.firstPlaces.emplace(frame.key, frame.keyWhere);
    if (isNew)
      frame.node->entries.push_back({frame.key, frame.keyWhere, node});
    else
      out_.add(frame.keyWhere, "key '" + frame.key + "' is given twice",
               "first in line " + std::to_string(first->second.line));
  }

  std::string fileName_;
  Diagnostics& out_;
  NodePtr root_;
  int documents_ = 0;
  std::vector<Frame> frames_;
  std::map<YAML::anchor_t, Anchored> anchors_;
};

/// Control characters mean that this is no text; yaml-cpp would end the file at one of them without a word.
void checkIsText(std::string_view text, const std::string& fileName) {
  if (text.size() > kLargestTextBytes) throw InputError({fileName}, "a YAML file above 64 MiB is not read");
  int line = 1;
  size_t lineStart = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    const unsigned char c = static_cast<unsigned char>(text[i]);
    if (c == '\n') {
      ++line;
      lineStart = i + 1;
    }
    if ((c < ' ' && c != '\n' && c != '\r' && c != '\t') || c == 0x7f)  // 0x7f: delete
      throw InputError({fileName, line, static_cast<int>(i - lineStart) + 1}, "holds a control character",
                       "is it a YAML file in UTF-8?");
  }
}

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

NodePtr parse(std::string_view text, const std::string& fileName) {
  checkIsText(text, fileName);
  Diagnostics out;
  Builder builder(fileName, out);
  std::istringstream stream{std::string(text)};
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) continue;
  } catch (const YAML::Exception& error) {
    SourceLocation where{fileName};
    if (!error.mark.is_null()) where = {fileName, error.mark.line + 1, error.mark.column + 1};
    out.add(where, "not valid YAML: " + error.msg);
  } catch (const InputError& error) {
    for (const Diagnostic& d : error.diagnostics()) out.add(d.where, d.sentence, d.hint);
  }
  out.throwIfAny();
  if (builder.root()) return builder.root();
  auto empty = std::make_shared<Node>();
  empty->where = {fileName, 1, 1};
  return empty;
}

NodePtr load(const std::string& path) { return parse(readWhole(path), path); }

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
