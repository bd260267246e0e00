// Reading PLY meshes, ascii and binary little-endian. Depends on base alone.
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include "bake/fields/mesh_file.h"
#include "base/error.h"

namespace nephele {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is read as it lies in memory");

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Type> typeOf(std::string_view name) {
  static constexpr std::pair<std::string_view, Type> kNames[]{
      {"char", Type::int8},      {"int8", Type::int8},       {"uchar", Type::uint8},
      {"uint8", Type::uint8},    {"short", Type::int16},     {"int16", Type::int16},
      {"ushort", Type::uint16},  {"uint16", Type::uint16},   {"int", Type::int32},
      {"int32", Type::int32},    {"uint", Type::uint32},     {"uint32", Type::uint32},
      {"float", Type::float32},  {"float32", Type::float32}, {"double", Type::float64},
      {"float64", Type::float64}};
  for (const auto& [known, type] : kNames)
    if (known == name) return type;
  return std::nullopt;
}

struct Property {
  std::string name;
  Type type = Type::float32;
  std::optional<Type> countType;  // of a list
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  PlyReader(const std::string& content, const std::string& path) : rest_(content), path_(path) {}

  TriangleMesh read() {
    readHeader();
    for (const Element& element : elements_) readElement(element);
    for (const auto& triangle : mesh_.triangles)
      for (const uint32_t corner : triangle)
        if (corner >= mesh_.vertices.size())
          fail("a face names vertex " + std::to_string(corner) + " of " +
               std::to_string(mesh_.vertices.size()) + ", counted from 0");
    if (mesh_.triangles.empty()) fail("holds no faces");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& sentence) const { throw InputError({path_, line_}, sentence); }

  std::string_view nextLine() {
    if (rest_.empty()) fail("ends inside its header");
    std::string_view line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
    ++line_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  static std::vector<std::string_view> wordsOf(std::string_view line) {
    std::vector<std::string_view> words;
    while (true) {
      line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
      if (line.empty()) return words;
      words.push_back(line.substr(0, line.find_first_of(" \t")));
      line.remove_prefix(words.back().size());
    }
  }

  void readHeader() {
    nextLine();  // the word ply
    while (true) {
      const auto words = wordsOf(nextLine());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() == 3)
        readFormat(words[1]);
      else if (words[0] == "element" && words.size() == 3)
        elements_.push_back({std::string(words[1]), wholeNumber(words[2]), {}});
      else if (words[0] == "property" && !elements_.empty())
        elements_.back().properties.push_back(propertyOf(words));
      else
        fail("a PLY header has no line '" + std::string(words[0]) + "' of this kind here");
    }
    if (!format_) fail("the header names no format");
    line_ = *format_ ? 0 : line_ + 1;  // lines mean nothing in binary
  }

  void readFormat(std::string_view format) {
    if (format != "ascii" && format != "binary_little_endian")
      fail("format '" + std::string(format) + "' is not read; write ascii or binary_little_endian");
    format_ = format != "ascii";
  }

  uint64_t wholeNumber(std::string_view word) const {
    uint64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || value > UINT32_MAX)
      fail("'" + std::string(word) + "' is no count");
    return value;
  }

  Property propertyOf(const std::vector<std::string_view>& words) const {
    Property property;
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3) fail("a property needs a type and a name");
    const auto known = [&](std::string_view name) {
      const auto type = typeOf(name);
      if (!type) fail("a property has no type '" + std::string(name) + "'");
      return *type;
    };
    if (list) property.countType = known(words[2]);
    property.type = known(words[words.size() - 2]);
    property.name = words.back();
    return property;
  }

  /// The next value: a word of the text, or bytes.
  double value(Type type) {
    if (!*format_) return wordValue();
    switch (type) {
      case Type::int8:
        return double(raw<int8_t>());
      case Type::uint8:
        return double(raw<uint8_t>());
      case Type::int16:
        return double(raw<int16_t>());
      case Type::uint16:
        return double(raw<uint16_t>());
      case Type::int32:
        return double(raw<int32_t>());
      case Type::uint32:
        return double(raw<uint32_t>());
      case Type::float32:
        return double(raw<float>());
      case Type::float64:
        return raw<double>();
    }
    failCheck(__FILE__, __LINE__, "a PLY type is one of eight", std::to_string(int(type)), "known");
  }

  template <class T>
  T raw() {
    if (rest_.size() < sizeof(T)) fail("ends in the middle of " + where_);
    T v;
    std::memcpy(&v, rest_.data(), sizeof v);
    rest_.remove_prefix(sizeof v);
    return v;
  }

  double wordValue() {
    while (!rest_.empty() && std::string_view(" \t\r\n").find(rest_.front()) != std::string_view::npos) {
      line_ += rest_.front() == '\n';
      rest_.remove_prefix(1);
    }
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
    if (word.empty()) fail("ends in the middle of " + where_);
    double v = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), v);
    if (error != std::errc{} || end != word.data() + word.size())
      fail(where_ + " has '" + std::string(word) + "' where a number belongs");
    rest_.remove_prefix(word.size());
    return v;
  }

  void readElement(const Element& element) {
    // Every element takes at least a byte, or a character.
    if (!element.properties.empty() && element.count > rest_.size())
      fail("claims " + std::to_string(element.count) + " of '" + element.name +
           "', more than the file holds");
    for (uint64_t n = 0; n < element.count && !element.properties.empty(); ++n) {
      where_ = element.name + " " + std::to_string(n);
      if (element.name == "vertex")
        readVertex(element);
      else
        readRow(element);
    }
  }

  void readVertex(const Element& element) {
    glm::dvec3 vertex(0.0);
    int found = 0;
    for (const Property& property : element.properties) {
      const size_t axis = std::string_view("xyz").find(property.name);
      if (property.countType || property.name.size() != 1 || axis == std::string_view::npos) {
        skip(property);
        continue;
      }
      vertex[int(axis)] = value(property.type);
      ++found;
    }
    if (found != 3) fail("a vertex needs the properties x, y and z");
    if (!std::isfinite(vertex.x) || !std::isfinite(vertex.y) || !std::isfinite(vertex.z))
      fail(where_ + " is not finite");
    mesh_.vertices.push_back(vertex);
  }

  /// A face, or an element that nobody asked for.
  void readRow(const Element& element) {
    bool found = element.name != "face";
    for (const Property& property : element.properties) {
      const bool corners = property.countType && element.name == "face" &&
                           (property.name == "vertex_indices" || property.name == "vertex_index");
      if (corners)
        readCorners(property);
      else
        skip(property);
      found = found || corners;
    }
    if (!found) fail("a face needs the list vertex_indices");
  }

  void readCorners(const Property& property) {
    const double count = value(*property.countType);
    if (!(count >= 3.0) || count > double(rest_.size()))
      fail(where_ + " has " + std::to_string(int64_t(std::isfinite(count) ? count : -1.0)) +
           " corners; a face needs at least three, and no more than the file holds");
    std::vector<uint32_t> corners;
    for (double n = 0.0; n < count; ++n) {
      const double corner = value(property.type);
      if (!(corner >= 0.0 && corner <= double(UINT32_MAX)) || corner != std::floor(corner))
        fail(where_ + " names a vertex that is no whole number from 0 on");
      corners.push_back(uint32_t(corner));
    }
    for (size_t n = 2; n < corners.size(); ++n)
      mesh_.triangles.push_back({corners[0], corners[n - 1], corners[n]});
  }

  void skip(const Property& property) {
    double count = property.countType ? value(*property.countType) : 1.0;
    if (!(count >= 0.0) || count > double(rest_.size()))
      fail(where_ + " has a list that the file cannot hold");
    for (; count > 0.0; --count) value(property.type);
  }

  std::string_view rest_;
  const std::string& path_;
  int line_ = 0;
  std::optional<bool> format_;  // true: binary
  std::vector<Element> elements_;
  std::string where_ = "the header";
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh parsePly(const std::string& content, const std::string& path) {
  return PlyReader(content, path).read();
}

}  // namespace nephele
