# Run with cmake -P at build time: writes OUTPUT, a C++ file that holds each of TEXTS (paths relative to ROOT, joined by
# commas) under its own name, so that the program runs from anywhere. Its header is preview/gpu/embedded.h.
string(REPLACE "," ";" names "${TEXTS}")
set(rows "")
foreach(name ${names})
  file(READ "${ROOT}/${name}" text)
  string(APPEND rows "    {\"${name}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "// Generated from shaders/ by cmake/EmbedTexts.cmake.
#include \"preview/gpu/embedded.h\"

namespace nephele {
namespace {
const EmbeddedText kTexts[] = {
${rows}};
}  // namespace

std::span<const EmbeddedText> embeddedShaders() { return kTexts; }
}  // namespace nephele
")
