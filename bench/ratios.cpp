// Timing by turns, the table and its JSON. Depends on ratios.h.
#include "bench/ratios.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace nephele::bench {
namespace {

std::string shownTarget(const Target& target) {
  if (target.kind == Target::Kind::none) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%s %.4g",
                target.kind == Target::Kind::atLeast ? ">=" : "<=", target.value);
  return text;
}

/// User and system time of this process so far.
double processorSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr double kMicrosecond = 1e-6;
  return double(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         kMicrosecond * double(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

}  // namespace

Seconds secondsOf(const std::function<void()>& run) {
  const double cpu = processorSeconds();
  const auto start = std::chrono::steady_clock::now();
  run();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          processorSeconds() - cpu};
}

Minima pairedMinima(const std::function<void()>& ours, const std::function<void()>& theirs, int repeats) {
  Minima minima;
  const auto lower = [](Seconds& least, const Seconds& now) {
    least = {std::min(least.clock, now.clock), std::min(least.cpu, now.cpu)};
  };
  for (int turn = 0; turn <= repeats; ++turn) {
    const Seconds o = secondsOf(ours), t = secondsOf(theirs);
    if (turn == 0) continue;
    lower(minima.ours, o);
    lower(minima.theirs, t);
  }
  return minima;
}

void Table::add(const Line& line) {
  if (lines_.empty())
    std::printf("%-44s %9s %12s %7s %8s %10s %10s  %s\n", "comparison", "figure", "target", "", "by cpu",
                "ours ms", "theirs ms", "hash of ours");
  const auto milliseconds = [](const std::optional<double>& seconds) {
    constexpr double kMilliseconds = 1000.0;
    char text[32] = "-";
    if (seconds) std::snprintf(text, sizeof text, "%.2f", *seconds * kMilliseconds);
    return std::string(text);
  };
  const char* const verdict = line.target.kind == Target::Kind::none ? ""
                              : line.reached()                       ? "reached"
                                                                     : "MISSED";
  char byCpu[32] = "-";
  if (line.cpuFigure) std::snprintf(byCpu, sizeof byCpu, "%.2f", *line.cpuFigure);
  std::printf("%-44s %7.2f %-2s %11s %7s %8s %10s %10s  %s\n", line.name.c_str(), line.figure,
              line.unit.c_str(), shownTarget(line.target).c_str(), verdict, byCpu,
              milliseconds(line.oursSeconds).c_str(), milliseconds(line.theirsSeconds).c_str(),
              line.hash.c_str());
  std::fflush(stdout);
  lines_.push_back(line);
}

void Table::addSpeedup(const std::string& name, const Minima& minima, const Target& target,
                       const std::string& hash) {
  add({name, minima.theirs.clock / minima.ours.clock, "x", target, minima.ours.clock, minima.theirs.clock,
       minima.theirs.cpu / minima.ours.cpu, hash});
}

void Table::writeJson(const std::string& path) const {
  nlohmann::json list = nlohmann::json::array();
  for (const Line& line : lines_) {
    nlohmann::json entry{{"name", line.name}, {"figure", line.figure}, {"unit", line.unit}};
    if (line.target.kind != Target::Kind::none) {
      entry[line.target.kind == Target::Kind::atLeast ? "at_least" : "at_most"] = line.target.value;
      entry["reached"] = line.reached();
    }
    if (line.oursSeconds) entry["seconds_ours"] = *line.oursSeconds;
    if (line.theirsSeconds) entry["seconds_theirs"] = *line.theirsSeconds;
    if (line.cpuFigure) entry["figure_by_cpu"] = *line.cpuFigure;
    if (!line.hash.empty()) entry["hash"] = line.hash;
    list.push_back(entry);
  }
  std::ofstream file(path);
  file << nlohmann::json{{"ratios", list}}.dump(2) << '\n';
  if (!file) throw std::runtime_error("cannot write '" + path + "'");
}

}  // namespace nephele::bench
