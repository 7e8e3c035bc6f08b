// SPDX-License-Identifier: MIT
#include "daemon/config/sections/config_problems.h"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/base/log.h"
#include "daemon/base/printable.h"

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

std::vector<ConfigProblem> with_file(const std::string& path, std::vector<TextProblem> problems) {
  std::stable_sort(problems.begin(), problems.end(), [](const auto& a, const auto& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  std::vector<ConfigProblem> out;
  for (const TextProblem& p : problems)
    out.push_back({!p.elsewhere.empty() ? p.elsewhere
                   : p.place.line > 0 ? fmt::format("{}:{}:{}", path, p.place.line, p.place.column)
                                      : path,
                   p.message});
  return out;
}

void print_problems(const std::vector<ConfigProblem>& problems) {
  constexpr std::size_t kPrinted = 20;
  const std::size_t printed = std::min(problems.size(), kPrinted);
  for (const ConfigProblem& p : std::span(problems).first(printed))
    fmt::print(stderr, "{} {}\n", toned(Tone::bad, printable(p.where) + ":", stderr),
               printable_lines(p.message));
  if (problems.size() > printed)
    fmt::print(stderr, "and {} more problems\n", problems.size() - printed);
}

void log_doubts(const std::vector<ConfigProblem>& doubts) {
  for (const ConfigProblem& doubt : doubts)
    log(LogLevel::warning, fmt::format("{}: {}", doubt.where, doubt.message));
}

}  // namespace framewatch::daemon
