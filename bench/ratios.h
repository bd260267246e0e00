// Two sides of one comparison, timed by turns in one run: a ratio of minima that other work on the machine
// hardly moves. A table for people, JSON for scripts. Depends on the standard library and nlohmann_json.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <regex>
#include <string>
#include <vector>

namespace nephele::bench {

/// What a comparison must reach; none where the figure is reported alone.
struct Target {
  enum class Kind { none, atLeast, atMost } kind = Kind::none;
  double value = 0.0;
};
inline Target atLeast(double value) { return {Target::Kind::atLeast, value}; }
inline Target atMost(double value) { return {Target::Kind::atMost, value}; }

/// One line of the table. `figure` is what the target judges: a ratio, or megabytes.
struct Line {
  std::string name;
  double figure = 0.0;
  std::string unit;  // "x", "%", "MB"
  Target target;
  std::optional<double> oursSeconds, theirsSeconds;
  std::optional<double> cpuFigure;  // the same ratio of processor time, which other work moves less
  std::string hash;                 // of our result: a speed-up that changes it is none

  bool reached() const {
    if (target.kind == Target::Kind::none) return true;
    return target.kind == Target::Kind::atLeast ? figure >= target.value : figure <= target.value;
  }
};

/// Seconds on the clock, and of all threads' processor time.
struct Seconds {
  double clock = std::numeric_limits<double>::infinity();
  double cpu = std::numeric_limits<double>::infinity();
};
/// What one call takes.
Seconds secondsOf(const std::function<void()>& run);

/// The least of each over the repeats.
struct Minima {
  Seconds ours, theirs;
};

/// Runs both sides by turns, `repeats` times each after one turn that does not count.
Minima pairedMinima(const std::function<void()>& ours, const std::function<void()>& theirs, int repeats);

/// Prints lines as they come to stdout.
class Table {
 public:
  explicit Table(const std::string& filter) : filter_(filter) {}
  /// Whether the filter asks for a comparison of that name: ask before computing anything for it.
  bool wants(const std::string& name) const { return std::regex_search(name, filter_); }
  void add(const Line& line);
  /// theirs/ours, in "x".
  void addSpeedup(const std::string& name, const Minima& minima, const Target& target,
                  const std::string& hash);
  /// Throws std::runtime_error where the file cannot be written.
  void writeJson(const std::string& path) const;

 private:
  std::regex filter_;
  std::vector<Line> lines_;
};

}  // namespace nephele::bench
