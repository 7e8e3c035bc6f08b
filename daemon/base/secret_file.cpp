// SPDX-License-Identifier: MIT
#include "daemon/base/secret_file.h"

#include "daemon/base/file_digest.h"

namespace framewatch::daemon {

std::optional<std::string> read_secret(const std::string& path, std::string& trouble) {
  const std::optional<std::string> text = read_text_file(path, trouble);
  if (!text) {
    trouble = path + ": " + trouble;
    return std::nullopt;
  }
  constexpr const char* kBlanks = " \t\r";
  const std::string line = text->substr(0, text->find('\n'));
  const auto first = line.find_first_not_of(kBlanks);
  if (first == std::string::npos) {
    trouble = path + ": the first line is empty";
    return std::nullopt;
  }
  return line.substr(first, line.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace framewatch::daemon
