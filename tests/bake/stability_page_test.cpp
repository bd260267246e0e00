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
  std::string made = bakeStabilityPage(runBakeStability(true));
  // The page lies above its picture, whose name tells it from the previewer's.
  const std::string picture = "(stability.png)";
  ASSERT_NE(made.find(picture), std::string::npos);
  made.replace(made.find(picture), picture.size(), "(images/stability_bake.png)");
  EXPECT_NE(page.str().find(made), std::string::npos) << "run scripts/stability bake\n" << made;
}

}  // namespace
}  // namespace nephele::test
