#pragma once

#include <string>

namespace framewatch::daemon {

/// Text with the characters escaped that are markup in HTML: & < > and quotes.
std::string html_text(const std::string& text);

}  // namespace framewatch::daemon
