// Assembling and compiling shaders. Depends on gpu/gl.h and gpu/embedded.h.
#include "preview/gpu/shader.h"

#include <algorithm>
#include <regex>
#include <sstream>

#include "preview/gpu/embedded.h"

namespace nephele {
namespace {

std::string textOf(const std::string& name, const std::vector<TextChange>& changes) {
  const auto texts = embeddedShaders();
  const auto found = std::find_if(texts.begin(), texts.end(), [&](const auto& t) { return t.name == name; });
  if (found == texts.end())
    failCheckValues(__FILE__, __LINE__, "the shader text is embedded", name, "missing");
  std::string text(found->text);
  for (const TextChange& change : changes) {
    if (change.file != name) continue;
    const size_t at = text.find(change.from);
    if (at == std::string::npos || text.find(change.from, at + 1) != std::string::npos)
      failCheckValues(__FILE__, __LINE__, "the text to change occurs once", change.from, name);
    text.replace(at, change.from.size(), change.to);
  }
  return text;
}

class Assembler {
 public:
  Assembler(const std::vector<std::string>& defines, const std::vector<TextChange>& changes)
      : defines_(defines), changes_(changes) {}

  void add(const std::string& name) {
    const size_t number = result.files.size();
    NEPHELE_CHECK_EQ(std::count(result.files.begin(), result.files.end(), name), 0);
    result.files.push_back(name);
    if (number > 0) writeLine(1, number);  // nothing may stand before #version
    std::istringstream lines(textOf(name, changes_));
    int lineNumber = 0;
    for (std::string line; std::getline(lines, line);) {
      ++lineNumber;
      constexpr std::string_view kInclude = "#include \"";
      if (line.starts_with(kInclude)) {
        add(line.substr(kInclude.size(), line.rfind('"') - kInclude.size()));
        writeLine(lineNumber + 1, number);
      } else {
        result.text += line + '\n';
        if (line.starts_with("#version")) {
          for (const std::string& define : defines_) result.text += "#define " + define + '\n';
          writeLine(lineNumber + 1, number);
        }
      }
    }
  }

  ShaderText result;

 private:
  void writeLine(int line, size_t file) {
    result.text += "#line " + std::to_string(line) + ' ' + std::to_string(file) + '\n';
  }

  const std::vector<std::string>& defines_;
  const std::vector<TextChange>& changes_;
};

GlShader compile(GLenum kind, const std::string& name, const std::vector<std::string>& defines,
                 const std::vector<TextChange>& changes) {
  const ShaderText source = assembleShader(name, defines, changes);
  GlShader shader(glCreateShader(kind));
  const char* text = source.text.c_str();
  glShaderSource(shader.name(), 1, &text, nullptr);
  glCompileShader(shader.name());
  GLint done = GL_FALSE, length = 0;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &done);
  if (done == GL_TRUE) return shader;
  glGetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<size_t>(std::max(length, 1)), '\0');
  glGetShaderInfoLog(shader.name(), length, nullptr, log.data());
  throw WorldError("the driver refuses shaders/" + name + ":\n" + nameFilesInLog(log.c_str(), source.files));
}

GlProgram link(std::initializer_list<GLuint> shaders, const std::string& what) {
  GlProgram program(glCreateProgram());
  for (const GLuint shader : shaders) glAttachShader(program.name(), shader);
  glLinkProgram(program.name());
  for (const GLuint shader : shaders) glDetachShader(program.name(), shader);
  GLint done = GL_FALSE, length = 0;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &done);
  if (done != GL_TRUE) {
    glGetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<size_t>(std::max(length, 1)), '\0');
    glGetProgramInfoLog(program.name(), length, nullptr, log.data());
    throw WorldError("the driver cannot link " + what + ":\n" + log.c_str());
  }
  checkGl("building " + what);
  return program;
}

}  // namespace

ShaderText assembleShader(const std::string& name, const std::vector<std::string>& defines,
                          const std::vector<TextChange>& changes) {
  Assembler assembler(defines, changes);
  assembler.add(name);
  return assembler.result;
}

std::string nameFilesInLog(const std::string& log, const std::vector<std::string>& files) {
  // "3:17(4): error" from Mesa, "3(17) : error" from others; severity words may stand in front.
  static const std::regex kPlace(R"(^((?:ERROR|WARNING): )?(\d+)[:(](\d+))");
  std::istringstream lines(log);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_search(line, match, kPlace)) {
      constexpr int kMostDigits = 6;  // file numbers are small; more digits are no file
      const std::string digits = match[2];
      const size_t file = digits.size() <= kMostDigits ? std::stoul(digits) : files.size();
      if (file < files.size())
        line = match[1].str() + files[file] + ':' + match[3].str() + ':' + match.suffix().str();
    }
    result += line + '\n';
  }
  return result;
}

GlProgram buildProgram(const std::string& vertexName, const std::string& fragmentName,
                       const std::vector<std::string>& defines, const std::vector<TextChange>& changes) {
  const GlShader vertex = compile(GL_VERTEX_SHADER, vertexName, defines, changes);
  const GlShader fragment = compile(GL_FRAGMENT_SHADER, fragmentName, defines, changes);
  return link({vertex.name(), fragment.name()}, vertexName + " with " + fragmentName);
}

GlProgram buildComputeProgram(const std::string& name, const std::vector<std::string>& defines,
                              const std::vector<TextChange>& changes) {
  const GlShader shader = compile(GL_COMPUTE_SHADER, name, defines, changes);
  return link({shader.name()}, name);
}

}  // namespace nephele
