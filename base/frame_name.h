// Numbers at the ends of file names, which make frames of a sequence. Depends on nothing.
#pragma once

#include <string>

namespace nephele {

/// A file's name without its ending, cut before the digits that it ends with; `digits` may be empty.
struct Stem {
  std::string head, digits;
};

inline Stem stemOf(const std::string& name) {
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  size_t first = name.size();
  while (first > 0 && isDigit(name[first - 1])) --first;
  return {name.substr(0, first), name.substr(first)};
}

}  // namespace nephele
