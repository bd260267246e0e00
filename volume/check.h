// Will a .vdb open well in Blender, Houdini and the rest? The rules that `nephele-bake check` holds a file
// to, one verdict each, whoever wrote it. No OpenVDB in this header. Depends on volume/info.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "volume/info.h"

namespace nephele {

/// The programs that a file is meant for.
struct Audience {
  bool blender = true, houdini = true, unreal = true;
};
/// One of them by name; all where it is empty. Throws InputError for another name.
Audience audienceOf(const std::string& name);

/// What the rules ask of a grid beside what `info` tells.
struct GridFacts {
  GridInfo info;                        // without its content hash
  std::string tree;                     // "Tree_float_5_4_3", as the file names it
  std::string vectorType;               // "contravariant relative", "invariant", …
  std::optional<uint32_t> compression;  // as in VdbGridEntry
  std::optional<double> background;     // of a float grid
  uint64_t emptyLeaves = 0;             // without active voxels
  uint64_t constantLeaves = 0;          // active throughout and of one value: pruned they would be tiles
  // Numbers of float and vec3s grids, inactive ones of leaves among them:
  uint64_t notFinite = 0;  // not a number or infinite
  uint64_t aboveHalf = 0;  // finite, and beyond what half precision holds
  uint64_t belowHalf = 0;  // not 0, and nearer to it than half precision tells
  // Of a float grid's active voxels:
  double largest = 0.0;
  double mass = 0.0, faintMass = 0.0;  // sums of positive values; of those below kFaintDensity
};

/// "What matters" lies at this density or above.
inline constexpr double kFaintDensity = 0.01;

struct FileFacts {
  std::string path;
  uint32_t fileVersion = 0;
  std::map<std::string, std::string> metadata;
  std::vector<GridFacts> grids;
  std::vector<std::string> unknownTrees;  // "NAME: TYPE" of what OpenVDB does not know; then `grids` is empty
  std::vector<std::string> frames;  // digits at the ends of the names beside it that have its stem, in order;
                                    // empty where its own has none
};

/// Reads the file. Throws as readVdb does.
FileFacts factsOf(const std::string& path);

enum class Holds {
  yes,
  note,      // yes, with something to know
  no,        // some program of the audience opens it wrongly
  notAsked,  // of this file, of these programs, or of any file
};

struct Verdict {
  int rule = 0;
  std::string name;
  Holds holds = Holds::yes;
  std::string sentence;
};

/// One for each rule, in their order.
std::vector<Verdict> verdictsOn(const FileFacts& facts, const Audience& audience);

struct FileCheck {
  std::string path;
  std::vector<Verdict> verdicts;
  /// Whether no rule is broken.
  bool good() const;
};
/// Throws as readVdb does.
FileCheck checkFile(const std::string& path, const Audience& audience);

std::string checkAsText(const FileCheck& check);
/// An object for one file, a list of them for more: path, good, rules[{rule, name, holds, sentence}], where
/// holds is "yes", "note", "no" or "not asked".
std::string checksAsJson(const std::vector<FileCheck>& checks);

}  // namespace nephele
