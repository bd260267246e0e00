// Formats and collects errors, finds near names, and ends a program with a sentence and an exit code.
// Depends on nothing.
#include "base/error.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <tuple>

namespace nephele {
namespace {

std::string join(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) {
    if (!text.empty()) text += '\n';
    text += format(diagnostic);
  }
  return text;
}

auto positionOf(const Diagnostic& d) { return std::tie(d.where.file, d.where.line, d.where.column); }

bool isSame(const Diagnostic& a, const Diagnostic& b) {
  return positionOf(a) == positionOf(b) && a.sentence == b.sentence && a.hint == b.hint;
}

/// Edits (insert, remove, replace, swap neighbours) that turn `a` into `b`; each place is edited once at
/// most.
size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> beforeLast(b.size() + 1), last(b.size() + 1), current(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({last[j] + 1, current[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) current[j] = std::min(current[j], beforeLast[j - 2] + 1);
    }
    std::swap(beforeLast, last);
    std::swap(last, current);
  }
  return last[b.size()];
}

}  // namespace

std::string format(const Diagnostic& diagnostic) {
  std::string text;
  const SourceLocation& where = diagnostic.where;
  if (!where.file.empty()) {
    text += where.file + ':';
    if (where.line > 0) text += std::to_string(where.line) + ':';
    if (where.line > 0 && where.column > 0) text += std::to_string(where.column) + ':';
    text += ' ';
  }
  text += "error: " + diagnostic.sentence;
  if (!diagnostic.hint.empty()) text += "; " + diagnostic.hint;
  return text;
}

InputError::InputError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(join(diagnostics)), diagnostics_(std::move(diagnostics)) {
  NEPHELE_CHECK_GT(diagnostics_.size(), size_t{0});
}

InputError::InputError(SourceLocation where, std::string sentence, std::string hint)
    : InputError(std::vector<Diagnostic>{{std::move(where), std::move(sentence), std::move(hint)}}) {}

void Diagnostics::add(SourceLocation where, std::string sentence, std::string hint) {
  items_.push_back({std::move(where), std::move(sentence), std::move(hint)});
}

void Diagnostics::throwIfAny() const {
  if (items_.empty()) return;
  std::vector<Diagnostic> sorted = items_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Diagnostic& a, const Diagnostic& b) { return positionOf(a) < positionOf(b); });
  // Equal complaints of one place need not be neighbours, so each is compared with all kept before it there.
  std::vector<Diagnostic> unique;
  for (Diagnostic& item : sorted) {
    bool seen = false;
    for (auto kept = unique.rbegin(); kept != unique.rend() && positionOf(*kept) == positionOf(item); ++kept)
      seen = seen || isSame(*kept, item);
    if (!seen) unique.push_back(std::move(item));
  }
  throw InputError(std::move(unique));
}

std::string didYouMean(std::string_view name, std::span<const std::string_view> candidates) {
  constexpr size_t kLengthPerEdit = 3;
  // A longer name is no slip of the finger, and the table of distances grows with its length.
  constexpr size_t kLongestName = 100;
  if (name.size() > kLongestName) return {};
  size_t nearest = std::max<size_t>(1, name.size() / kLengthPerEdit) + 1;
  std::string_view best;
  for (const std::string_view candidate : candidates) {
    const size_t distance = editDistance(name, candidate);
    if (distance < nearest) {
      nearest = distance;
      best = candidate;
    }
  }
  return best.empty() ? std::string() : "did you mean '" + std::string(best) + "'?";
}

int runGuarded(const std::function<int()>& body) {
  try {
    return body();
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kExitInput;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "error: out of memory\n");
    return kExitWorld;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return kExitWorld;
  }
}

void failCheck(const char* file, int line, const char* text, const std::string& left,
               const std::string& right) {
  std::fprintf(stderr, "%s:%d: check failed: %s (%s vs %s)\n", file, line, text, left.c_str(), right.c_str());
  std::abort();
}

}  // namespace nephele
