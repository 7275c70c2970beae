#pragma once
/// @file
/// A render window without a display, on an EGL context of our own.

#include <string>

#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>

namespace tautline::output::render {

/// Pixels are drawn at twice the size of the picture and averaged: smooth lines and text on any driver.
constexpr int supersampling = 2;

/// One picture: add renderers to window(), then write().
class Offscreen {
 public:
  /// @throws std::runtime_error with the remedy if there is no OpenGL
  Offscreen(int width, int height);
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;
  ~Offscreen();

  vtkRenderWindow* window() { return window_; }
  /// Renders and writes the PNG. @throws std::runtime_error naming the reason
  void write(const std::string& png_path);

 private:
  int width_, height_;
  vtkNew<vtkGenericOpenGLRenderWindow> window_;
};

}  // namespace tautline::output::render
