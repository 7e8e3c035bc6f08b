#include "daemon/config/toml_file.h"

#include <utility>

#include "daemon/base/file_digest.h"
#include "daemon/base/toml_document.h"

namespace framewatch::daemon {

bool read_toml(const std::string& path, const std::string& text, const TomlReader& read,
               std::vector<ConfigProblem>& problems) {
  std::vector<TextProblem> found;
  if (const std::optional<TomlValue> document = parse_toml(text, found)) read(*document, found);
  const bool good = found.empty();
  for (ConfigProblem& p : with_file(path, std::move(found))) problems.push_back(std::move(p));
  return good;
}

bool read_toml_file(const std::string& path, const TomlReader& read,
                    std::vector<ConfigProblem>& problems) {
  std::string error;
  const std::optional<std::string> text = read_text_file(path, error);
  if (text) return read_toml(path, *text, read, problems);
  problems.push_back({path, error});
  return false;
}

}  // namespace framewatch::daemon
