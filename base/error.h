// Errors of the three kinds (DESIGN.md, section 3) and the programs' one way out.
// User's fault: InputError, a list of located sentences, exit 2. World's fault: WorldError, exit 1.
// Our fault: NEPHELE_CHECK_*, which prints both values and aborts. Depends on nothing.
#pragma once

#include <exception>
#include <functional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace nephele {

/// A place in a file. Lines and columns count from 1; 0 means that they are unknown or have no meaning.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
};

/// One complaint about input: where, what is wrong, and (may be empty) what would mend it.
struct Diagnostic {
  SourceLocation where;
  std::string sentence;
  std::string hint;
};

/// "pipeline.yaml:14:9: error: unknown field 'perlim'; did you mean 'perlin'?" Unknown parts are left out.
std::string format(const Diagnostic& diagnostic);

/// The user's fault. Carries every complaint of one run; what() joins them with newlines. Never empty.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Diagnostic> diagnostics);
  InputError(SourceLocation where, std::string sentence, std::string hint = {});
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// The world's fault (disk, driver, memory): the sentence names the path or the call.
class WorldError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Collects complaints, so that one run reports them all. Not thread-safe.
class Diagnostics {
 public:
  void add(SourceLocation where, std::string sentence, std::string hint = {});
  bool empty() const { return items_.empty(); }
  /// Throws InputError with all that was added, in order of file position; returns where nothing was added.
  void throwIfAny() const;

 private:
  std::vector<Diagnostic> items_;
};

/// "did you mean 'perlin'?" for the candidate nearest to `name` in edit distance (at most a third of its
/// length, at least 1, with a swap of neighbours counted once); empty where none is near.
std::string didYouMean(std::string_view name, std::span<const std::string_view> candidates);

/// Exit codes of both programs (DESIGN.md, section 1).
enum ExitCode : int { kExitDone = 0, kExitWorld = 1, kExitInput = 2, kExitNo = 3 };

/// Runs `body` and turns what it throws into a message on stderr and an exit code: InputError 2; WorldError,
/// std::bad_alloc and every other std::exception 1. Called by main functions alone.
int runGuarded(const std::function<int()>& body);

/// Prints "file:line: check failed: text (left vs right)" to stderr and aborts.
[[noreturn]] void failCheck(const char* file, int line, const char* text, const std::string& left,
                            const std::string& right);

template <class L, class R>
[[noreturn]] void failCheckValues(const char* file, int line, const char* text, const L& left,
                                  const R& right) {
  std::ostringstream l, r;
  l << left;
  r << right;
  failCheck(file, line, text, l.str(), r.str());
}

}  // namespace nephele

#define NEPHELE_CHECK_OP(op, left, right)                                                                  \
  do {                                                                                                     \
    const auto& nepheleLeft = (left);                                                                      \
    const auto& nepheleRight = (right);                                                                    \
    if (!(nepheleLeft op nepheleRight))                                                                    \
      ::nephele::failCheckValues(__FILE__, __LINE__, #left " " #op " " #right, nepheleLeft, nepheleRight); \
  } while (false)
#define NEPHELE_CHECK_EQ(left, right) NEPHELE_CHECK_OP(==, left, right)
#define NEPHELE_CHECK_LT(left, right) NEPHELE_CHECK_OP(<, left, right)
#define NEPHELE_CHECK_LE(left, right) NEPHELE_CHECK_OP(<=, left, right)
#define NEPHELE_CHECK_GT(left, right) NEPHELE_CHECK_OP(>, left, right)
