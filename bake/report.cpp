// What a bake tells of its files: sentences, and the report as JSON. Depends on run.h.
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bake/run.h"
#include "base/figures.h"

namespace nephele {

namespace {

using Json = nlohmann::ordered_json;

/// `seam` is null where it was not measured with this frame.
Json loopJson(const BakeRecord& record) {
  Json adjusted = Json::array();
  for (const LoopNote& note : record.loopNotes)
    adjusted.push_back(
        {{"field", note.field}, {"parameter", note.parameter}, {"asked", note.asked}, {"used", note.used}});
  Json seam(nullptr);
  if (record.seam)
    seam = {{"frame", record.seam->frame},
            {"largest_difference", record.seam->largestDifference},
            {"content_hash", record.seam->contentHash},
            {"seconds", record.secondsSeam}};
  return {{"frames", *record.loopFrames}, {"seam", seam}, {"adjusted", adjusted}};
}

/// emitted = died + faded + alive, alive = outside_box + splatted, splatted = stored + lost_to_cutoff +
/// lost_to_half.
Json massJson(const MassLedger& m) {
  return {{"emitted", m.emitted},
          {"died", m.died},
          {"faded", m.faded},
          {"alive", m.alive},
          {"outside_box", m.outsideBox},
          {"splatted", m.splatted},
          {"lost_to_cutoff", m.lostToCutoff},
          {"lost_to_half", m.lostToHalf},
          {"stored", m.stored},
          {"particles_emitted", m.countEmitted},
          {"particles_alive", m.countAlive}};
}

Json bandLimitJson(const std::vector<BandLimitNote>& list) {
  Json notes = Json::array();
  for (const BandLimitNote& note : list)
    if (note.squeeze > 0.0)
      notes.push_back({{"field", note.field}, {"squeeze", note.squeeze}});
    else if (note.thickness > 0.0)
      notes.push_back({{"field", note.field}, {"thickness_voxels", note.thickness}});
    else
      notes.push_back({{"field", note.field},
                       {"octave", note.octave},
                       {"cell_voxels", note.cellVoxels},
                       {"weight", note.weight}});
  return notes;
}

std::string precisionName(Precision precision) { return precision == Precision::half ? "half" : "float"; }

/// Errors are the largest difference of optical depth over the largest depth, against half the voxel size.
Json toleranceJson(const Choice& choice) {
  const auto octaves = [](int most) { return most == kAllOctaves ? Json(nullptr) : Json(most); };
  Json tried = Json::array();
  for (const ChoiceTrial& trial : choice.trials)
    tried.push_back({{"voxel_size", trial.voxelSize},
                     {"precision", precisionName(trial.precision)},
                     {"most_octaves", octaves(trial.mostOctaves)},
                     {"density_step", trial.densityStep},
                     {"error", trial.error},
                     {"voxels_about", std::round(trial.voxels)}});
  return {{"asked", choice.asked},
          {"measured", choice.measured},
          {"rays", choice.rays},
          {"voxel_size", choice.asset.voxelSize},
          {"precision", precisionName(choice.asset.precision)},
          {"most_octaves", octaves(choice.asset.mostOctaves)},
          {"density_step", choice.asset.densityStep},
          {"tried", tried},
          {"left_out", choice.leftOut},
          {"seconds", choice.seconds}};
}

}  // namespace

std::string noteAsText(const BandLimitNote& note) {
  // From the map of bakes (docs/stability.md): from there on voxels miss a tenth of an optical depth, and
  // floats no longer say where a place is displaced to.
  constexpr double kFine = 8.0, kChaos = 1e5;
  if (note.squeeze >= kChaos)
    return note.field + ": makes its input " + number(note.squeeze, 2) +
           " times finer: rounding decides what is read";
  if (note.squeeze >= kFine)
    return note.field + ": makes its input " + number(note.squeeze, 2) +
           " times finer, which voxels may not hold";
  if (note.squeeze > 0.0) return {};
  if (note.thickness > 0.0)
    return note.field + ": " + number(note.thickness, 2) +
           " voxels thick: voxels may miss it, or hold more than there is";
  char text[160];
  std::snprintf(text, sizeof text, "%s: octave %d has %.2f voxels a cell: %s", note.field.c_str(),
                note.octave + 1, note.cellVoxels, note.weight > 0.0 ? "weakened" : "left out");
  return text;
}

std::string recordAsText(const BakeRecord& record) {
  std::ostringstream text;
  char line[256] = "up to date\n";
  if (!record.skipped)
    std::snprintf(line, sizeof line, "%.2f million active voxels, %.1f MB, %.2f s (fill %.2f, write %.2f)\n",
                  double(record.voxelsActive) * 1e-6, double(record.bytes) * 1e-6,
                  record.secondsFill + record.secondsHash + record.secondsWrite, record.secondsFill,
                  record.secondsWrite);
  text << record.file << ": " << line;
  for (const BandLimitNote& note : record.bandLimit.value_or(std::vector<BandLimitNote>{})) {
    if (const std::string sentence = noteAsText(note); !record.skipped && !sentence.empty())
      text << "  " << sentence << '\n';
  }
  for (const LoopNote& note : record.loopNotes)
    text << "  " << note.field << ": '" << note.parameter << "' of " << note.asked << " became " << note.used
         << " to close the loop\n";
  if (record.ledger && !record.skipped) {
    const MassLedger& m = *record.ledger;
    std::snprintf(line, sizeof line,
                  "  %llu particles, simulated in %.2f s; mass %.4g, of which the grid holds %.2f%%\n",
                  static_cast<unsigned long long>(m.countAlive), record.secondsSimulate, m.alive,
                  m.alive > 0.0 ? 100.0 * m.stored / m.alive : 100.0);
    text << line;
  }
  if (!record.skipped && !record.velocityHash.empty() && !record.ledger)
    text << "  vel: speeds up to " << record.largestSpeed << " world units per second\n";
  if (record.seam)
    text << "  loop of " << *record.loopFrames << " frames: largest difference "
         << record.seam->largestDifference << " between frames " << *record.frame << " and "
         << record.seam->frame << '\n';
  return text.str();
}

std::string reportAsJson(const std::vector<BakeRecord>& records) {
  Json assets = Json::array();
  for (const BakeRecord& record : records) {
    Json entry{{"name", record.name}, {"file", record.file}};
    entry["frame"] = record.frame ? Json(*record.frame) : Json(nullptr);
    entry["recipe_hash"] = record.recipeHash;
    entry["skipped"] = record.skipped;
    entry["seconds"] = {
        {"fill", record.secondsFill}, {"hash", record.secondsHash}, {"write", record.secondsWrite}};
    entry["voxels_active"] = record.voxelsActive;
    entry["voxels_evaluated"] = record.voxelsEvaluated;
    entry["grid_bytes"] = record.gridBytes;
    entry["bytes"] = record.bytes;
    entry["peak_bytes"] = record.peakBytes;
    entry["content_hash"] = record.contentHash;
    if (!record.skipped) entry["maximum"] = record.maximum;
    entry["mass"] = record.ledger ? massJson(*record.ledger) : Json{{"stored", record.mass}};
    if (record.ledger) entry["seconds"]["simulate"] = record.secondsSimulate;
    entry["band_limit"] = record.bandLimit ? bandLimitJson(*record.bandLimit) : Json(nullptr);
    if (!record.velocityHash.empty()) {
      entry["velocity"] = {{"content_hash", record.velocityHash}};
      if (!record.skipped) {
        entry["velocity"]["largest_speed"] = record.largestSpeed;
        entry["velocity"]["seconds"] = record.secondsVelocity;
      }
    }
    if (record.choice) entry["tolerance"] = toleranceJson(*record.choice);
    if (record.loopFrames) entry["loop"] = loopJson(record);
    assets.push_back(std::move(entry));
  }
  return Json{{"assets", std::move(assets)}}.dump(2) + "\n";
}

}  // namespace nephele
