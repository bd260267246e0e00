// Shader programs from the embedded texts: #include resolved, #line written, the driver's errors with file
// names. Depends on gpu/gl.h and gpu/embedded.h.
#pragma once

#include <string>
#include <vector>

#include "preview/gpu/gl.h"

namespace nephele {

/// One change of an embedded text before it is compiled; tests make mutants with it. `from` must occur
/// exactly once.
struct TextChange {
  std::string file;
  std::string from;
  std::string to;
};

/// A whole shader text as the driver gets it, and the files that its #line numbers stand for.
struct ShaderText {
  std::string text;
  std::vector<std::string> files;
};

/// The text of `name` (a path under shaders/) with every #include "path" (from shaders/) put in its place and
/// `defines` ("NAME VALUE") after #version. An include that is missing, or that is included twice, is our
/// fault.
ShaderText assembleShader(const std::string& name, const std::vector<std::string>& defines,
                          const std::vector<TextChange>& changes);

/// The driver's log with "3:17" turned into "shared/march.glsl:17" where 3 stands for that file.
std::string nameFilesInLog(const std::string& log, const std::vector<std::string>& files);

/// Compiles and links. Throws WorldError with the driver's log.
GlProgram buildComputeProgram(const std::string& name, const std::vector<std::string>& defines = {},
                              const std::vector<TextChange>& changes = {});
GlProgram buildProgram(const std::string& vertexName, const std::string& fragmentName,
                       const std::vector<std::string>& defines = {},
                       const std::vector<TextChange>& changes = {});

}  // namespace nephele
