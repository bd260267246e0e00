// An OpenGL context without a display or window, through EGL. Depends on EGL and on gpu/gl.h.
#pragma once

namespace nephele {

/// Makes an OpenGL 4.5 core context current on this thread: Mesa's surfaceless platform, else the first EGL
/// device that has one. It is lost, and says so (requireKeptContext), when the driver is reset, where the
/// driver offers that. Throws WorldError naming the call that failed. The context goes with the object. There
/// may be several; what GL makes belongs to the one that is current. All of them are of one thread.
class EglContext {
 public:
  EglContext();
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// For after another one was made, or went; false where EGL refuses.
  bool makeCurrent() const noexcept;

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace nephele
