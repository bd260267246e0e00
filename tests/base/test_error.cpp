// Sentences, their order, near names, and exit codes.
#include <gtest/gtest.h>

#include <new>

#include "base/error.h"
#include "base/hash.h"

namespace nephele {
namespace {

constexpr std::string_view kNames[] = {"perlin", "worley", "fbm", "sphere", "box"};

std::string formatted(const std::string& file, int line, int column, const std::string& sentence,
                      const std::string& hint) {
  Diagnostic diagnostic;
  diagnostic.where.file = file;
  diagnostic.where.line = line;
  diagnostic.where.column = column;
  diagnostic.sentence = sentence;
  diagnostic.hint = hint;
  return format(diagnostic);
}

TEST(Error, FormatLeavesOutWhatIsUnknown) {
  EXPECT_EQ(formatted("a.yaml", 14, 9, "unknown field 'perlim'", "did you mean 'perlin'?"),
            "a.yaml:14:9: error: unknown field 'perlim'; did you mean 'perlin'?");
  EXPECT_EQ(formatted("a.yaml", 14, 0, "s", ""), "a.yaml:14: error: s");
  EXPECT_EQ(formatted("a.vdb", 0, 0, "no such file", ""), "a.vdb: error: no such file");
  EXPECT_EQ(formatted("", 0, 0, "s", "h"), "error: s; h");
}

TEST(Error, ComplaintsComeByPlaceAndOnce) {
  Diagnostics out;
  EXPECT_NO_THROW(out.throwIfAny());
  out.add({"a", 10, 1}, "late");
  out.add({"a", 2, 5}, "early");
  out.add({"a", 2, 5}, "other");
  out.add({"a", 2, 5}, "early");
  out.add({"a", 2, 1}, "first");
  try {
    out.throwIfAny();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "a:2:1: error: first\na:2:5: error: early\na:2:5: error: other\na:10:1: error: late");
  }
}

TEST(Error, DidYouMeanCountsEdits) {
  EXPECT_EQ(didYouMean("perlim", kNames), "did you mean 'perlin'?");
  EXPECT_EQ(didYouMean("bxo", kNames), "did you mean 'box'?");  // a swap is one edit
  EXPECT_EQ(didYouMean("shpree", kNames), "did you mean 'sphere'?");
  EXPECT_EQ(didYouMean("bxx", kNames), "did you mean 'box'?");
  EXPECT_EQ(didYouMean("xyz", kNames), "");
  EXPECT_EQ(didYouMean("cylinder", kNames), "");
  EXPECT_EQ(didYouMean("", kNames), "");
  EXPECT_EQ(didYouMean(std::string(1000000, 'x'), kNames), "");
}

TEST(Error, GuardGivesTheContractsExitCodes) {
  EXPECT_EQ(runGuarded([] { return 0; }), 0);
  EXPECT_EQ(runGuarded([] { return 3; }), 3);
  EXPECT_EQ(runGuarded([]() -> int { throw InputError({"f"}, "wrong"); }), 2);
  EXPECT_EQ(runGuarded([]() -> int { throw WorldError("disk"); }), 1);
  EXPECT_EQ(runGuarded([]() -> int { throw std::bad_alloc(); }), 1);
  EXPECT_EQ(runGuarded([]() -> int { throw std::logic_error("x"); }), 1);
}

TEST(Error, GuardPrintsTheSentence) {
  testing::internal::CaptureStderr();
  runGuarded([]() -> int {
    Diagnostics out;
    out.add({"f", 1, 2}, "one");
    out.add({"f", 3, 4}, "two", "mend it");
    out.throwIfAny();
    return 0;
  });
  runGuarded([]() -> int { throw WorldError("cannot write 'x'"); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "f:1:2: error: one\nf:3:4: error: two; mend it\nerror: cannot write 'x'\n");
}

TEST(ErrorDeathTest, CheckPrintsBothValues) {
  const int two = 2;
  EXPECT_DEATH(NEPHELE_CHECK_EQ(1 + two, 4), "check failed: 1 \\+ two == 4 \\(3 vs 4\\)");
}

TEST(Hash, KnownDigestAndPieces) {
  // XXH3-128 of no bytes with seed 0, as in xxHash's own test vectors.
  EXPECT_EQ(Hasher().hex(), "99aa06d3014798d86001c324468d497f");
  Hasher whole, pieces, other;
  whole.bytes("abcdef", 6);
  pieces.bytes("abc", 3);
  pieces.bytes("def", 3);
  EXPECT_EQ(whole.hex(), pieces.hex());
  Hasher left, right;
  left.text("ab");
  left.text("c");
  right.text("a");
  right.text("bc");
  EXPECT_NE(left.hex(), right.hex());
}

}  // namespace
}  // namespace nephele
