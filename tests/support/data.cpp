// SPDX-License-Identifier: MIT
#include "tests/support/data.h"

#include <cstdlib>
#include <filesystem>

namespace framewatch::test {

std::optional<std::string> data_path(const std::string& relative) {
  const char* set = std::getenv("FRAMEWATCH_DATA");
  const std::filesystem::path root = set != nullptr ? set : FRAMEWATCH_DATA_DEFAULT;
  const std::filesystem::path path = root / relative;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path.string();
}

}  // namespace framewatch::test
