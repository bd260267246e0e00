// The command `fit`: the octaves' factors of a file, fitted to the reference. Depends on preview, volume,
// base.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace nephele {

struct FitCommandOptions {
  std::vector<std::string> files;   // that are fitted to, by one set of factors, and get it
  std::vector<std::string> checks;  // that are measured alone
  std::string scene, grid, out;     // out: a folder for fit.csv, .svg, .png; empty: none
  std::optional<int> count;         // octaves; none: the scene's, else as few as do
  int width = 48, height = 36;      // of each picture, pixels
  bool dryRun = false;              // write no metadata
  bool evenIfWorse = false;         // write it also where views held back get worse
  bool quiet = false;
};

/// Fits, prints the factors and errors before and after, and writes octaves_a, octaves_b, octaves_c and
/// octaves_d, each for three heights of the sun, and octaves_count into the metadata of each file. Throws InputError or
/// WorldError. Returns the exit code: kExitNo where views held back get worse, else 0.
int fitCommand(const FitCommandOptions& options);

}  // namespace nephele
