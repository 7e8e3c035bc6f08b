// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/tools/lab/reproduction.h"

namespace framewatch::daemon {

/// Returns everything as one HTML page; the same results give the same bytes. only: the argument of
/// reproduce_paper(), for the commands that the page names.
std::string reproduction_html(const Reproduction& all, const std::string& only);

/// Returns the tables of accuracy as Markdown, the accuracy.md that `reproduce` writes. They come
/// from seeded motions, so they are the same with and without FRAMEWATCH_DATA.
std::string accuracy_markdown(const Reproduction& all);

}  // namespace framewatch::daemon
