// The docs page of all fields, with a picture of each. Depends on fields, nodes.h and base.
#include <algorithm>
#include <filesystem>

#include "bake/field_examples.h"
#include "bake/nodes.h"
#include "base/files.h"

namespace nephele {
namespace {

namespace fs = std::filesystem;

constexpr int kPixels = 192;
constexpr double kReach = 1.5;  // world units from the middle to the edge

/// The slice y = 0 of an example: x to the right, z up. 0 is black, 1 white; what lies below 0 is blue, above
/// 1 red.
Picture sliceOf(const std::string& name) {
  const double spacing = 2.0 * kReach / kPixels;
  const FieldPtr field = examples::exampleField(name, {spacing, 2, 0, nullptr});
  Picture picture;
  picture.width = picture.height = kPixels;
  for (const char* const channel : {"R", "G", "B", "A"}) picture.add(channel);
  for (int row = 0; row < kPixels; ++row)
    for (int column = 0; column < kPixels; column += kBlockEdge) {
      float x[kBlockEdge], zero[kBlockEdge] = {}, values[kBlockEdge];
      for (int n = 0; n < kBlockEdge; ++n) x[n] = float(n * spacing);
      const glm::dvec3 origin(-kReach + (column + 0.5) * spacing, 0.0, kReach - (row + 0.5) * spacing);
      field->evaluate(Points{origin, size_t(kBlockEdge), x, zero, zero}, values);
      for (int n = 0; n < kBlockEdge; ++n) {
        const size_t pixel = size_t(row * kPixels + column + n);
        const float inside = std::clamp(values[n], 0.0f, 1.0f);
        picture.planes[0][pixel] = inside + std::clamp(values[n] - 1.0f, 0.0f, 1.0f) * 0.5f;
        picture.planes[1][pixel] = inside;
        picture.planes[2][pixel] = inside + std::clamp(-values[n], 0.0f, 1.0f);
        picture.planes[3][pixel] = 1.0f;
      }
    }
  return picture;
}

std::string pageText() {
  std::string text =
      "# Fields\n\nWritten by `nephele-bake nodes --markdown docs` from the field table. Each picture is the "
      "slice y = 0 of "
      "an example from -1.5 to 1.5, z up: 0 is black, 1 white, below 0 blue, above 1 red.\n";
  for (const FieldRow& row : fieldTable()) {
    const std::string name(row.name);
    text += "\n## " + name + "\n\n![" + name + "](images/fields/" + name + ".png)\n\n" +
            std::string(row.sentence) + "\n\n| parameter | what it is | what it does |\n|---|---|---|\n";
    for (const Parameter& parameter : row.parameters) {
      std::string kind = parameterKind(parameter);
      for (size_t at = 0; (at = kind.find('|', at)) != std::string::npos; at += 2) kind.insert(at, "\\");
      text += "| `" + std::string(parameter.name) + "` | " + kind + " | " + std::string(parameter.sentence) +
              " |\n";
    }
  }
  return text;
}

}  // namespace

void writeFieldsPage(const std::string& folder) {
  std::error_code error;
  fs::create_directories(fs::path(folder) / "images" / "fields", error);
  if (error) throw WorldError("cannot make the folder '" + folder + "/images/fields': " + error.message());
  for (const FieldRow& row : fieldTable()) {
    const std::string name(row.name);
    // One stop up, 1 becomes 1 − e^(−2) = 0.86 under the tone curve, before its transfer function.
    writePng((fs::path(folder) / "images" / "fields" / (name + ".png")).string(), sliceOf(name), 1.0f,
             Backdrop{});
  }
  writeText((fs::path(folder) / "fields.md").string(), pageText());
}

}  // namespace nephele
