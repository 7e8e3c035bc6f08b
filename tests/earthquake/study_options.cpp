// SPDX-License-Identifier: MIT
#include "tests/earthquake/study_options.h"

#include <algorithm>
#include <cstdlib>

namespace framewatch::earthquake {

std::optional<StudyOptions> StudyOptions::read(int count, char** arguments,
                                               const std::vector<std::string>& known) {
  StudyOptions out;
  for (int i = 1; i < count; i += 2) {
    const std::string name = arguments[i];
    if (std::find(known.begin(), known.end(), name) == known.end() || i + 1 == count)
      return std::nullopt;
    char* end = nullptr;
    out.numbers_[name] = std::strtod(arguments[i + 1], &end);
    if (end == arguments[i + 1] || *end != '\0') return std::nullopt;
  }
  return out;
}

double StudyOptions::number(const std::string& name, double usual) const {
  const auto at = numbers_.find(name);
  return at == numbers_.end() ? usual : at->second;
}

}  // namespace framewatch::earthquake
