// Content hashing: XXH3, 128 bits, fed piece by piece. Depends on base alone.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace nephele {

/// Streams bytes into a 128-bit hash. Not cryptographic. Not thread-safe.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  void bytes(const void* data, size_t sizeBytes);
  /// The text's length, then the text, so that ("ab", "c") and ("a", "bc") differ.
  void text(std::string_view text);
  /// A trivially copyable value without padding, as it lies in memory (little-endian on all supported
  /// machines).
  template <class T>
  void value(const T& value) {
    bytes(&value, sizeof value);
  }
  /// 32 lower-case hex digits.
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace nephele
