// Content hashing over libxxhash. Depends on base and xxhash.
#include "base/hash.h"

#include <xxhash.h>

#include <cstdint>
#include <cstdio>
#include <new>

namespace nephele {

struct Hasher::State {
  XXH3_state_t* xxh = nullptr;
};

Hasher::Hasher() : state_(std::make_unique<State>()) {
  state_->xxh = XXH3_createState();
  if (state_->xxh == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(state_->xxh);
}

Hasher::~Hasher() { XXH3_freeState(state_->xxh); }

void Hasher::bytes(const void* data, size_t sizeBytes) {
  if (sizeBytes > 0) XXH3_128bits_update(state_->xxh, data, sizeBytes);
}

void Hasher::text(std::string_view text) {
  value(static_cast<uint64_t>(text.size()));
  bytes(text.data(), text.size());
}

std::string Hasher::hex() const {
  const XXH128_hash_t digest = XXH3_128bits_digest(state_->xxh);
  char digits[33];  // 128 bits are 32 hex digits, and the closing zero
  std::snprintf(digits, sizeof digits, "%016llx%016llx", static_cast<unsigned long long>(digest.high64),
                static_cast<unsigned long long>(digest.low64));
  return digits;
}

}  // namespace nephele
