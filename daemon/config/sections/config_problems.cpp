#include "daemon/config/sections/config_problems.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/log.h"
#include "daemon/base/printable.h"

namespace framewatch::daemon {

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
  for (const ConfigProblem& p : problems)
    fmt::print(stderr, "{} {}\n", toned(Tone::bad, printable(p.where) + ":", stderr),
               printable_lines(p.message));
}

void log_doubts(const std::vector<ConfigProblem>& doubts) {
  for (const ConfigProblem& doubt : doubts)
    log(LogLevel::warning, fmt::format("{}: {}", doubt.where, doubt.message));
}

}  // namespace framewatch::daemon
