// OpenGL made safe: loading for any context, owning handles, errors that become WorldError. Depends on glad
// and base.
#pragma once

#include <glad/gl.h>

#include <cstdint>
#include <string>
#include <utility>

#include "base/error.h"

namespace nephele {

/// Loads the functions of the context that is current and asks for its debug messages. `loader` is the
/// context's own (eglGetProcAddress, glfwGetProcAddress). Throws WorldError where the context is older than
/// OpenGL 4.5 core.
void loadGl(GLADloadfunc loader);

/// "llvmpipe (LLVM 15.0.6, 256 bits)": GL_RENDERER of the current context.
std::string glRenderer();

/// Throws WorldError with `call` and what the driver said since the last call of this, where it reported an
/// error.
void checkGl(const std::string& call);

/// Throws WorldError where the current context was lost by a reset of the graphics driver: what was drawn and
/// read since means nothing. `what` was being done. Contexts that were not made to tell never do.
void requireKeptContext(const std::string& what);

/// Waits until all commands given so far are done, then checks them.
void finishGl(const std::string& call);

/// GL objects that handles took and gave back since the program began, on all threads: for tests of leaks.
struct GlCounts {
  uint64_t made = 0;
  uint64_t destroyed = 0;
};
GlCounts glCounts();
void countMade();
void countDestroyed();

/// Owns one GL object; 0 is none. The context that made it must be current when it goes.
template <void (*destroy)(GLuint)>
class GlHandle {
 public:
  GlHandle() = default;
  explicit GlHandle(GLuint name) : name_(name) {
    if (name_ != 0) countMade();
  }
  GlHandle(GlHandle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlHandle& operator=(GlHandle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlHandle() {
    if (name_ == 0) return;
    destroy(name_);
    countDestroyed();
  }
  GLuint name() const { return name_; }

 private:
  GLuint name_ = 0;
};

void destroyTexture(GLuint name);
void destroyBuffer(GLuint name);
void destroyFramebuffer(GLuint name);
void destroyVertexArray(GLuint name);
void destroyProgram(GLuint name);
void destroyShader(GLuint name);

using GlTexture = GlHandle<destroyTexture>;
using GlBuffer = GlHandle<destroyBuffer>;
using GlFramebuffer = GlHandle<destroyFramebuffer>;
using GlVertexArray = GlHandle<destroyVertexArray>;
using GlProgram = GlHandle<destroyProgram>;
using GlShader = GlHandle<destroyShader>;

GlTexture makeTexture(GLenum target);
GlBuffer makeBuffer();
GlFramebuffer makeFramebuffer();
GlVertexArray makeVertexArray();

}  // namespace nephele
