#include "output/render/egl_context.hpp"

#include <stdexcept>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include "output/render/plugin.hpp"

namespace tautline::output::render {

namespace {

[[noreturn]] void fail(const char* doing) {
  throw std::runtime_error(fmt::format("{} failed (EGL error {:#x})\n  {}", doing, eglGetError(), remedy));
}

struct Context {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLSurface surface = EGL_NO_SURFACE;
  EGLContext context = EGL_NO_CONTEXT;
};

bool initialised(EGLDisplay display) {
  return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE;
}

/// A display that needs no screen: Mesa's surfaceless platform, else whatever EGL offers by default.
EGLDisplay open_display() {
  const EGLDisplay surfaceless =
      eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (initialised(surfaceless)) return surfaceless;
  const EGLDisplay other = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  if (initialised(other)) return other;
  fail("opening OpenGL without a display");
}

EGLContext create_context(EGLDisplay display, EGLConfig config) {
  for (const EGLint minor : {3, 2}) {
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 3,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 minor,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    if (context != EGL_NO_CONTEXT) return context;
  }
  fail("creating an OpenGL 3.2 context");
}

Context create() {
  Context result;
  result.display = open_display();
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) fail("binding OpenGL");
  const EGLint wanted[] = {EGL_SURFACE_TYPE,
                           EGL_PBUFFER_BIT,
                           EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_BIT,
                           EGL_RED_SIZE,
                           8,
                           EGL_GREEN_SIZE,
                           8,
                           EGL_BLUE_SIZE,
                           8,
                           EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(result.display, wanted, &config, 1, &count) != EGL_TRUE || count < 1)
    fail("choosing an OpenGL configuration");
  result.context = create_context(result.display, config);
  if (eglMakeCurrent(result.display, EGL_NO_SURFACE, EGL_NO_SURFACE, result.context) == EGL_TRUE)
    return result;
  const EGLint size[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
  result.surface = eglCreatePbufferSurface(result.display, config, size);
  return result;
}

}  // namespace

void make_context_current() {
  static const Context context = create();  // never destroyed: VTK objects may outlive static destructors
  if (eglMakeCurrent(context.display, context.surface, context.surface, context.context) != EGL_TRUE)
    fail("making the OpenGL context current");
}

}  // namespace tautline::output::render
