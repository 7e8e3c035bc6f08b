#include "daemon/config.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "daemon/config_can.h"
#include "daemon/config_effects.h"
#include "daemon/config_parts.h"
#include "daemon/config_suggest.h"
#include "daemon/file_digest.h"

namespace framewatch::daemon {
namespace {

void check_sections(const TomlValue& document, std::vector<TextProblem>& problems) {
  const std::vector<std::string> known{"structure", "channel",  "estimator", "lcm",
                                       "can",       "can_node", "watch",     "gap",
                                       "history",   "actions",  "effect"};
  for (const TomlEntry& entry : document.entries) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    const std::string meant = nearest(entry.key, known);
    problems.push_back(
        {entry.place,
         fmt::format("unknown section or key {}: {}", entry.key,
                     meant.empty()
                         ? "the sections are [structure], [structure.design], "
                           "[[channel]], [estimator], [lcm], [[can]], "
                           "[[can_node]], [watch], [gap], [history], [actions], [[effect]]"
                         : fmt::format("did you mean {}?", meant))});
  }
}

}  // namespace

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

bool read_config(const TomlValue& document, Config& config, std::vector<TextProblem>& problems) {
  const std::size_t before = problems.size();
  check_sections(document, problems);
  const StructureReading structure = read_structure(document, problems);
  config.pipeline.structure = structure.structure;
  config.pipeline.design = structure.design;
  read_channels(document, structure, config, problems);
  config.pipeline.options = read_estimator(document, problems);
  config.lcm = read_lcm(document, problems);
  read_can(document, config, problems);
  config.watch = read_watch(document, problems);
  if (config.watch) config.pipeline.options.long_window_s = config.watch->options.quiet_window_s;
  config.gap = read_gap(document, problems);
  config.history = read_history(document, problems);
  config.actions = read_actions(document, problems);
  if (problems.size() == before)
    for (const std::string& rule : framewatch::problems(config.pipeline))
      problems.push_back({{}, rule});
  const bool sound = problems.size() == before;
  const std::vector<const TomlValue*> effects = tables_of(document, "effect", problems);
  if (sound)
    config.effects = read_effects(effects, structure.structure, config.pipeline.axes, problems);
  return problems.size() == before;
}

std::optional<Config> parse_config(const std::string& path, const std::string& text,
                                   std::vector<ConfigProblem>& problems) {
  Config config;
  config.path = path;
  config.sha256 = sha256(text);
  std::vector<TextProblem> found;
  if (const std::optional<TomlValue> document = parse_toml(text, found))
    read_config(*document, config, found);
  if (found.empty()) {
    load_watch_baseline(config, problems);
    load_gap_model(config, problems);
    place_history(config);
    place_actions(config);
    if (problems.empty()) return config;
    return std::nullopt;
  }
  problems = with_file(path, std::move(found));
  return std::nullopt;
}

std::optional<Config> load_config(const std::string& path, std::vector<ConfigProblem>& problems) {
  problems.clear();
  std::string error;
  const std::optional<std::string> text = read_text_file(path, error);
  if (!text) {
    problems.push_back({path, error});
    return std::nullopt;
  }
  return parse_config(path, *text, problems);
}

}  // namespace framewatch::daemon
