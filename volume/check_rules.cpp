// The rules, numbered as they are printed: what a .vdb must be to open well in Blender, Houdini and the rest.
// Depends on base, check.h and vdb_header.h; knows no OpenVDB.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <limits>
#include <set>

#include "base/figures.h"
#include "volume/check.h"
#include "volume/provenance.h"
#include "volume/vdb_header.h"

namespace nephele {
namespace {

/// What a rule finds: the worst that was said, and all of it.
class Finding {
 public:
  void yes(const std::string& sentence) { say(Holds::yes, sentence); }
  void note(const std::string& sentence) { say(Holds::note, sentence); }
  void no(const std::string& sentence) { say(Holds::no, sentence); }
  void notAsked(const std::string& why) {
    said_.clear();
    holds_ = Holds::notAsked;
    say(Holds::notAsked, why);
  }
  /// `otherwise`: where nothing was said.
  Verdict verdict(int rule, const std::string& name, const std::string& otherwise) const {
    return {rule, name, holds_, said_.empty() ? otherwise : said_};
  }

 private:
  void say(Holds holds, const std::string& sentence) {
    holds_ = std::max(holds_, holds);
    said_ += (said_.empty() ? "" : "; ") + sentence;
  }
  Holds holds_ = Holds::yes;
  std::string said_;
};

struct Rule {
  std::string name;
  void (*look)(const FileFacts&, const Audience&, Finding&);
  std::string otherwise;  // the sentence where it finds nothing to say
};

constexpr int kDigits = 6;  // of figures in sentences
constexpr const char* kDensity = "density";
constexpr const char* kFloatTree = "Tree_float_5_4_3";
constexpr const char* kVectorTree = "Tree_vec3s_5_4_3";

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string quoted(const GridFacts& grid) { return "'" + grid.info.name + "'"; }

const GridFacts* densityOf(const FileFacts& facts) {
  for (const GridFacts& grid : facts.grids)
    if (grid.info.name == kDensity) return &grid;
  return nullptr;
}

bool isOurs(const FileFacts& facts) {
  const auto creator = facts.metadata.find("creator");
  const std::string ours = creatorName();
  return creator != facts.metadata.end() && creator->second.starts_with(ours.substr(0, ours.find(' ') + 1));
}

bool isPoints(const GridFacts& grid) { return grid.info.type.starts_with("pt"); }

void density(const FileFacts& facts, const Audience&, Finding& found) {
  std::map<std::string, int> names;
  for (const GridFacts& grid : facts.grids) ++names[grid.info.name];
  for (const auto& [name, count] : names)
    if (count > 1) found.no(std::to_string(count) + " grids are called '" + name + "'");
  const GridFacts* grid = densityOf(facts);
  if (grid == nullptr) {
    found.no("there is no grid 'density'");
    for (const auto& [name, count] : names)
      if (lower(name) == kDensity) found.no("'" + name + "' should be written in lower case");
    return;
  }
  const std::string& gridClass = grid->info.gridClass;
  if (grid->tree != kFloatTree) found.no("'density' is a " + grid->tree + ", not a " + kFloatTree);
  if (gridClass == "unknown")
    found.note("the class of 'density' is unknown, and readers guess");
  else if (gridClass != "fog volume")
    found.no("'density' is a " + gridClass + ", not a fog volume");
  if (grid->background.value_or(0.0) != 0.0)
    found.no("outside of its voxels 'density' is " + number(*grid->background, kDigits) + ", not 0");
}

void otherGrids(const FileFacts& facts, const Audience& audience, Finding& found) {
  static const std::set<std::string> kScalars{"temperature", "flame", "heat"};
  static const std::set<std::string> kVelocities{"velocity", "vel", "v"};
  for (const GridFacts& grid : facts.grids) {
    const std::string& name = grid.info.name;
    if (name == kDensity || isPoints(grid)) continue;
    if (kScalars.contains(name)) {
      if (grid.tree != kFloatTree) found.no(quoted(grid) + " is a " + grid.tree + ", not a " + kFloatTree);
    } else if (kVelocities.contains(name)) {
      if (grid.tree != kVectorTree) found.no(quoted(grid) + " is a " + grid.tree + ", not a " + kVectorTree);
      if (grid.vectorType != "contravariant relative")
        found.note(quoted(grid) + " is a vector of type " + grid.vectorType + ", not contravariant relative");
      if (audience.houdini && name != "vel") found.note("Houdini looks for velocity under 'vel'");
    } else if (name == "color") {
      if (grid.tree != kVectorTree) found.no("'color' is a " + grid.tree + ", not a " + kVectorTree);
    } else {
      found.note("no program looks for " + quoted(grid) + " by itself");
    }
  }
  const bool points = std::all_of(facts.grids.begin(), facts.grids.end(), isPoints);
  if (audience.blender && points && !facts.grids.empty()) found.no("Blender refuses a file of points alone");
}

void half(const FileFacts& facts, const Audience&, Finding& found) {
  for (const std::string& tree : facts.unknownTrees)
    found.no("readers of OpenVDB " + std::string("stop at ") + tree +
             (tree.find("half") != std::string::npos ? "; half is a way to store a float grid" : ""));
  std::string stored;
  for (const GridFacts& grid : facts.grids)
    if (grid.info.half) stored += (stored.empty() ? "" : ", ") + quoted(grid);
  if (!stored.empty()) found.yes("stored as half: " + stored);
}

void values(const FileFacts& facts, const Audience&, Finding& found) {
  for (const GridFacts& grid : facts.grids) {
    const auto count = [&](uint64_t numbers, const std::string& what) {
      return std::to_string(numbers) + " of " + quoted(grid) + what;
    };
    if (grid.notFinite > 0) found.no(count(grid.notFinite, " are not finite"));
    if (grid.aboveHalf > 0)
      found.note(count(grid.aboveHalf, " are above 65504, which half turns to infinity"));
    if (grid.belowHalf > 0) found.note(count(grid.belowHalf, " are below 6e-8, which half loses"));
  }
}

void format(const FileFacts& facts, const Audience&, Finding& found) {
  constexpr uint32_t kEverywhere = 224, kOldest = 222;
  const std::string version = "version " + std::to_string(facts.fileVersion);
  if (facts.fileVersion > kEverywhere)
    found.no(version + ": programs of today may read up to " + std::to_string(kEverywhere));
  else if (facts.fileVersion < kOldest)
    found.note(version + ", an old layout");
  else
    found.yes(version);
  std::set<std::string> codecs;
  for (const GridFacts& grid : facts.grids) {
    const uint32_t flags = grid.compression.value_or(kBlosc);
    if ((flags & kBlosc) == 0)
      codecs.insert((flags & kZip) != 0 ? "compressed by zip, larger and slower than Blosc"
                                        : "not compressed");
  }
  for (const std::string& codec : codecs) found.note(codec);
}

void scale(const FileFacts& facts, const Audience& audience, Finding& found) {
  constexpr double kDropped = 0.001, kMostFaint = 0.1;
  const GridFacts* grid = densityOf(facts);
  if (!audience.blender) return found.notAsked("of Blender alone");
  if (grid == nullptr || !(grid->mass > 0.0)) return found.notAsked("there is no density");
  const double faint = grid->faintMass / grid->mass;
  const std::string share = percent(faint) + " of the mass lies below " + number(kFaintDensity);
  if (grid->largest <= kDropped)
    found.no("the largest density is " + number(grid->largest, kDigits) +
             "; Blender's viewport draws nothing below 0.001");
  else if (faint > kMostFaint)
    found.note(share + "; Blender's viewport draws nothing below 0.001");
  else
    found.yes("largest density " + number(grid->largest, kDigits) + "; " + share);
}

void creator(const FileFacts& facts, const Audience& audience, Finding& found) {
  const auto named = facts.metadata.find("creator"), up = facts.metadata.find("up_axis");
  if (named == facts.metadata.end()) return found.note("no creator is named");
  found.yes(named->second);
  if (named->second.starts_with("Houdini") && audience.blender)
    found.note("Blender's import turns it by 90 degrees about X");
  if (!isOurs(facts)) return;
  if (up == facts.metadata.end() || (up->second != "y" && up->second != "z"))
    return found.no("up_axis is neither y nor z");
  found.yes("up_axis " + up->second);
  if (up->second == "y" && audience.blender && !audience.houdini)
    found.note("it lies on its side in Blender: bake with up_axis: z");
  if (up->second == "z" && audience.houdini && !audience.blender)
    found.note("it lies on its side in Houdini: bake with up_axis: y");
}

void provenance(const FileFacts& facts, const Audience&, Finding& found) {
  if (!isOurs(facts)) return found.notAsked("of our own files alone");
  for (const char* key : {"recipe_hash", "seed"})
    if (!facts.metadata.contains(key)) found.no(std::string("it does not say its ") + key);
  if (!facts.metadata.contains("sigma_s") && densityOf(facts) != nullptr)
    found.note("it names no medium, and each program takes its own");
}

void topology(const FileFacts& facts, const Audience& audience, Finding& found) {
  for (const GridFacts& grid : facts.grids) {
    const std::string name = quoted(grid);
    if (audience.blender && grid.info.tiles > 0 && grid.info.leaves == 0)
      found.no("Blender draws nothing of " + name + ", which has tiles alone");
    if (grid.emptyLeaves > 0)
      found.note(std::to_string(grid.emptyLeaves) + " leaves of " + name + " hold no active voxel");
    if (grid.constantLeaves > 0 && grid.info.leaves > 1)  // one may be there for Blender
      found.note(std::to_string(grid.constantLeaves) + " leaves of " + name +
                 " are constant: it is not pruned");
  }
}

void box(const FileFacts& facts, const Audience&, Finding& found) {
  constexpr int64_t kWidest = 2048;
  for (const GridFacts& grid : facts.grids) {
    if (grid.info.activeVoxels == 0) continue;
    int64_t widest = 0;
    std::string size;
    for (int axis = 0; axis < 3; ++axis) {
      const int64_t edge = int64_t{grid.info.boxMax[axis]} - grid.info.boxMin[axis];
      widest = std::max(widest, edge);
      size += (axis > 0 ? " x " : "") + std::to_string(edge);
    }
    const std::string sentence = quoted(grid) + ": " + size + " voxels, " + sizeText(grid.info.denseBytes) +
                                 " where the whole box is filled";
    if (widest > kWidest)
      found.note(sentence + ", more than " + std::to_string(kWidest) + " along an axis");
    else
      found.yes(sentence);
  }
}

void empty(const FileFacts& facts, const Audience& audience, Finding& found) {
  if (facts.grids.empty()) return found.no("the file holds no grid");
  for (const GridFacts& grid : facts.grids)
    if (grid.info.activeVoxels == 0)
      found.note(quoted(grid) + " is empty" + (audience.blender ? ": its object vanishes in Blender" : ""));
}

void oneTransform(const FileFacts& facts, const Audience&, Finding& found) {
  for (const GridFacts& grid : facts.grids)
    if (grid.info.worldFromIndex != facts.grids.front().info.worldFromIndex ||
        grid.info.linear != facts.grids.front().info.linear)
      found.no(quoted(grid) + " lies by another transform than " + quoted(facts.grids.front()));
}

void linear(const FileFacts& facts, const Audience& audience, Finding& found) {
  for (const GridFacts& grid : facts.grids) {
    if (grid.info.linear) continue;
    if (audience.blender)
      found.no(quoted(grid) + " lies in a frustum, which loses its perspective in Blender");
    else
      found.note(quoted(grid) + " lies in a frustum");
  }
}

void fileName(const FileFacts& facts, const Audience&, Finding& found) {
  const size_t slash = facts.path.find_last_of('/');
  const std::string name = slash == std::string::npos ? facts.path : facts.path.substr(slash + 1);
  const bool ascii = std::all_of(name.begin(), name.end(), [](char c) { return (c & 0x80) == 0; });
  if (!ascii) found.no("its name is not ASCII");
  if (facts.frames.empty()) {
    if (isOurs(facts) && facts.metadata.contains("frame"))
      found.no("it is a frame, and its name has no number at its end");
    return;
  }
  const size_t digits = facts.frames.front().size();
  for (const std::string& frame : facts.frames)
    if (frame.size() != digits &&
        (frame.size() < digits || frame.front() == '0' || facts.frames.front().front() == '0'))
      return found.no("the numbers of its sequence are not padded to one width");
  constexpr size_t kMostDigits = 18;  // of a whole number in 64 bits
  if (facts.frames.back().size() > kMostDigits)
    return found.note("its name ends in a number that is no frame's");
  const int64_t first = std::stoll(facts.frames.front()), last = std::stoll(facts.frames.back());
  const int64_t missing = last - first + 1 - static_cast<int64_t>(facts.frames.size());
  if (missing > 0)
    return found.no(std::to_string(missing) + " frames are missing from " + std::to_string(first) + " to " +
                    std::to_string(last));
  if (facts.frames.size() == 1)
    found.note("Blender takes the number at the end of its name for a frame's");
  else
    found.yes("frames " + std::to_string(first) + " to " + std::to_string(last));
}

void notOfFiles(const FileFacts&, const Audience&, Finding& found) {
  found.notAsked("of programs, not of files");
}

const std::vector<Rule>& rules() {
  static const std::vector<Rule> kRules{
      {"density", density, "a float grid, fog volume, 0 outside of its voxels"},
      {"other grids", otherGrids, "under names that programs look for, where there are any"},
      {"half", half, "no tree of halves"},
      {"values", values, "all are finite and within what half precision holds"},
      {"format", format, ""},
      {"scale", scale, ""},
      {"creator", creator, ""},
      {"provenance", provenance, "it says its recipe, seed and medium"},
      {"topology", topology, "pruned, and no leaf is empty"},
      {"box", box, "there are no voxels"},
      {"empty grids", empty, "no grid is empty"},
      {"one transform", oneTransform, "all grids share one"},
      {"linear", linear, "voxels are the same everywhere"},
      {"half a voxel", notOfFiles, ""},
      {"file name", fileName, "no number at its end, and ASCII"},
      {"late loading", notOfFiles, ""},
      {"same contents", notOfFiles, ""}};
  return kRules;
}

}  // namespace

std::vector<Verdict> verdictsOn(const FileFacts& facts, const Audience& audience) {
  // Of a file that OpenVDB cannot open, its head alone is known.
  static const std::set<std::string> kOfTheHead{"half", "format", "file name"};
  std::vector<Verdict> verdicts;
  for (const Rule& rule : rules()) {
    Finding found;
    if (facts.unknownTrees.empty() || kOfTheHead.contains(rule.name))
      rule.look(facts, audience, found);
    else
      found.notAsked("the file cannot be opened");
    verdicts.push_back(found.verdict(static_cast<int>(verdicts.size()) + 1, rule.name, rule.otherwise));
  }
  return verdicts;
}

}  // namespace nephele
