// Loading, messages and handles. Depends on glad and base.
#include "preview/gpu/gl.h"

#include <atomic>
#include <cstdio>

namespace nephele {
namespace {

constexpr int kNeededMajor = 4, kNeededMinor = 5;

std::atomic<uint64_t> made{0}, destroyed{0};

// What the driver complained of since the last check. A C callback must not throw, and GL is used from one
// thread.
std::string& pendingErrors() {
  static thread_local std::string errors;
  return errors;
}

void GLAD_API_PTR onMessage(GLenum, GLenum type, GLuint, GLenum severity, GLsizei, const GLchar* message,
                            const void*) {
  if (type == GL_DEBUG_TYPE_ERROR) {
    pendingErrors() += std::string(pendingErrors().empty() ? "" : "; ") + message;
  } else if (severity == GL_DEBUG_SEVERITY_HIGH) {
    std::fprintf(stderr, "OpenGL: %s\n", message);
  }
}

const char* nameOfError(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "invalid enum";
    case GL_INVALID_VALUE:
      return "invalid value";
    case GL_INVALID_OPERATION:
      return "invalid operation";
    case GL_OUT_OF_MEMORY:
      return "out of GPU memory";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "invalid framebuffer operation";
    case GL_CONTEXT_LOST:
      return "context lost";
    default:
      return "unknown error";
  }
}

/// Who caused a reset, as far as the driver knows.
const char* nameOfReset(GLenum status) {
  switch (status) {
    case GL_GUILTY_CONTEXT_RESET:
      return "by what was drawn here";
    case GL_INNOCENT_CONTEXT_RESET:
      return "by another program";
    default:
      return "for a reason that it does not tell";
  }
}

}  // namespace

void loadGl(GLADloadfunc loader) {
  const int version = gladLoadGL(loader);
  if (version == 0) throw WorldError("gladLoadGL: no OpenGL context is current");
  if (version < GLAD_MAKE_VERSION(kNeededMajor, kNeededMinor))
    throw WorldError("OpenGL 4.5 is needed, and the driver offers " +
                     std::to_string(GLAD_VERSION_MAJOR(version)) + "." +
                     std::to_string(GLAD_VERSION_MINOR(version)));
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(onMessage, nullptr);
  pendingErrors().clear();
}

std::string glRenderer() {
  const GLubyte* text = glGetString(GL_RENDERER);
  return text == nullptr ? "unknown" : reinterpret_cast<const char*>(text);
}

void checkGl(const std::string& call) {
  std::string said = std::exchange(pendingErrors(), {});
  // A lost context may report errors without end: a few are enough.
  constexpr int kMostErrors = 8;
  for (int i = 0; i < kMostErrors; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    said += std::string(said.empty() ? "" : "; ") + nameOfError(error);
  }
  if (said.empty()) return;
  requireKeptContext(call);
  throw WorldError(call + ": OpenGL: " + said);
}

void requireKeptContext(const std::string& what) {
  const GLenum status = glGetGraphicsResetStatus();
  if (status == GL_NO_ERROR) return;
  throw WorldError(what + ": the graphics driver (" + glRenderer() + ") was reset " + nameOfReset(status) +
                   ", and what it had drawn is lost; draw again, with longer steps or a smaller picture "
                   "where this comes back");
}

void finishGl(const std::string& call) {
  glFinish();
  checkGl(call);
}

GlCounts glCounts() { return {made.load(), destroyed.load()}; }
void countMade() { ++made; }
void countDestroyed() { ++destroyed; }

void destroyTexture(GLuint name) { glDeleteTextures(1, &name); }
void destroyBuffer(GLuint name) { glDeleteBuffers(1, &name); }
void destroyFramebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
void destroyVertexArray(GLuint name) { glDeleteVertexArrays(1, &name); }
void destroyProgram(GLuint name) { glDeleteProgram(name); }
void destroyShader(GLuint name) { glDeleteShader(name); }

GlTexture makeTexture(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  return GlTexture(name);
}

GlBuffer makeBuffer() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return GlBuffer(name);
}

GlFramebuffer makeFramebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return GlFramebuffer(name);
}

GlVertexArray makeVertexArray() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return GlVertexArray(name);
}

}  // namespace nephele
