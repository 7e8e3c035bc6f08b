#pragma once

#include <string>

namespace framewatch::daemon {

/// A number as JSON writes it, with 9 digits; null when it is not finite.
std::string json_number(double value);
/// A string as JSON writes it, with quotes and escapes; bytes that are no UTF-8 are replaced.
std::string json_text(const std::string& text);

}  // namespace framewatch::daemon
