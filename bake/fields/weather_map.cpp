// Clouds over the ground from a picture: the row weather_map. Depends on envelope_field.h for complaints,
// base/picture.h and shared text.
#include <algorithm>
#include <cmath>

#include "bake/fields/envelope_field.h"
#include "bake/fields/rows.h"
#include "base/picture.h"

namespace nephele {
namespace {

enum Channel { kCoverage, kType, kTop, kChannels };

/// Texels of one channel with the least and greatest of 2 × 2, 4 × 4, … of them.
class Plane {
 public:
  Plane(int width, int height, std::vector<float> texels) : texels_(std::move(texels)) {
    Level level{width, height, {}};
    for (const float v : texels_) level.cells.push_back({double(v), double(v)});
    levels_.push_back(std::move(level));
    while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
  }

  float at(int x, int y) const { return texels_[size_t(y) * size_t(levels_[0].width) + size_t(x)]; }

  /// Over texels x0 … x1, y0 … y1, both ends included and inside the picture.
  Interval over(int x0, int x1, int y0, int y1) const {
    size_t k = 0;
    // At the first level where the span touches at most two or three cells, more precision would not pay.
    while (k + 1 < levels_.size() && std::max(x1 - x0, y1 - y0) >> k > 2) ++k;
    const Level& level = levels_[k];
    Interval all = level.cell(x0 >> k, y0 >> k);
    for (int y = y0 >> k; y <= y1 >> k; ++y)
      for (int x = x0 >> k; x <= x1 >> k; ++x) all = hullOf(all, level.cell(x, y));
    return all;
  }

 private:
  struct Level {
    int width, height;
    std::vector<Interval> cells;
    const Interval& cell(int x, int y) const { return cells[size_t(y) * size_t(width) + size_t(x)]; }
  };

  static Level halved(const Level& fine) {
    Level level{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
    for (int y = 0; y < level.height; ++y)
      for (int x = 0; x < level.width; ++x) {
        const int right = std::min(2 * x + 1, fine.width - 1), down = std::min(2 * y + 1, fine.height - 1);
        level.cells.push_back(hullOf(hullOf(fine.cell(2 * x, 2 * y), fine.cell(right, 2 * y)),
                                     hullOf(fine.cell(2 * x, down), fine.cell(right, down))));
      }
    return level;
  }

  std::vector<float> texels_;
  std::vector<Level> levels_;
};

struct WeatherPicture {
  int width = 0, height = 0;
  std::vector<Plane> planes;  // by Channel
};

/// R or Y is the coverage; without G all is cumulus, without B all reaches the top. Throws InputError.
WeatherPicture readWeather(const std::string& path) {
  Picture picture = readExr(path);
  WeatherPicture weather{picture.width, picture.height, {}};
  const char* const names[kChannels] = {"R", "G", "B"};
  for (int channel = 0; channel < kChannels; ++channel) {
    int plane = picture.find(names[channel]);
    if (plane < 0 && channel == kCoverage) plane = picture.find("Y");
    if (plane < 0 && channel == kCoverage)
      throw InputError({path}, "has neither a channel R nor a channel Y for the coverage");
    std::vector<float> texels = plane < 0
                                    ? std::vector<float>(size_t(picture.width) * size_t(picture.height), 1.0f)
                                    : picture.planes[size_t(plane)];
    for (size_t n = 0; n < texels.size(); ++n)
      if (!(texels[n] >= 0.0f && texels[n] <= 1.0f))
        throw InputError({path}, "holds " + std::to_string(texels[n]) + " in channel " +
                                     picture.names[size_t(plane)] + " at pixel (" +
                                     std::to_string(n % size_t(picture.width)) + ", " +
                                     std::to_string(n / size_t(picture.width)) + "); it must be 0 to 1");
    weather.planes.emplace_back(picture.width, picture.height, std::move(texels));
  }
  return weather;
}

/// Where the map lies: the low corner of its rectangle, in world units along the two ground axes.
struct MapPlace {
  std::array<double, 2> origin, size;
  double base, top;  // heights
  int upAxis;        // 1: y, ground x and z; 2: z, ground x and y
  bool endless;      // the edge goes on outside
};

class WeatherMap final : public Field {
 public:
  WeatherMap(WeatherPicture picture, const MapPlace& place) : map_(std::move(picture)), place_(place) {}

  void evaluate(const Points& points, float* values) const override {
    for (size_t n = 0; n < points.count; ++n)
      values[n] =
          valueAt(points.origin + glm::dvec3(double(points.x[n]), double(points.y[n]), double(points.z[n])));
  }

  Interval bounds(const Box& box) const override {
    const int side = sideAxis();
    const double room = 1e-6 * (lengthOf(box.halfSize()) + 1e-6 * lengthOf(greatestMagnitudes(box)));
    const auto [u0, u1] = sorted(across(box.low.x - room), across(box.high.x + room));
    const auto [v0, v1] = sorted(down(box.low[side] - room), down(box.high[side] + room));
    const double h0 = heightOf(box.low[place_.upAxis] - room), h1 = heightOf(box.high[place_.upAxis] + room);
    const bool apart = u1 < 0.0 || u0 > 1.0 || v1 < 0.0 || v0 > 1.0;
    if (h1 < 0.0 || h0 > 1.0 || (apart && !place_.endless)) return {0.0, 0.0};
    const auto texels = [](double from, double to, int count) {
      const auto held = [count](double v) { return int(std::clamp(v, 0.0, double(count - 1))); };
      // Half a texel for the bilinear filter, and a thousandth for rounding.
      return std::pair{held(std::floor(from * count - 0.501)), held(std::ceil(to * count - 0.499))};
    };
    const auto [x0, x1] = texels(u0, u1, map_.width);
    const auto [y0, y1] = texels(v0, v1, map_.height);
    Interval value = over(x0, x1, y0, y1, h0, h1);
    const bool beyond = u0 < 0.0 || u1 > 1.0 || v0 < 0.0 || v1 > 1.0;
    if (beyond && !place_.endless) value.low = 0.0;
    return value;
  }

  Box support() const override {
    Box box;
    // A hair for the rounding of heights and places.
    const auto hair = [](double a, double b) { return 1e-9 * (std::abs(a) + std::abs(b)); };
    const double up = hair(place_.base, place_.top);
    box.low[place_.upAxis] = place_.base - up;
    box.high[place_.upAxis] = place_.top + up;
    if (place_.endless) return box;
    const int axes[2] = {0, sideAxis()};
    for (size_t n = 0; n < 2; ++n) {
      const double room = hair(place_.origin[n], place_.size[n]);
      box.low[axes[n]] = place_.origin[n] - room;
      box.high[axes[n]] = place_.origin[n] + place_.size[n] + room;
    }
    return box;
  }

 private:
  int sideAxis() const { return place_.upAxis == 1 ? 2 : 1; }
  /// The picture's u to the right and v downwards, in [0, 1] on the map. Its top is +y where z is up, −z
  /// where y is up: as a map lies when looked at from above.
  double across(double x) const { return (x - place_.origin[0]) / place_.size[0]; }
  double down(double side) const {
    const double share = (side - place_.origin[1]) / place_.size[1];
    return place_.upAxis == 1 ? share : 1.0 - share;
  }
  double heightOf(double up) const { return (up - place_.base) / (place_.top - place_.base); }
  static std::pair<double, double> sorted(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

  float valueAt(const glm::dvec3& p) const {
    const double u = across(p.x), v = down(p[sideAxis()]), height = heightOf(p[place_.upAxis]);
    if (height < 0.0 || height > 1.0) return 0.0f;
    if (!place_.endless && (u < 0.0 || u > 1.0 || v < 0.0 || v > 1.0)) return 0.0f;
    const double x = std::clamp(u * map_.width - 0.5, 0.0, map_.width - 1.0),
                 y = std::clamp(v * map_.height - 0.5, 0.0, map_.height - 1.0);
    const int x0 = int(x), y0 = int(y), x1 = std::min(x0 + 1, map_.width - 1),
              y1 = std::min(y0 + 1, map_.height - 1);
    const float fx = float(x - x0), fy = float(y - y0);
    float read[kChannels];
    for (size_t c = 0; c < kChannels; ++c) {
      const Plane& plane = map_.planes[c];
      const float upper = (1.0f - fx) * plane.at(x0, y0) + fx * plane.at(x1, y0);
      const float lower = (1.0f - fx) * plane.at(x0, y1) + fx * plane.at(x1, y1);
      read[c] = (1.0f - fy) * upper + fy * lower;
    }
    if (!(read[kTop] > 0.0f)) return 0.0f;
    const float share = float(height) / read[kTop];
    const float profile =
        shared::mixedProfile(shared::stratusProfile(share), shared::stratocumulusProfile(share),
                             shared::cumulusProfile(share), read[kType]);
    return shared::coveredProfile(profile, read[kCoverage]);
  }

  /// Over texels and heights. The value grows with coverage and profile; the profile is linear in the type
  /// between 0, ½ and 1, and each of its three parts rises and falls once.
  Interval over(int x0, int x1, int y0, int y1, double h0, double h1) const {
    const Interval coverage = map_.planes[kCoverage].over(x0, x1, y0, y1),
                   type = map_.planes[kType].over(x0, x1, y0, y1),
                   top = map_.planes[kTop].over(x0, x1, y0, y1);
    if (top.high <= 0.0) return {0.0, 0.0};
    constexpr double kFar = 1e30;  // share of a layer of no height
    const Interval share{std::max(h0, 0.0) / top.high * (1.0 - kRoom),
                         std::min(top.low > 0.0 ? h1 / top.low : kFar, kFar) * (1.0 + kRoom)};
    const Interval parts[3] = {profileOver(shared::stratusProfile, share),
                               profileOver(shared::stratocumulusProfile, share),
                               profileOver(shared::cumulusProfile, share)};
    const auto mixed = [&](double t, double Interval::*end) {
      return double(
          shared::mixedProfile(float(parts[0].*end), float(parts[1].*end), float(parts[2].*end), float(t)));
    };
    double low = std::min(mixed(type.low, &Interval::low), mixed(type.high, &Interval::low)),
           high = std::max(mixed(type.low, &Interval::high), mixed(type.high, &Interval::high));
    if (type.low < 0.5 && type.high > 0.5) {
      low = std::min(low, mixed(0.5, &Interval::low));
      high = std::max(high, mixed(0.5, &Interval::high));
    }
    // Outside of the layer, where h0 or h1 lie, the value is 0.
    if (h0 < 0.0 || h1 > 1.0) low = 0.0;
    return {std::max(low + coverage.low - 1.0 - kRoom, 0.0),
            std::max(high + coverage.high - 1.0 + kRoom, 0.0)};
  }

  /// Profiles rise, stay and fall: least at an end, greatest at an end or, where the ends lie on both sides
  /// of a point of the plateau, 1 there.
  static Interval profileOver(float (*profile)(float), const Interval& share) {
    const double a = double(profile(float(share.low))), b = double(profile(float(share.high)));
    double most = std::max(a, b);
    // Full somewhere in (0.05, 0.7); these points are on the plateau of one type or another.
    for (const float full : {0.05f, 0.1f, 0.2f, 0.42f, 0.12f, 0.7f})
      if (share.low <= double(full) && double(full) <= share.high)
        most = std::max(most, double(profile(full)));
    // Profiles are no steeper than 1 in 0.05: float rounding of the share is below room / 20.
    return {std::max(std::min(a, b) - kRoom, 0.0), std::min(most + kRoom, 1.0)};
  }

  static constexpr double kRoom = 4e-6;

  WeatherPicture map_;
  MapPlace place_;
};

Complaint validateWeather(const Arguments& a) {
  if (!(a.number("base") < a.number("top"))) return {{"top", "'top' must lie above 'base'"}};
  readWeather(a.file("file"));
  return std::nullopt;
}

}  // namespace

FieldRow weatherMapRow() {
  return {
      "weather_map",
      "A layer of clouds from a picture of the ground seen from above: red is coverage, green the type (0 "
      "stratus, 0.5 stratocumulus, 1 cumulus), blue the height of its top; max(0, profile + coverage - 1).",
      {{"file", ParameterType::file,
        "An EXR with channels R, G and B, each 0 to 1. Without G all is cumulus, without B all reaches "
        "`top`.",
        std::nullopt},
       {"origin", ParameterType::pair, "The map's corner of least coordinates on the ground.",
        Value{std::array<double, 2>{-1, -1}}, kAny, "world units"},
       {"size", ParameterType::pair, "Its extent on the ground.", Value{std::array<double, 2>{2, 2}},
        kPositive, "world units"},
       {"base", ParameterType::number, "Height of the layer's bottom.", Value{-0.25}, kAny, "world units"},
       {"top", ParameterType::number, "Height of a cloud whose blue is 1.", Value{0.5}, kAny, "world units"},
       {"outside",
        ParameterType::choice,
        "Beside the map: nothing, or its edge going on.",
        Value{std::string("nothing")},
        {},
        {},
        {"nothing", "edge"}}},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        return std::make_shared<WeatherMap>(
            readWeather(a.file("file")),
            MapPlace{a.pair("origin"), a.pair("size"), a.number("base"), a.number("top"), context.upAxis,
                     a.choice("outside") == "edge"});
      },
      validateWeather};
}

}  // namespace nephele
