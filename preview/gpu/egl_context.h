// An OpenGL context without a display or window, through EGL. Depends on EGL and on gpu/gl.h.
#pragma once

namespace nephele {

/// Makes an OpenGL 4.5 core context current on this thread: Mesa's surfaceless platform, else the first EGL
/// device that has one. Throws WorldError naming the call that failed. The context goes with the object.
class EglContext {
 public:
  EglContext();
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace nephele
