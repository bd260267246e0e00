// Particle systems as YAML: two visitors of describe.h, and the checks of what must go together. Depends on
// base.
#include <algorithm>
#include <charconv>

#include "particles/describe.h"

namespace nephele {
namespace {

class Reader {
 public:
  Reader(const yaml::Node& node, const std::string& what, Diagnostics& out)
      : map_(node, what, out), out_(out) {}

  /// Whether a map is there: a reader only exists for one that is.
  bool given(bool) const { return true; }
  void number(const char* key, double& value, const Range& range, const char*) {
    value = map_.number(key, value, range);
  }
  void integer(const char* key, int64_t& value, const Range& range) {
    value = map_.integer(key, value, range);
  }
  void flag(const char* key, bool& value) { value = map_.boolean(key, value); }
  void text(const char* key, std::string& value) { value = map_.text(key, value); }
  void vector(const char* key, glm::dvec3& value, const Range& range, const char*) {
    const auto read = map_.vector3(key, {value.x, value.y, value.z}, range);
    value = {read[0], read[1], read[2]};
  }
  template <class E>
  void choice(const char* key, E& value, const std::vector<std::string>& names) {
    const std::string read = map_.choice(key, names[size_t(value)], names);
    const auto found = std::find(names.begin(), names.end(), read);
    if (found != names.end()) value = E(found - names.begin());
  }
  /// A number stands for a curve that is constant.
  void curve(const char* key, ParticleCurve& value, const Range& range, const char*) {
    const yaml::NodePtr node = map_.find(key);
    if (!node) return;
    const std::string what = std::string("'") + key + "'";
    value.clear();
    if (node->kind == yaml::Kind::scalar) {
      const auto number = yaml::readNumber(*node, what, range, out_);
      if (number) value = {{0.0, *number}};
      return;
    }
    if (node->kind != yaml::Kind::sequence || node->items.empty() ||
        node->items.size() > size_t(motion::kMaxCurvePoints)) {
      out_.add(node->where, what + " must be a number or a list of 1 to " +
                                std::to_string(motion::kMaxCurvePoints) + " points [x, y], not " +
                                yaml::describe(*node));
      return;
    }
    for (const yaml::NodePtr& item : node->items) {
      const auto x = yaml::readNumbers(*item, "a point of " + what, 2, kAny, out_);
      if (!x) continue;
      if (!value.empty() && (*x)[0] <= value.back()[0])
        out_.add(item->where, "points of " + what + " must have growing x");
      if ((*x)[0] < 0.0 || !yaml::contains(range, (*x)[1]))
        out_.add(item->where,
                 "a point of " + what + " must have x at least 0 and y " + yaml::describe(range));
      value.push_back({(*x)[0], (*x)[1]});
    }
  }
  void words(const char* key, std::vector<std::string>& value, const std::vector<std::string>& known) {
    const yaml::NodePtr node = map_.find(key);
    if (!node) return;
    if (node->kind != yaml::Kind::sequence) {
      out_.add(node->where, std::string("'") + key + "' must be a list, not " + yaml::describe(*node));
      return;
    }
    const std::vector<std::string_view> candidates(known.begin(), known.end());
    for (const yaml::NodePtr& item : node->items) {
      const auto word = yaml::readText(*item, std::string("an entry of '") + key + "'", out_);
      if (!word) continue;
      if (std::find(known.begin(), known.end(), *word) == known.end())
        out_.add(item->where, std::string("'") + key + "' knows no '" + *word + "'",
                 didYouMean(*word, candidates));
      else if (std::find(value.begin(), value.end(), *word) != value.end())
        out_.add(item->where, std::string("'") + key + "' names '" + *word + "' twice");
      else
        value.push_back(*word);
    }
  }
  void node(const char* key, yaml::NodePtr& value) { value = map_.find(key); }
  template <class Body>
  void map(const char* key, const Body& body) {
    const yaml::NodePtr node = map_.find(key);
    if (!node) return;
    Reader inner(*node, std::string("'") + key + "'", out_);
    body(inner);
    inner.finish();
  }
  template <class T>
  void list(const char* key, std::vector<T>& items, size_t most) {
    const yaml::NodePtr node = map_.find(key);
    if (!node) return;
    if (node->kind != yaml::Kind::sequence || node->items.size() > most) {
      out_.add(node->where, std::string("'") + key + "' must be a list of at most " + std::to_string(most) +
                                ", not " + yaml::describe(*node));
      return;
    }
    for (const yaml::NodePtr& item : node->items) {
      Reader inner(*item, std::string("an entry of '") + key + "'", out_);
      T value;
      describe(inner, value);
      check(value, inner);
      inner.finish();
      items.push_back(std::move(value));
    }
  }
  void finish() { map_.finish(); }
  SourceLocation where(const char* key) const { return map_.where(key); }
  bool has(const char* key) const { return map_.has(key); }
  void complain(const char* key, const std::string& sentence) { out_.add(map_.where(key), sentence); }

 private:
  static void checkAxis(const glm::dvec3& axis, Reader& in) {
    if (axis == glm::dvec3(0.0)) in.complain("axis", "'axis' must have a length");
  }
  static void check(const Emitter& e, Reader& in) {
    checkAxis(e.axis, in);
    const bool needsFile = e.shape == EmitterShape::mesh || e.shape == EmitterShape::points;
    if (needsFile && e.file.empty()) in.complain("shape", "this shape needs 'file'");
    if (!needsFile && in.has("file")) in.complain("file", "only the shapes mesh and points take a 'file'");
    if (e.shape != EmitterShape::points && e.rate.empty() && e.bursts.empty())
      in.complain("rate", "an emitter needs 'rate' or 'bursts', or nothing is born");
    for (const auto& burst : e.bursts)
      if (burst[1] > double(kMostParticles)) in.complain("bursts", "a burst has too many particles");
  }
  static void check(const Vortex& x, Reader& in) { checkAxis(x.axis, in); }
  static void check(const Attractor&, Reader&) {}

  yaml::MapReader map_;
  Diagnostics& out_;
};

/// The most particles that can be alive at a time, from rates, bursts and lives.
double mostAlive(const Emitter& e) {
  double most = 0.0, rate = 0.0;
  for (const auto& burst : e.bursts) most += burst[1];
  for (const auto& point : e.rate) rate = std::max(rate, point[1]);
  return most + rate * e.life;
}

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

void checkTogether(const ParticleSystem& system, Reader& in) {
  if (system.emitters.empty()) in.complain("emitters", "'particles' needs at least one of 'emitters'");
  double alive = 0.0;
  for (const Emitter& e : system.emitters) alive += mostAlive(e);
  if (alive > double(kMostParticles))
    in.complain("emitters", "the emitters ask for up to " + shown(alive) +
                                " particles at a time, which take " +
                                shown(alive * double(kBytesPerParticle) * 1e-9) + " GB; at most " +
                                shown(double(kMostParticles)) + " are moved");
  const Forces& f = system.forces;
  if (f.neighbourReach == 0.0 && (f.cohesion != 0.0 || f.separation != 0.0))
    in.complain("forces", "cohesion and separation need the neighbours' 'radius'");
  if (system.erosion > 0.0 && !system.erosionField) in.complain("erosion", "'erosion' needs a 'field'");
  if (in.has("box") && !(system.boxMin.x < system.boxMax.x && system.boxMin.y < system.boxMax.y &&
                         system.boxMin.z < system.boxMax.z))
    in.complain("box", "the box's 'min' must lie below its 'max' along every axis");
  if (system.stableBox && in.has("box"))
    in.complain("stable_box", "'box' already gives every frame the same box; leave one of the two out");
}

/// Collects keys in flow style.
class Writer {
 public:
  bool given(bool value) {
    given_ = value;
    return value;
  }
  void number(const char* key, double& value, const Range&, const char*) { put(key, textOf(value)); }
  void integer(const char* key, int64_t& value, const Range&) { put(key, std::to_string(value)); }
  void flag(const char* key, bool& value) { put(key, value ? "true" : "false"); }
  void text(const char* key, std::string& value) { put(key, value.empty() ? "" : quoted(value)); }
  void vector(const char* key, glm::dvec3& v, const Range&, const char*) {
    put(key, "[" + textOf(v.x) + ", " + textOf(v.y) + ", " + textOf(v.z) + "]");
  }
  template <class E>
  void choice(const char* key, E& value, const std::vector<std::string>& names) {
    put(key, names[size_t(value)]);
  }
  void curve(const char* key, ParticleCurve& value, const Range&, const char*) {
    std::string text;
    for (const auto& point : value)
      text += (text.empty() ? "[" : ", [") + textOf(point[0]) + ", " + textOf(point[1]) + "]";
    put(key, value.empty() ? "" : "[" + text + "]");
  }
  void words(const char* key, std::vector<std::string>& value, const std::vector<std::string>&) {
    std::string text;
    for (const std::string& word : value) text += (text.empty() ? "" : ", ") + word;
    put(key, value.empty() ? "" : "[" + text + "]");
  }
  void node(const char* key, yaml::NodePtr& value) { put(key, value ? flow(*value) : ""); }
  template <class Body>
  void map(const char* key, const Body& body) {
    Writer inner;
    body(inner);
    put(key, inner.given_ ? inner.inBraces() : "");
  }
  template <class T>
  void list(const char* key, std::vector<T>& items, size_t) {
    std::string text;
    for (T& item : items) text += (text.empty() ? "" : ",\n  ") + writtenLike(item, T{});
    put(key, items.empty() ? "" : "[" + text + "]");
  }

  /// The keys of `value` whose text differs from those of `plain`.
  template <class T>
  static Writer differing(T& value, T plain) {
    Writer wanted, usual, result;
    describe(wanted, value);
    describe(usual, plain);
    for (size_t n = 0; n < wanted.keys_.size(); ++n)
      if (wanted.keys_[n] != usual.keys_[n]) result.keys_.push_back(wanted.keys_[n]);
    return result;
  }
  const std::vector<std::pair<std::string, std::string>>& keys() const { return keys_; }

 private:
  template <class T>
  static std::string writtenLike(T& value, T plain) {
    return differing(value, std::move(plain)).inBraces();
  }
  std::string inBraces() const {
    std::string text;
    for (const auto& [key, value] : keys_)
      if (!value.empty()) text += (text.empty() ? "" : ", ") + key + ": " + value;
    return "{ " + text + " }";
  }
  void put(const char* key, std::string value) { keys_.emplace_back(key, std::move(value)); }
  static std::string textOf(double value) {
    char text[32];  // the longest double takes 24 characters
    const auto end = std::to_chars(text, text + sizeof text, value);
    return std::string(text, end.ptr);
  }
  static std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
    return out + "\"";
  }
  static std::string flow(const yaml::Node& node) {
    std::string text;
    if (node.kind == yaml::Kind::scalar) return node.quoted ? quoted(node.scalar) : node.scalar;
    if (node.kind == yaml::Kind::sequence) {
      for (const yaml::NodePtr& item : node.items) text += (text.empty() ? "" : ", ") + flow(*item);
      return "[" + text + "]";
    }
    for (const yaml::Entry& e : node.entries)
      text += (text.empty() ? "" : ", ") + e.key + ": " + flow(*e.value);
    return node.kind == yaml::Kind::null ? "~" : "{ " + text + " }";
  }

  std::vector<std::pair<std::string, std::string>> keys_;
  bool given_ = true;
};

}  // namespace

ParticleSystem readParticles(const yaml::Node& node, Diagnostics& out) {
  ParticleSystem system;
  if (node.kind != yaml::Kind::map) {
    out.add(node.where, "'particles' must be a map, not " + yaml::describe(node));
    return system;
  }
  Reader reader(node, "'particles'", out);
  describe(reader, system);
  checkTogether(system, reader);
  reader.finish();
  return system;
}

std::string writeParticles(const ParticleSystem& system) {
  ParticleSystem copy = system;
  std::string text;
  const Writer written = Writer::differing(copy, ParticleSystem{});
  for (const auto& [key, value] : written.keys()) text += key + ": " + value + "\n";
  return text;
}

}  // namespace nephele
