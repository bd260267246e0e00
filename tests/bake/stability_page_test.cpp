// docs/stability.md against what `nephele-bake chart --stability` makes.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "bake/stability_page.h"

namespace nephele::test {
namespace {

TEST(BakeStability, TheDocsHoldThePage) {
  std::ifstream in(NEPHELE_SOURCE_FOLDER "/docs/stability.md");
  std::stringstream page;
  page << in.rdbuf();
  const std::string made = bakeStabilityPage(runBakeStability(true));
  EXPECT_NE(page.str().find(made), std::string::npos) << "run scripts/stability bake\n" << made;
}

}  // namespace
}  // namespace nephele::test
