// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/base/svg_plot.h"

namespace framewatch::daemon {

/// The request to write pictures.
struct PictureFiles {
  std::string folder;                          ///< empty: no pictures
  std::vector<std::string> formats = {"svg"};  ///< svg, pdf, png
};

/// Widths of a paper's column and of its page.
constexpr double kOneColumn_mm = 85, kTwoColumns_mm = 178;

/// Writes each picture in each format and both widths, as NAME-1col.pdf and NAME-2col.pdf, and its
/// points as NAME.csv. Letters become outlines in SVG and embedded fonts in PDF. Characters that
/// file names lack become "_" in NAME. The folder is complete or absent. Returns an empty string,
/// or the reason of a failure: the folder holds files already, a file cannot be written, or
/// librsvg is missing (SvgConverter).
std::string write_pictures(const std::vector<Picture>& pictures, const PictureFiles& files);

/// Returns why `path` is not a name for a page: its ending is that of another format. Returns ""
/// for names without an ending, .html and .htm.
std::string problem_of_page_name(const std::string& path);

}  // namespace framewatch::daemon
