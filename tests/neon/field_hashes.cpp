// Prints one line for each variant of each row of the field table: its name and a hash of its values' bits on
// blocks and at points. Built for this machine and for ARM, whose lines must be equal. Depends on fields and
// base alone.
#include <cstdio>
#include <cstring>

#include "tests/bake/field_variants.h"

namespace nephele::test {
namespace {

/// FNV-1a over the bits of floats.
uint64_t hashOf(const std::vector<float>& values) {
  constexpr uint64_t kStart = 0xcbf29ce484222325u, kPrime = 0x100000001b3u;
  uint64_t hash = kStart;
  for (const float value : values) {
    uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    for (int byte = 0; byte < 4; ++byte) hash = (hash ^ (bits >> (8 * byte) & 0xffu)) * kPrime;
  }
  return hash;
}

}  // namespace
}  // namespace nephele::test

int main() {
  using namespace nephele;
  for (const FieldRow& row : fieldTable())
    for (const test::Variant& variant : test::variantsOf(row))
      std::printf("%s %016llx\n", variant.name.c_str(),
                  static_cast<unsigned long long>(test::hashOf(test::valuesOf(*variant.field))));
  return 0;
}
