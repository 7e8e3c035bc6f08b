#include "fleet/hub/replace_file.h"

#include <cstdio>

#include <fmt/core.h>

#include "drivers/files/partial_file.h"

namespace framewatch::fleet {

std::string replace_file(const std::string& path, const std::string& text) {
  drivers::PartialFile file;
  if (!file.open(path)) return fmt::format("{}: {}", path, file.error());
  std::FILE* stream = file.stream();
  const bool written = stream != nullptr &&
                       std::fwrite(text.data(), 1, text.size(), stream) == text.size() &&
                       std::fclose(stream) == 0;
  if (!written || !file.commit()) return fmt::format("{}: {}", path, file.error());
  return {};
}

}  // namespace framewatch::fleet
