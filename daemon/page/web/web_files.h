// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace framewatch::daemon {

struct WebFile {
  std::string type;
  std::string content;
};
/// Returns the files of the built-in page by path.
const std::map<std::string, WebFile>& page_files();

}  // namespace framewatch::daemon
