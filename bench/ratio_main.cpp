// nephele_ratios [FILTER] [--json FILE]: comparisons that are ratios within one run. Depends on pairs.h.
#include <cstdio>
#include <exception>
#include <string>

#include "bench/pairs.h"

int main(int argc, char** argv) {
  std::string filter = ".", json;
  for (int n = 1; n < argc; ++n) {
    const std::string argument = argv[n];
    if (argument == "--json" && n + 1 < argc)
      json = argv[++n];
    else
      filter = argument;
  }
  try {
    using namespace nephele::bench;
    Table table(filter);
    // First: Linux counts the memory of the program that starts another to that one's peak.
    measurePeakMemory(table, NEPHELE_BAKE_PROGRAM);
#ifdef NEPHELE_WITH_FASTNOISE2
    compareNoise(table);
#else
    std::fprintf(stderr, "noise against FastNoise2 was left out: build with -DNEPHELE_FASTNOISE2=PREFIX\n");
#endif
    compareFogBall(table);
    compareSparseness(table);
    compareSplat(table);
    if (!json.empty()) table.writeJson(json);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nephele_ratios: error: %s\n", error.what());
    return 1;
  }
  return 0;
}
