// Builds located nodes from yaml-cpp's events. Depends on base and yaml-cpp.
#include "base/yaml.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
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

}  // namespace

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

}  // namespace nephele::yaml
