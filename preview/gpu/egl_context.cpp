// EGL without a surface. Depends on EGL and on gpu/gl.h.
#include "preview/gpu/egl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <map>
#include <string>
#include <vector>

#include "preview/gpu/gl.h"

namespace nephele {
namespace {

bool offers(const char* extensions, const std::string& name) {
  return extensions != nullptr &&
         (" " + std::string(extensions) + " ").find(" " + name + " ") != std::string::npos;
}

/// Displays to try, best first; not yet initialised.
std::vector<EGLDisplay> candidateDisplays() {
  std::vector<EGLDisplay> displays;
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (offers(extensions, "EGL_MESA_platform_surfaceless"))
    displays.push_back(eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  const auto queryDevices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  if (offers(extensions, "EGL_EXT_platform_device") && queryDevices != nullptr) {
    EGLint count = 0;
    queryDevices(0, nullptr, &count);
    std::vector<EGLDeviceEXT> devices(static_cast<size_t>(count));
    if (count > 0 && queryDevices(count, devices.data(), &count)) {
      for (EGLDeviceEXT device : devices)
        displays.push_back(eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
    }
  }
  return displays;
}

/// One that is lost when the driver is reset, and says so, or a plain one where the driver refuses;
/// EGL_NO_CONTEXT where it refuses both.
EGLContext createContext(EGLDisplay display, EGLConfig config) {
  std::vector<EGLint> attributes = {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE,
                                    EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                    EGL_LOSE_CONTEXT_ON_RESET};
  const std::vector<EGLint> plain = {EGL_CONTEXT_MAJOR_VERSION,
                                     4,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     5,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_CONTEXT_OPENGL_DEBUG,
                                     EGL_TRUE,
                                     EGL_NONE};
  attributes.insert(attributes.end(), plain.begin(), plain.end());
  const EGLContext robust = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
  return robust != EGL_NO_CONTEXT ? robust : eglCreateContext(display, config, EGL_NO_CONTEXT, plain.data());
}

/// A context that is current on `display`, or EGL_NO_CONTEXT with the reason in `why`.
EGLContext contextOn(EGLDisplay display, std::string& why) {
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) {
    why = "eglInitialize failed";
    return EGL_NO_CONTEXT;
  }
  const EGLint configAttributes[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = EGL_NO_CONFIG_KHR;
  EGLint count = 0;
  eglChooseConfig(display, configAttributes, &config, 1, &count);
  EGLContext context = EGL_NO_CONTEXT;
  if (!eglBindAPI(EGL_OPENGL_API)) {
    why = "eglBindAPI: no desktop OpenGL";
  } else if (context = createContext(display, count > 0 ? config : EGL_NO_CONFIG_KHR);
             context == EGL_NO_CONTEXT) {
    why = "eglCreateContext: no OpenGL 4.5 core";
  } else if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    why = "eglMakeCurrent failed without a surface";
    eglDestroyContext(display, context);
    context = EGL_NO_CONTEXT;
  }
  return context;
}

/// Contexts that live on each display, which ends with the last.
std::map<EGLDisplay, int>& contextsOf() {
  static std::map<EGLDisplay, int> contexts;
  return contexts;
}

}  // namespace

EglContext::EglContext() {
  std::string why = "EGL offers neither the surfaceless nor the device platform";
  for (EGLDisplay display : candidateDisplays()) {
    EGLContext context = contextOn(display, why);
    if (context == EGL_NO_CONTEXT) {
      if (display != EGL_NO_DISPLAY && contextsOf()[display] == 0) eglTerminate(display);
      continue;
    }
    ++contextsOf()[display];
    display_ = display;
    context_ = context;
    loadGl(reinterpret_cast<GLADloadfunc>(eglGetProcAddress));
    return;
  }
  throw WorldError("no OpenGL without a display: " + why);
}

EglContext::~EglContext() {
  if (context_ == nullptr) return;
  if (eglGetCurrentContext() == context_)
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  if (--contextsOf()[display_] == 0) eglTerminate(display_);
}

bool EglContext::makeCurrent() const noexcept {
  return eglGetCurrentContext() == context_ ||
         eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
}

}  // namespace nephele
