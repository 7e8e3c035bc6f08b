#pragma once

#include <string>
#include <vector>

#include "daemon/base/printable.h"

namespace framewatch::daemon {

/// A table; cells are HTML. Columns that hold a number are right-aligned, the first one and those
/// of words left.
std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows);

/// HTML of plots (SvgPlot::svg()) side by side, as many as fit, with one caption.
std::string html_figure(const std::vector<std::string>& plots, const std::string& caption);

/// One self-contained page: no script, nothing fetched; light or dark as the reader's system says,
/// always light on paper. title is text, body is HTML.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace framewatch::daemon
