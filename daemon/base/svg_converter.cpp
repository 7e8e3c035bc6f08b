// SPDX-License-Identifier: MIT
#include "daemon/base/svg_converter.h"

#include <dlfcn.h>

#include <cmath>
#include <memory>
#include <utility>

#include <fmt/core.h>

#include "drivers/files/text_output.h"

#ifdef __SANITIZE_ADDRESS__
/// Tells the leak sanitizer that fontconfig never frees 300 bytes.
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "leak:libfontconfig";
}
#endif

namespace framewatch::daemon {
namespace {

constexpr double kPointsPerPixel = 72 / 96.0;
/// Pixels of a PNG; journals ask for 600 per inch in line drawings.
constexpr double kPrintedPerPixel = 600 / 96.0;

/// Values of cairo's enumerations.
constexpr int kRgb24 = 1, kUnitPixels = 3, kCreateDate = 5, kSuccess = 0;

/// Appends bytes to the string `out`, as cairo's stream functions want it.
int append(void* out, const unsigned char* bytes, unsigned size) {
  static_cast<std::string*>(out)->append(reinterpret_cast<const char*>(bytes), size);
  return kSuccess;
}

/// Returns the SVG without the number of its surface, which counts all surfaces of the program.
std::string without_number(std::string svg) {
  const std::string name = "id=\"surface";
  const std::size_t at = svg.find(name);
  if (at == std::string::npos) return svg;
  const std::size_t begin = at + name.size(), end = svg.find('"', begin);
  return svg.erase(begin, end - begin);
}

/// Sets a pointer to the function of a library. Returns false if the library lacks it.
template <typename Function>
bool find_function(void* library, const char* name, Function*& function) {
  function = reinterpret_cast<Function*>(::dlsym(library, name));
  return function != nullptr;
}

}  // namespace

/// The functions of librsvg 2.46 and cairo 1.16 and later that are used, with their documented
/// signatures.
struct SvgConverter::Functions {
  struct Rectangle {
    double x, y, width, height;
  };
  struct LibraryError {
    unsigned domain;
    int code;
    char* message;
  };

  void* (*read)(const unsigned char*, std::size_t, LibraryError**) = nullptr;
  int (*render)(void*, void*, const Rectangle*, LibraryError**) = nullptr;
  void (*free_object)(void*) = nullptr;
  void (*free_error)(LibraryError*) = nullptr;
  void* (*svg_surface)(int (*)(void*, const unsigned char*, unsigned), void*, double,
                       double) = nullptr;
  void (*svg_unit)(void*, int) = nullptr;
  void* (*pdf_surface)(const char*, double, double) = nullptr;
  void (*pdf_metadata)(void*, int, const char*) = nullptr;
  void* (*image_surface)(int, int, int) = nullptr;
  int (*write_png)(void*, const char*) = nullptr;
  void (*finish)(void*) = nullptr;
  int (*status)(void*) = nullptr;
  const char* (*status_words)(int) = nullptr;
  void (*free_surface)(void*) = nullptr;
  void* (*context)(void*) = nullptr;
  void (*free_context)(void*) = nullptr;
  void (*color)(void*, double, double, double) = nullptr;
  void (*paint)(void*) = nullptr;

  /// Loads the libraries, which stay until the program ends. Returns false if something is missing.
  bool load() {
    void* rsvg = ::dlopen("librsvg-2.so.2", RTLD_NOW | RTLD_LOCAL);
    void* cairo = ::dlopen("libcairo.so.2", RTLD_NOW | RTLD_LOCAL);
    return rsvg != nullptr && cairo != nullptr &&
           find_function(rsvg, "rsvg_handle_new_from_data", read) &&
           find_function(rsvg, "rsvg_handle_render_document", render) &&
           find_function(rsvg, "g_object_unref", free_object) &&
           find_function(rsvg, "g_error_free", free_error) &&
           find_function(cairo, "cairo_svg_surface_create_for_stream", svg_surface) &&
           find_function(cairo, "cairo_svg_surface_set_document_unit", svg_unit) &&
           find_function(cairo, "cairo_pdf_surface_create", pdf_surface) &&
           find_function(cairo, "cairo_pdf_surface_set_metadata", pdf_metadata) &&
           find_function(cairo, "cairo_image_surface_create", image_surface) &&
           find_function(cairo, "cairo_surface_write_to_png", write_png) &&
           find_function(cairo, "cairo_surface_finish", finish) &&
           find_function(cairo, "cairo_surface_status", status) &&
           find_function(cairo, "cairo_status_to_string", status_words) &&
           find_function(cairo, "cairo_surface_destroy", free_surface) &&
           find_function(cairo, "cairo_create", context) &&
           find_function(cairo, "cairo_destroy", free_context) &&
           find_function(cairo, "cairo_set_source_rgb", color) &&
           find_function(cairo, "cairo_paint", paint);
  }
};

std::optional<SvgConverter> SvgConverter::load(std::string& problem) {
  static const std::unique_ptr<const Functions> functions = [] {
    auto all = std::make_unique<Functions>();
    return all->load() ? std::move(all) : nullptr;
  }();
  if (functions) return SvgConverter(*functions);
  problem = "pictures need the libraries librsvg and cairo: install the package librsvg2-2";
  return std::nullopt;
}

std::string SvgConverter::convert(const std::string& document, double width_px, double height_px,
                                  const std::string& format, const std::string& path) const {
  Functions::LibraryError* error = nullptr;
  void* drawing =
      f_->read(reinterpret_cast<const unsigned char*>(document.data()), document.size(), &error);
  const bool png = format == "png";
  std::string svg;
  const double scale = png ? kPrintedPerPixel : format == "pdf" ? kPointsPerPixel : 1;
  const Functions::Rectangle all{0, 0, scale * width_px, scale * height_px};
  void* surface = png ? f_->image_surface(kRgb24, static_cast<int>(std::lround(all.width)),
                                          static_cast<int>(std::lround(all.height)))
                  : format == "pdf" ? f_->pdf_surface(path.c_str(), all.width, all.height)
                                    : f_->svg_surface(append, &svg, all.width, all.height);
  if (format == "svg") f_->svg_unit(surface, kUnitPixels);
  if (format == "pdf") f_->pdf_metadata(surface, kCreateDate, "1970-01-01T00:00:00Z");
  void* context = f_->context(surface);
  f_->color(context, 1, 1, 1);
  f_->paint(context);
  if (drawing != nullptr) f_->render(drawing, context, &all, &error);
  f_->free_context(context);
  int status = png ? f_->write_png(surface, path.c_str()) : kSuccess;
  f_->finish(surface);
  if (status == kSuccess) status = f_->status(surface);
  f_->free_surface(surface);
  if (drawing != nullptr) f_->free_object(drawing);
  if (error != nullptr) {
    std::string problem = fmt::format("{}: librsvg: {}", path, error->message);
    f_->free_error(error);
    return problem;
  }
  if (status != kSuccess) return fmt::format("{}: {}", path, f_->status_words(status));
  return svg.empty() ? "" : drivers::write_text_file(path, without_number(std::move(svg)));
}

}  // namespace framewatch::daemon
