// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/base/printable.h"
#include "daemon/base/svg_plot.h"

namespace framewatch::daemon {

/// Returns a table whose cells are HTML. Columns of numbers are right-aligned; the first column and
/// columns of words are left-aligned.
std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows);

/// Returns plots (SvgPlot::svg()) side by side with one caption.
std::string html_figure(const std::vector<std::string>& plots, const std::string& caption);
std::string html_figure(const std::vector<Picture>& pictures, const std::string& caption);

/// Returns `body`, whose chapters begin with <h2>, behind a table of contents with links to them.
std::string with_contents(const std::string& body);

/// Returns a self-contained page without scripts or fetched files, light or dark by the reader's
/// system and light on paper. `title` is text, `body` is HTML.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace framewatch::daemon
