// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace framewatch::daemon {

/// Converts SVG documents to files with librsvg and cairo (Debian: librsvg2-2). They are loaded
/// when needed, so that a machine that draws nothing can be without them. Several threads may
/// convert at once.
class SvgConverter {
 public:
  /// Returns nullopt and sets `problem` when a library is missing.
  static std::optional<SvgConverter> load(std::string& problem);

  /// Writes `document`, which is `width_px` x `height_px` large at 96 pixels per inch, to a file.
  /// format: svg (letters become outlines), pdf (fonts are embedded) or png (600 pixels per inch).
  /// Equal documents give equal bytes. Returns an empty string, or the reason of a failure.
  std::string convert(const std::string& document, double width_px, double height_px,
                      const std::string& format, const std::string& path) const;

 private:
  struct Functions;
  explicit SvgConverter(const Functions& functions) : f_(&functions) {}
  const Functions* f_;
};

}  // namespace framewatch::daemon
