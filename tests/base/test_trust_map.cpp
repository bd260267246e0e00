// Tables and heat maps of what may be trusted.
#include <gtest/gtest.h>

#include "base/trust_map.h"

namespace nephele {
namespace {

TrustMap mapOf(const std::vector<bool>& trusted) {
  TrustMap map{"a way", 0.01, 0.3, {{"some axis", {}}}};
  for (size_t n = 0; n < trusted.size(); ++n)
    map.axes[0].places.push_back(
        {std::to_string(n), trusted[n] ? "fine" : "poor", trusted[n] ? 0.001 : 0.2, trusted[n], false});
  return map;
}

TEST(TrustMap, NamesTheRunsThatMayBeTrusted) {
  const auto rangeOf = [](const std::vector<bool>& trusted) { return trustedRange(mapOf(trusted).axes[0]); };
  EXPECT_EQ(rangeOf({true, true, true}), "everywhere");
  EXPECT_EQ(rangeOf({false, false}), "nowhere");
  EXPECT_EQ(rangeOf({false, true, true, false, true}), "1 to 2, 4");
}

TEST(TrustMap, IsALineAnAxis) {
  EXPECT_NE(markdownOf(mapOf({true, false}))
                .find("## a way\n\n| axis | error along it | trusted |\n|---|---|---|\n"
                      "| some axis | 0: fine, 1: poor | 0 |\n"),
            std::string::npos);
}

TEST(TrustMap, IsDrawnAsCellsOfTwoLinesOneUnderAnother) {
  TrustMap map = mapOf({true, false});
  map.axes[0].places[0].failed = true;
  const HeatMap heat = heatMapOf(map);
  EXPECT_EQ(heat.rows[0].values[0], map.high) << "what failed has the colour of the largest error";
  EXPECT_EQ(heat.rows[0].labels[1], "1\npoor");
  const std::string script = heatMapScript({heat, heat}, "svg", "x.svg");
  EXPECT_NE(script.find("'poor'"), std::string::npos);
  EXPECT_EQ(script.find("1 poor"), std::string::npos);
  // Two maps of 46 pixels of title and 34 of a row, and 10 below them.
  EXPECT_NE(script.find(",170 background"), std::string::npos) << script.substr(0, 200);
}

}  // namespace
}  // namespace nephele
