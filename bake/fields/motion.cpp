// How noise moves and how its motion closes. Depends on motion.h.
#include "bake/fields/motion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace nephele {
namespace {

/// (cycles · frame mod frames)/frames: the share of a cycle that is done, from whole numbers alone.
double shareDone(int64_t cycles, const Loop& loop) {
  const auto mod = [&](int64_t n) { return (n % loop.frames + loop.frames) % loop.frames; };
  return double(mod(mod(cycles) * mod(loop.frame))) / double(loop.frames);
}

double seconds(const Loop& loop) { return double(loop.frames) / loop.fps; }

double fineness(const Motion& motion, int64_t octave) {
  return motion.octaves > 1 ? double(octave) / double(motion.octaves - 1) : 0.0;
}

/// Periods that a speed passes in the loop, to the nearest whole one.
int64_t wholePeriods(double speed, const Motion& motion, const Loop& loop) {
  return motion.period > 0.0 ? std::llround(speed * seconds(loop) / motion.period) : 0;
}

/// The same for an octave: its own share of what the last octave has on top.
int64_t octavePeriods(const Motion& motion, int64_t octave, int axis, const Loop& loop) {
  const double fine = double(wholePeriods(motion.fineScroll[axis], motion, loop));
  return wholePeriods(motion.scroll[axis], motion, loop) + std::llround(fineness(motion, octave) * fine);
}

int64_t wholeTurns(const Motion& motion, int64_t octave, const Loop& loop) {
  return std::llround(motion.evolve * seconds(loop) * evolveRate(motion.lacunarity, octave));
}

/// The speed that the loop makes of the one asked for.
glm::dvec3 closedSpeed(const glm::dvec3& speed, const Motion& motion, const Loop& loop) {
  glm::dvec3 closed(0.0);
  for (int axis = 0; axis < 3; ++axis)
    closed[axis] = double(wholePeriods(speed[axis], motion, loop)) * motion.period / seconds(loop);
  return closed;
}

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string shown(const glm::dvec3& v) {
  return "[" + shown(v.x) + ", " + shown(v.y) + ", " + shown(v.z) + "]";
}

std::string framesText(const Loop& loop) {
  return "a loop of " + std::to_string(loop.frames) + " frames at " + shown(loop.fps) + " per second";
}

void complainOfScroll(std::string_view name, const glm::dvec3& speed, const Motion& motion, const Loop& loop,
                      std::vector<std::pair<std::string_view, std::string>>& out) {
  if (speed == glm::dvec3(0.0)) return;
  if (!motion.repeats) {
    out.emplace_back(
        name, "'" + std::string(name) +
                  "' carries its input away, so the loop cannot close; scroll a noise with a period in "
                  "place of it");
    return;
  }
  if (motion.period <= 0.0) {
    out.emplace_back(name,
                     "'" + std::string(name) +
                         "' moves a pattern that never repeats, so the loop cannot close; give 'period', the "
                         "cells after which the pattern repeats, or 'evolve' in place of it");
    return;
  }
  constexpr double kMostPeriods = 1e9;  // counted in whole numbers without loss
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(speed[axis]) * seconds(loop) / motion.period < kMostPeriods)) {
      out.emplace_back(name,
                       "'" + std::string(name) + "' passes more than 10^9 periods in " + framesText(loop));
      return;
    }
    if (speed[axis] != 0.0 && wholePeriods(speed[axis], motion, loop) == 0) {
      out.emplace_back(name, "'" + std::string(name) + "' of " + shown(speed[axis]) + " along " +
                                 "xyz"[axis] + " does not pass half a period of " + shown(motion.period) +
                                 " in " + framesText(loop) + "; give 0, " +
                                 shown(motion.period / seconds(loop)) + " or a multiple of it");
      return;
    }
  }
}

}  // namespace

double evolveRate(double lacunarity, int64_t octave) {
  // The cube root by Newton's method, whose steps fall from above; 64 halve any first guess in range to the
  // end.
  double root = std::max(1.0, lacunarity);
  for (int n = 0; n < 64; ++n) root = (2.0 * root + lacunarity / (root * root)) / 3.0;
  double rate = 1.0;
  for (int64_t n = 0; n < octave; ++n) rate *= root * root;
  return rate;
}

OctavePlace octavePlace(const Motion& motion, int64_t octave, const BuildContext& context) {
  OctavePlace place;
  if (context.loop) {
    for (int axis = 0; axis < 3; ++axis)
      place.offset[axis] =
          motion.period * shareDone(octavePeriods(motion, octave, axis, *context.loop), *context.loop);
    if (motion.evolve != 0.0)
      place.turn = turnAt(shareDone(wholeTurns(motion, octave, *context.loop), *context.loop));
    return place;
  }
  place.offset = context.time * (motion.scroll + fineness(motion, octave) * motion.fineScroll);
  if (motion.evolve != 0.0)
    place.turn = turnAt(context.time * motion.evolve * evolveRate(motion.lacunarity, octave));
  return place;
}

glm::dvec3 meanScroll(const Motion& motion, const BuildContext& context) {
  // Shares of the fine scroll run evenly from 0 to 1.
  const double mean = motion.octaves > 1 ? 0.5 : 0.0;
  if (!context.loop) return motion.scroll + mean * motion.fineScroll;
  return closedSpeed(motion.scroll, motion, *context.loop) +
         mean * closedSpeed(motion.fineScroll, motion, *context.loop);
}

std::vector<std::pair<std::string_view, std::string>> loopComplaints(const Motion& motion, const Loop& loop) {
  std::vector<std::pair<std::string_view, std::string>> out;
  complainOfScroll("scroll", motion.scroll, motion, loop, out);
  complainOfScroll("fine_scroll", motion.fineScroll, motion, loop, out);
  if (motion.evolve != 0.0 && wholeTurns(motion, 0, loop) == 0)
    out.emplace_back("evolve", "'evolve' of " + shown(motion.evolve) + " does not make half a turn in " +
                                   framesText(loop) + "; give 0, " + shown(1.0 / seconds(loop)) +
                                   " or a multiple of it");
  return out;
}

std::vector<LoopNote> loopNotes(const Motion& motion, const Loop& loop, std::string_view field) {
  std::vector<LoopNote> notes;
  const auto noteScroll = [&](const char* name, const glm::dvec3& asked) {
    const glm::dvec3 used = closedSpeed(asked, motion, loop);
    if (used != asked) notes.push_back({std::string(field), name, shown(asked), shown(used)});
  };
  noteScroll("scroll", motion.scroll);
  noteScroll("fine_scroll", motion.fineScroll);
  const double turns = double(wholeTurns(motion, 0, loop)) / seconds(loop);
  if (turns != motion.evolve)
    notes.push_back({std::string(field), "evolve", shown(motion.evolve), shown(turns)});
  return notes;
}

}  // namespace nephele
