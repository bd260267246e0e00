// The table of methods. Depends on the methods' makers.
#include "preview/method.h"

#include <algorithm>
#include <vector>

#include "preview/gpu/march_method.h"
#include "preview/truth/reference_method.h"

namespace nephele {
namespace {

constexpr MethodRow kMethods[] = {
    {"march", "steps along rays from inverse projection, skipping empty bricks", makeMarchMethod},
    {"cube", "rays from the interpolated faces of the bounding cube", makeCubeMethod},
    {"dda", "an exact voxel walk through piecewise-constant density", makeDdaMethod},
    {"impostor", "camera-facing quads textured by ray marching", nullptr},
    {"phenomenological", "a surface shader for cumulus", nullptr},
    {"reference", "unbiased path tracing on the CPU: delta tracking, ratio tracking, roulette",
     makeReferenceMethod},
};

}  // namespace

std::span<const MethodRow> methods() { return kMethods; }

const MethodRow& findMethod(const std::string& name) {
  std::vector<std::string_view> names;
  for (const MethodRow& row : kMethods) names.push_back(row.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw InputError({}, "unknown method '" + name + "'", didYouMean(name, names));
  const MethodRow& row = kMethods[found - names.begin()];
  if (row.make == nullptr) throw InputError({}, "the method '" + name + "' is not built yet");
  return row;
}

}  // namespace nephele
