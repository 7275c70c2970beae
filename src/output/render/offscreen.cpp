#include "output/render/offscreen.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkOpenGLState.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include "output/render/egl_context.hpp"

namespace tautline::output::render {

namespace {

/// Mean over supersampling x supersampling pixels of the RGB `source`.
void average(const unsigned char* source, vtkImageData* target) {
  constexpr int s = supersampling;
  int size[3];
  target->GetDimensions(size);
  auto* out = static_cast<unsigned char*>(target->GetScalarPointer());
  const std::ptrdiff_t row = 3 * std::ptrdiff_t{size[0]} * s;
  for (int j = 0; j < size[1]; ++j) {
    for (int i = 0; i < size[0]; ++i) {
      const unsigned char* corner = source + row * j * s + 3 * i * s;
      for (int channel = 0; channel < 3; ++channel) {
        int sum = 0;
        for (int y = 0; y < s; ++y)
          for (int x = 0; x < s; ++x) sum += corner[row * y + 3 * x + channel];
        *out++ = static_cast<unsigned char>((sum + s * s / 2) / (s * s));
      }
    }
  }
}

bool uniform(const vtkUnsignedCharArray* pixels, vtkIdType count) {
  const auto* data = const_cast<vtkUnsignedCharArray*>(pixels)->GetPointer(0);
  return std::all_of(data, data + count, [first = data[0]](unsigned char value) { return value == first; });
}

}  // namespace

Offscreen::Offscreen(int width, int height) : width_(width), height_(height) {
  vtkObject::GlobalWarningDisplayOff();  // GLEW complains about the missing X display, to no effect
  make_context_current();
  window_->SetReadyForRendering(true);
  window_->SetSupportsOpenGL(true);
  window_->SetIsDirect(true);
  window_->SetIsCurrent(true);
  window_->SetFrameBlitModeToNoBlit();
  window_->SetMultiSamples(0);
  window_->SetDPI(72);
  window_->SetSize(width * supersampling, height * supersampling);
  window_->OpenGLInit();
  window_->GetState()->Initialize(window_);  // skipped by VTK after GLEW's complaint
}

Offscreen::~Offscreen() {
  window_->Finalize();
  vtkObject::GlobalWarningDisplayOn();
}

void Offscreen::write(const std::string& png_path) {
  window_->Render();
  vtkNew<vtkUnsignedCharArray> pixels;
  const int right = width_ * supersampling - 1, top = height_ * supersampling - 1;
  const vtkIdType count = 3 * vtkIdType{right + 1} * (top + 1);
  const bool read = window_->GetPixelData(0, 0, right, top, 0, pixels, 0) == VTK_OK;
  if (!read || pixels->GetNumberOfValues() < count || uniform(pixels, count))
    throw std::runtime_error("the renderer gave an empty picture");

  vtkNew<vtkImageData> image;
  image->SetDimensions(width_, height_, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  average(pixels->GetPointer(0), image);
  const std::string temporary = png_path + ".tmp";
  ::unlink(temporary.c_str());  // a link would be followed
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(temporary.c_str());
  writer->SetInputData(image);
  errno = 0;
  writer->Write();
  if (writer->GetErrorCode() == 0 && std::rename(temporary.c_str(), png_path.c_str()) == 0) return;
  const int error_number = errno;
  std::remove(temporary.c_str());
  throw std::runtime_error(error_number != 0 ? std::strerror(error_number) : "the PNG could not be written");
}

}  // namespace tautline::output::render
