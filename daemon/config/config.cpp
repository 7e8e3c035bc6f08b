// SPDX-License-Identifier: MIT
#include "daemon/config/config.h"

#include <utility>

#include "daemon/base/file_digest.h"
#include "daemon/config/changes.h"
#include "daemon/config/keys/option_table.h"
#include "daemon/config/learned_files.h"
#include "daemon/config/plausibility/doubted_building.h"
#include "daemon/config/read_config.h"
#include "drivers/files/standard_streams.h"

namespace framewatch::daemon {
namespace {

void place_all_files(Config& config) {
  const std::string beside = drivers::folder_of_paths_in(config.path);
  place_files("commands", beside, config.commands);
  if (config.mqtt) place_files("mqtt", beside, *config.mqtt);
  if (config.watch) place_files("watch", beside, *config.watch);
  if (config.gap) place_files("gap", beside, *config.gap);
  if (config.history) place_files("history", beside, *config.history);
  if (config.event_report) place_files("event_report", beside, *config.event_report);
  if (config.actions) place_files("actions", beside, *config.actions);
  if (config.email) place_files("email", beside, *config.email);
  if (config.report) place_files("report", beside, *config.report);
  if (config.actions && config.email) config.actions->account = *config.email;
  if (config.fleet) place_files("fleet", beside, *config.fleet);
}

}  // namespace

std::optional<Config> parse_config(const std::string& path, const std::string& text,
                                   std::vector<ConfigProblem>& problems) {
  Config config;
  config.path = path;
  config.sha256 = sha256(text);
  std::vector<TextProblem> found;
  const std::optional<TomlValue> document = parse_toml(text, found);
  if (document) config.section_sha256 = section_digests(*document);
  if (document && read_config(*document, config, found))
    for (ConfigProblem& doubt : with_file(
             path, doubted_values(*document, config.pipeline.structure, config.pipeline.design)))
      config.doubts.push_back(std::move(doubt));
  if (found.empty()) {
    place_all_files(config);
    load_watch_baseline(config, problems);
    load_gap_model(config, problems);
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
  if (text) return parse_config(path, *text, problems);
  problems.push_back({path, error});
  return std::nullopt;
}

}  // namespace framewatch::daemon
