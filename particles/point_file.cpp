// CSV and PLY files of points. Depends on base alone.
#include "particles/point_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>
#include <string_view>

#include "base/error.h"
#include "base/files.h"

namespace nephele {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is read as it lies in memory");

// Coordinates and sizes beyond this are damage or typing errors.
constexpr float kLargest = 1e9f;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\"";
  const size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// Cuts the text before `mark` off the front of `rest`, the mark too.
std::string_view cut(std::string_view& rest, char mark) {
  const std::string_view part = rest.substr(0, rest.find(mark));
  rest.remove_prefix(std::min(part.size() + 1, rest.size()));
  return part;
}

std::vector<std::string_view> partsOf(std::string_view line, char mark) {
  std::vector<std::string_view> parts;
  const bool endsOpen = !line.empty() && line.back() == mark;
  while (!line.empty()) parts.push_back(trimmed(cut(line, mark)));
  if (endsOpen) parts.emplace_back();
  return parts;
}

/// Which array takes each column; nullptr where none does. Refuses a file without x, y, z, with half a
/// velocity, or with two columns of one name.
std::vector<std::vector<float>*> arraysOf(PointSet& points, const std::vector<std::string_view>& names,
                                          const SourceLocation& where) {
  std::vector<std::vector<float>*> arrays;
  for (const std::string_view name : names) {
    arrays.push_back(nullptr);
    for (const PointSet::Column& column : PointSet::columns())
      if (name == column.name && column.values != &PointSet::mass) arrays.back() = &(points.*column.values);
  }
  for (const auto* const values : arrays)
    if (values && std::count(arrays.begin(), arrays.end(), values) > 1) {
      const size_t at = size_t(std::find(arrays.begin(), arrays.end(), values) - arrays.begin());
      throw InputError(where, "names the column '" + std::string(names[at]) + "' twice");
    }
  const auto has = [&](std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const char* const name : {"x", "y", "z"})
    if (!has(name))
      throw InputError(where, std::string("has no column '") + name + "'; points need x, y and z");
  for (const char* const name : {"vx", "vy", "vz"})
    if (!has(name) && (has("vx") || has("vy") || has("vz")))
      throw InputError(where, std::string("has no column '") + name + "'; a velocity needs vx, vy and vz");
  return arrays;
}

std::optional<float> numberOf(std::string_view word) {
  if (word.size() > 1 && word.front() == '+') word.remove_prefix(1);
  float value = 0.0f;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size() || error == std::errc::invalid_argument)
    return std::nullopt;
  return error == std::errc{} ? value : HUGE_VALF;
}

}  // namespace

const std::vector<PointSet::Column>& PointSet::columns() {
  static const std::vector<Column> kColumns{
      {"x", &PointSet::x},           {"y", &PointSet::y},
      {"z", &PointSet::z},           {"vx", &PointSet::vx},
      {"vy", &PointSet::vy},         {"vz", &PointSet::vz},
      {"radius", &PointSet::radius}, {"density", &PointSet::density},
      {"life", &PointSet::life},     {"temperature", &PointSet::temperature},
      {"age", &PointSet::age},       {"mass", &PointSet::mass}};
  return kColumns;
}

void checkPoints(const PointSet& points, const std::string& path, int firstLine) {
  for (const PointSet::Column& column : PointSet::columns()) {
    const std::vector<float>& values = points.*column.values;
    const bool positive = column.values == &PointSet::radius || column.values == &PointSet::life;
    for (size_t n = 0; n < values.size(); ++n) {
      const float v = values[n];
      const bool good = std::abs(v) <= kLargest && !(positive && v <= 0.0f) &&
                        !(column.values == &PointSet::density && v < 0.0f);
      if (good) continue;
      char text[120];
      std::snprintf(text, sizeof text, "point %zu has the %s %g; it must be %s", n, column.name, double(v),
                    positive ? "greater than 0, and at most 1e9" : "finite, and at most 1e9 in size");
      throw InputError({path, firstLine > 0 ? firstLine + int(n) : 0}, text);
    }
  }
}

PointSet parsePointCsv(const std::string& content, const std::string& path) {
  std::string_view rest = content;
  int line = 1;
  const std::vector<std::string_view> names = partsOf(trimmed(cut(rest, '\n')), ',');
  PointSet points;
  const auto arrays = arraysOf(points, names, {path, line});
  while (!rest.empty()) {
    ++line;
    const std::string_view row = trimmed(cut(rest, '\n'));
    if (row.empty()) {
      if (trimmed(rest).find_first_not_of('\n') == std::string_view::npos) break;
      throw InputError({path, line}, "is an empty line among points");
    }
    const auto words = partsOf(row, ',');
    if (words.size() != names.size())
      throw InputError({path, line}, "has " + std::to_string(words.size()) +
                                         " columns where the first line names " +
                                         std::to_string(names.size()));
    for (size_t n = 0; n < words.size(); ++n) {
      if (!arrays[n]) continue;
      const auto value = numberOf(words[n]);
      if (!value)
        throw InputError({path, line}, "column '" + std::string(names[n]) + "' has '" +
                                           std::string(words[n]) + "' where a number belongs");
      arrays[n]->push_back(*value);
    }
  }
  checkPoints(points, path, 2);  // the first point stands on the second line
  return points;
}

namespace {

/// Reads the element `vertex` of a PLY; elements before it may hold no lists.
class PlyPoints {
 public:
  PlyPoints(const std::string& content, const std::string& path) : rest_(content), path_(path) {}

  PointSet read() {
    readHeader();
    for (const Element& element : elements_) {
      if (element.name == "vertex") return readVertices(element);
      for (uint64_t n = 0; n < element.count; ++n)
        for (const Property& property : element.properties) value(property);
    }
    fail("has no element 'vertex'");
  }

 private:
  struct Property {
    std::string name, type;
  };
  struct Element {
    std::string name;
    uint64_t count = 0;
    std::vector<Property> properties;
  };

  [[noreturn]] void fail(const std::string& sentence) const { throw InputError({path_, line_}, sentence); }

  void readHeader() {
    std::optional<bool> binary;
    while (true) {
      if (rest_.empty()) fail("ends inside its header");
      ++line_;
      const std::string_view text = trimmed(cut(rest_, '\n'));
      std::vector<std::string_view> words;
      for (const std::string_view word : partsOf(text, ' '))
        if (!word.empty()) words.push_back(word);
      if (words.empty() || words[0] == "ply" || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() == 3) {
        if (words[1] != "ascii" && words[1] != "binary_little_endian")
          fail("format '" + std::string(words[1]) + "' is not read; write ascii or binary_little_endian");
        binary = words[1] != "ascii";
      } else if (words[0] == "element" && words.size() == 3) {
        uint64_t count = 0;
        const auto [end, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), count);
        if (error != std::errc{} || end != words[2].data() + words[2].size())
          fail("'" + std::string(words[2]) + "' is no count");
        elements_.push_back({std::string(words[1]), count, {}});
      } else if (words[0] == "property" && !elements_.empty() && words.size() == 3) {
        elements_.back().properties.push_back({std::string(words[2]), std::string(words[1])});
      } else if (words[0] == "property" && !elements_.empty() && words.size() == 5 &&
                 elements_.back().name != "vertex") {
        elements_.back().properties.push_back({std::string(words[4]), "list"});
      } else {
        fail("a PLY header of points has no line '" + std::string(words[0]) + "' of this kind here");
      }
    }
    if (!binary) fail("the header names no format");
    binary_ = *binary;
    line_ = binary_ ? 0 : line_ + 1;  // lines mean nothing in binary
  }

  PointSet readVertices(const Element& element) {
    PointSet points;
    std::vector<std::string_view> names;
    for (const Property& property : element.properties) names.push_back(property.name);
    const auto arrays = arraysOf(points, names, {path_, line_});
    // Every value takes at least a byte.
    if (element.count > rest_.size())
      fail("claims " + std::to_string(element.count) + " points, more than the file holds");
    const int first = line_;
    for (uint64_t n = 0; n < element.count; ++n)
      for (size_t k = 0; k < names.size(); ++k) {
        const double v = value(element.properties[k]);
        if (arrays[k]) arrays[k]->push_back(float(v));
      }
    checkPoints(points, path_, binary_ ? 0 : first);
    return points;
  }

  template <class T>
  double raw() {
    if (rest_.size() < sizeof(T)) fail("ends in the middle of its points");
    T v;
    std::memcpy(&v, rest_.data(), sizeof v);
    rest_.remove_prefix(sizeof v);
    return double(v);
  }

  double value(const Property& property) {
    const std::string& type = property.type;
    if (!binary_) return word(property);
    if (type == "float" || type == "float32") return raw<float>();
    if (type == "double" || type == "float64") return raw<double>();
    if (type == "uchar" || type == "uint8") return raw<uint8_t>();
    if (type == "char" || type == "int8") return raw<int8_t>();
    if (type == "ushort" || type == "uint16") return raw<uint16_t>();
    if (type == "short" || type == "int16") return raw<int16_t>();
    if (type == "uint" || type == "uint32") return raw<uint32_t>();
    if (type == "int" || type == "int32") return raw<int32_t>();
    fail("property '" + property.name + "' has the type '" + type + "', which is not read before the points");
  }

  double word(const Property& property) {
    while (!rest_.empty() && std::string_view(" \t\r\n").find(rest_.front()) != std::string_view::npos) {
      line_ += rest_.front() == '\n';
      rest_.remove_prefix(1);
    }
    const std::string_view text = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
    if (text.empty()) fail("ends in the middle of its points");
    const auto number = numberOf(text);
    if (!number)
      fail("property '" + property.name + "' has '" + std::string(text) + "' where a number belongs");
    rest_.remove_prefix(text.size());
    return double(*number);
  }

  std::string_view rest_;
  std::string path_;
  int line_ = 0;
  bool binary_ = false;
  std::vector<Element> elements_;
};

std::vector<PointSet::Column> filledColumns(const PointSet& points) {
  std::vector<PointSet::Column> filled;
  for (const PointSet::Column& column : PointSet::columns())
    if (!(points.*column.values).empty() || column.values == &PointSet::x || column.values == &PointSet::y ||
        column.values == &PointSet::z)
      filled.push_back(column);
  return filled;
}

}  // namespace

PointSet parsePointPly(const std::string& content, const std::string& path) {
  return PlyPoints(content, path).read();
}

PointSet readPointFile(const std::string& path) {
  const std::string content = readWhole(path);
  return content.starts_with("ply") ? parsePointPly(content, path) : parsePointCsv(content, path);
}

void writePointCsv(const std::string& path, const PointSet& points) {
  const auto columns = filledColumns(points);
  std::string text;
  for (const auto& column : columns) text += (text.empty() ? "" : ",") + std::string(column.name);
  text += '\n';
  char number[32];
  for (size_t n = 0; n < points.size(); ++n) {
    for (size_t k = 0; k < columns.size(); ++k) {
      const auto end = std::to_chars(number, number + sizeof number, (points.*columns[k].values)[n]);
      if (k > 0) text += ',';
      text.append(number, end.ptr);
    }
    text += '\n';
  }
  writeText(path, text);
}

void writePointPly(const std::string& path, const PointSet& points) {
  const auto columns = filledColumns(points);
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points.size()) + "\n";
  for (const auto& column : columns) text += "property float " + std::string(column.name) + "\n";
  text += "end_header\n";
  for (size_t n = 0; n < points.size(); ++n)
    for (const auto& column : columns)
      text.append(reinterpret_cast<const char*>(&(points.*column.values)[n]), sizeof(float));
  writeText(path, text);
}

}  // namespace nephele
