// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/reloader.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/base/log.h"
#include "daemon/config/config.h"

namespace framewatch::daemon {

Reloader::Reloader(const Config& config, const std::string& text) : path_(config.path) {
  std::vector<TextProblem> none;
  document_ = parse_toml(text, none).value_or(TomlValue{});
}

std::optional<Reloader::Result> Reloader::read(const Config& running) {
  std::string error;
  const std::optional<std::string> text = read_text_file(path_, error);
  if (!text) return refuse({{path_, error}});
  std::vector<ConfigProblem> problems;
  const std::optional<Config> fresh = parse_config(path_, *text, problems);
  if (!fresh) return refuse(problems);
  std::vector<TextProblem> none;
  TomlValue document = parse_toml(*text, none).value_or(TomlValue{});
  const std::vector<ConfigChange> changes = changes_between(document_, document);
  std::vector<TextProblem> too_far;
  for (const ConfigChange& change : changes)
    if (change.reach == Reach::restart)
      too_far.push_back({change.place, change.described() + ": needs a restart"});
  if (!too_far.empty()) return refuse(with_file(path_, std::move(too_far)));

  Result result{reloaded(running, *fresh), Reach::settings};
  for (const ConfigChange& change : changes) {
    log(LogLevel::notice, "changed: " + change.described());
    result.reach = std::max(result.reach, change.reach);
  }
  log(LogLevel::notice, fmt::format("reloaded {}: {} changes, the window {}", path_, changes.size(),
                                    result.reach == Reach::window ? "starts empty" : "continues"));
  document_ = std::move(document);
  ++count_.done;
  count_.problem.clear();
  return result;
}

std::optional<Reloader::Result> Reloader::refuse(const std::vector<ConfigProblem>& problems) {
  for (const ConfigProblem& p : problems)
    log(LogLevel::error, fmt::format("{}: {}", p.where, p.message));
  log(LogLevel::error, fmt::format("{} was refused; the running configuration stays in force. "
                                   "Correct the file and reload again",
                                   path_));
  ++count_.refused;
  count_.problem = problems.front().where + ": " + problems.front().message;
  return std::nullopt;
}

}  // namespace framewatch::daemon
