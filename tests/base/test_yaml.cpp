// Places, types and refusals of the YAML reader, hostile documents among them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/yaml.h"
#include "tests/scratch_folder.h"

namespace nephele::yaml {
namespace {

/// What parsing complains of; empty where it does not.
std::string complaintOf(const std::string& text) {
  try {
    parse(text, "f");
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string complaintsOf(const Diagnostics& out) {
  try {
    out.throwIfAny();
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

NodePtr valueOf(const std::string& scalar) { return parse("v: " + scalar, "f")->entries.at(0).value; }

TEST(Yaml, KeepsPlacesFromOne) {
  const NodePtr root = parse("a: 1\nbb:\n  - x\n  - { c: [2, 'q'] }\nd:\n", "f");
  ASSERT_EQ(root->kind, Kind::map);
  EXPECT_EQ(root->entries[1].where.line, 2);
  EXPECT_EQ(root->entries[1].where.column, 1);
  const NodePtr list = root->entries[1].value;
  EXPECT_EQ(list->items[0]->where.line, 3);
  EXPECT_EQ(list->items[0]->where.column, 5);
  const Entry& c = list->items[1]->entries[0];
  EXPECT_EQ(c.where.line, 4);
  EXPECT_EQ(c.where.column, 7);
  EXPECT_FALSE(c.value->items[0]->quoted);
  EXPECT_TRUE(c.value->items[1]->quoted);
  EXPECT_EQ(root->entries[2].value->kind, Kind::null);
  EXPECT_EQ(root->entries[2].value->where.line, 5);
  EXPECT_EQ(root->where.file, "f");
}

TEST(Yaml, EmptyDocumentsAreNull) {
  for (const char* text : {"", "\n", "# only a comment\n", "---\n", "~\n"})
    EXPECT_EQ(parse(text, "f")->kind, Kind::null) << text;
}

TEST(Yaml, ReportsAllDuplicateKeys) {
  EXPECT_EQ(complaintOf("a: 1\nb: { c: 1, c: 2 }\na: 3\n"),
            "f:2:12: error: key 'c' is given twice; first in line 2\n"
            "f:3:1: error: key 'a' is given twice; first in line 1");
  EXPECT_EQ(complaintOf("a: { x: 1 }\nb: { x: 1 }\n"), "");
}

TEST(Yaml, RefusesWhatItDoesNotRead) {
  EXPECT_NE(complaintOf("a: [1, 2\nb: 3\n").find("f:2:"), std::string::npos);
  EXPECT_EQ(complaintOf("a: 1\n---\nb: 2\n").find("f:2:1: error: a file holds one YAML document"), 0u);
  EXPECT_EQ(complaintOf("x: &a { b: 1 }\ny:\n  <<: *a\n"),
            "f:3:3: error: merge keys ('<<') are not read; write the keys out");
  EXPECT_EQ(complaintOf("? [1, 2]\n: 3\n"), "f:1:3: error: a key must be text");
  EXPECT_EQ(complaintOf("? { a: 1 }\n: 3\n"), "f:1:3: error: a key must be text");
  EXPECT_EQ(complaintOf("a: !!int 3\n").find("f:1:4: error: tags such as"), 0u);
  EXPECT_NE(complaintOf("a: *missing\n").find("f:1:"), std::string::npos);
  EXPECT_EQ(complaintOf("a: &x [1, *x]\n"), "f:1:11: error: an alias stands inside the value that it names");
  EXPECT_EQ(complaintOf("a: 1\nb: \x04\nc: 2\n").find("f:2:4: error: holds a control character"), 0u);
  EXPECT_EQ(complaintOf(std::string("a: \0 1", 6)).find("f:1:4: error: holds a control character"), 0u);
  EXPECT_EQ(complaintOf(std::string((64u << 20) + 1, ' ')).find("f: error: a YAML file above 64 MiB"), 0u);
}

TEST(Yaml, RefusesDeepNesting) {
  const auto nested = [](size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_EQ(complaintOf(nested(200)), "");
  EXPECT_EQ(complaintOf(nested(201)), "f:1:201: error: nested deeper than 200 levels");
  EXPECT_EQ(complaintOf(nested(10000)), "f:1:201: error: nested deeper than 200 levels");
  std::string block;
  for (int i = 0; i < 1000; ++i) block += std::string(static_cast<size_t>(i), ' ') + "a:\n";
  EXPECT_NE(complaintOf(block).find("nested deeper than 200 levels"), std::string::npos);
}

TEST(Yaml, AliasesShareAndCannotGrowDeep) {
  const NodePtr root = parse("a: &x [1, 2]\nb: *x\n", "f");
  EXPECT_EQ(root->entries[0].value, root->entries[1].value);
  // A chain of aliases is as deep as what it stands for.
  std::string chain = "- &a0 [1]\n";
  for (int i = 1; i < 1000; ++i)
    chain += std::string("- &a") + std::to_string(i) + " [*a" + std::to_string(i - 1) + "]\n";
  EXPECT_NE(complaintOf(chain).find("f:199:10: error: nested deeper than 200 levels"), std::string::npos)
      << complaintOf(chain);
}

TEST(Yaml, AliasBombsStayLinear) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 60; ++i) {  // 10^60 values if it were unrolled
    bomb += std::string("a") + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int k = 0; k < 10; ++k) bomb += std::string(k ? ", *a" : "*a") + std::to_string(i - 1);
    bomb += "]\n";
  }
  const NodePtr root = parse(bomb, "f");
  ASSERT_EQ(root->entries.size(), 60u);
  for (size_t i = 1; i < 60; ++i)
    for (const NodePtr& item : root->entries[i].value->items) EXPECT_EQ(item, root->entries[i - 1].value);
}

TEST(Yaml, Numbers) {
  Diagnostics out;
  const std::pair<const char*, double> legal[] = {{"1", 1.0},   {"-2.5", -2.5}, {"+3", 3.0},
                                                  {".5", 0.5},  {"1e3", 1e3},   {"1.", 1.0},
                                                  {"0.1", 0.1}, {"+.5", 0.5},   {"-1E-3", -1e-3}};
  for (const auto& [text, value] : legal)
    EXPECT_EQ(readNumber(*valueOf(text), "'v'", kAny, out), value) << text;
  EXPECT_TRUE(out.empty());
  const std::pair<const char*, const char*> illegal[] = {
      {"1x", "'v' must be a number, found '1x'"},
      {"'1'", "'v' must be a number, found '1' in quotes"},
      {"0x10", "'v' must be a number, found '0x10'"},
      {"1_000", "'v' must be a number, found '1_000'"},
      {"+-1", "'v' must be a number, found '+-1'"},
      {"1 2", "'v' must be a number, found '1 2'"},
      {"true", "'v' must be a number, found 'true'"},
      {"", "'v' must be a number, found nothing"},
      {"[1]", "'v' must be a number, found a list"},
      {"{a: 1}", "'v' must be a number, found a map"},
      {".nan", "'v' must be a finite number, found '.nan'"},
      {"NaN", "'v' must be a finite number, found 'NaN'"},
      {"-.inf", "'v' must be a finite number, found '-.inf'"},
      {"infinity", "'v' must be a finite number, found 'infinity'"},
      {"1e999", "'v' is too large or too small for a number: '1e999'"}};
  for (const auto& [text, sentence] : illegal) {
    Diagnostics complaints;
    EXPECT_FALSE(readNumber(*valueOf(text), "'v'", kAny, complaints)) << text;
    EXPECT_NE(complaintsOf(complaints).find(sentence), std::string::npos) << complaintsOf(complaints);
  }
}

TEST(Yaml, WholeNumbersBooleansText) {
  Diagnostics out;
  EXPECT_EQ(readInteger(*valueOf("-42"), "'v'", kAny, out), -42);
  EXPECT_EQ(readInteger(*valueOf("9223372036854775807"), "'v'", kAny, out),
            std::numeric_limits<long long>::max());
  EXPECT_EQ(readBoolean(*valueOf("true"), "'v'", out), true);
  EXPECT_EQ(readBoolean(*valueOf("false"), "'v'", out), false);
  EXPECT_EQ(readText(*valueOf("'1'"), "'v'", out), "1");
  EXPECT_EQ(readNumbers(*valueOf("[1, 2]"), "'v'", 2, kAny, out), (std::vector<double>{1.0, 2.0}));
  EXPECT_TRUE(out.empty());
  EXPECT_FALSE(readInteger(*valueOf("1.5"), "'v'", kAny, out));
  EXPECT_FALSE(readInteger(*valueOf("9223372036854775808"), "'v'", kAny, out));
  EXPECT_FALSE(readBoolean(*valueOf("yes"), "'v'", out));
  EXPECT_FALSE(readText(*valueOf("[a]"), "'v'", out));
  EXPECT_FALSE(readNumbers(*valueOf("[1]"), "'v'", 2, kAny, out));
  EXPECT_EQ(complaintsOf(out),
            "f:1:4: error: 'v' must be a whole number, found '1.5'\n"
            "f:1:4: error: 'v' is too large for a whole number: '9223372036854775808'\n"
            "f:1:4: error: 'v' must be true or false, found 'yes'\n"
            "f:1:4: error: 'v' must be text, found a list\n"
            "f:1:4: error: 'v' must be a list of 2 numbers, found 1");
}

TEST(Yaml, Ranges) {
  EXPECT_EQ(describe(kAny), "");
  EXPECT_EQ(describe(kPositive), "greater than 0");
  EXPECT_EQ(describe(kNonNegative), "at least 0");
  EXPECT_EQ(describe(kUnit), "0 to 1");
  EXPECT_EQ(describe(Range{0.0, 180.0, true, true}), "greater than 0 and less than 180");
  EXPECT_TRUE(contains(kUnit, 0.0) && contains(kUnit, 1.0));
  EXPECT_FALSE(contains(kUnit, 1.0000001) || contains(kPositive, 0.0) || contains(kAny, std::nan("")));
  Diagnostics out;
  EXPECT_FALSE(readNumber(*valueOf("-1"), "'v'", kPositive, out));
  EXPECT_EQ(complaintsOf(out), "f:1:4: error: 'v' must be greater than 0, found -1");
}

TEST(Yaml, MapReaderReportsEverythingOnce) {
  Diagnostics out;
  const NodePtr root = parse("numbr: 1\ncount: x\nlook: phisical\nzzz: 1\nv: [1, 2]\nw: -1\n", "f");
  MapReader reader(*root, "the scene", out);
  EXPECT_EQ(reader.number("number", 7.0), 7.0);
  EXPECT_EQ(reader.integer("count", 3), 3);
  EXPECT_EQ(reader.choice("look", "physical", {"physical", "report"}), "physical");
  EXPECT_EQ(reader.vector3("v", {1, 2, 3}), (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(reader.numberOrRgb("w", {1, 2, 3}, kNonNegative), (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(reader.number("w", 5.0, kNonNegative), 5.0);
  reader.finish();
  EXPECT_EQ(
      complaintsOf(out),
      "f:1:1: error: unknown key 'numbr' in the scene; did you mean 'number'?\n"
      "f:2:8: error: 'count' must be a whole number, found 'x'\n"
      "f:3:7: error: 'look' must be one of physical, report, found 'phisical'; did you mean 'physical'?\n"
      "f:4:1: error: unknown key 'zzz' in the scene\n"
      "f:5:4: error: 'v' must be a list of 3 numbers, found 2\n"
      "f:6:4: error: 'w' (or a list of 3) must be at least 0, found -1\n"
      "f:6:4: error: 'w' must be at least 0, found -1");
}

TEST(Yaml, MapReaderTakesNothingForAnEmptyMap) {
  Diagnostics out;
  const NodePtr root = parse("", "f");
  MapReader reader(*root, "the scene", out);
  EXPECT_EQ(reader.number("a", 2.0), 2.0);
  reader.finish();
  EXPECT_TRUE(out.empty());
  const NodePtr list = parse("[1]", "f");
  MapReader wrong(*list, "the scene", out);
  wrong.finish();
  EXPECT_EQ(complaintsOf(out), "f:1:1: error: the scene must be a map, found a list");
}

TEST(Yaml, MissingFilesAreNamed) {
  const ScratchFolder scratch;
  EXPECT_THROW(load(scratch.file("missing.yaml")), InputError);
  EXPECT_THROW(load(scratch.path()), InputError);
  EXPECT_EQ(load(scratch.write("a.yaml", "a: 1"))->entries[0].where.file, scratch.file("a.yaml"));
}

}  // namespace
}  // namespace nephele::yaml
