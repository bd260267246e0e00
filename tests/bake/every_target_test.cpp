// Every row of the field table in all its variants gives equal bits on every SIMD target of this machine.
// Kernels have their own, finer tests beside those that hold them to their definitions.
#include "tests/bake/every_target.h"

#include "tests/bake/field_variants.h"

namespace nephele::test {
namespace {

TEST(EveryTarget, GivesEqualBitsForEveryVariantOfEveryRow) {
  expectEqualBitsOnEveryTarget([] {
    std::vector<float> all;
    for (const FieldRow& row : fieldTable())
      for (const Variant& variant : variantsOf(row)) {
        const std::vector<float> values = valuesOf(*variant.field);
        all.insert(all.end(), values.begin(), values.end());
      }
    return all;
  });
}

}  // namespace
}  // namespace nephele::test
