#include <filesystem>

#include "daemon/baseline_file.h"
#include "daemon/config_parts.h"
#include "daemon/config_section.h"

namespace framewatch::daemon {

std::optional<WatchSettings> read_watch(const TomlValue& document,
                                        std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("watch");
  if (entry == nullptr) return std::nullopt;
  ConfigSection section("watch", "watch", &entry->value, {1, 1}, problems);
  WatchSettings out;
  if (section.given("baseline")) out.baseline_path = section.text("baseline");
  out.options.learn_s = section.number("learn_s");
  out.options.smallest_k = section.number("smallest_change_k_ratio");
  out.options.smallest_g = section.number("smallest_change_g_ratio");
  out.options.alarms_per_year = section.number("alarms_per_year");
  out.options.shaking_hours_per_year = section.number("shaking_hours_per_year");
  out.options.quiet_window_s = section.number("quiet_window_s");
  out.options.quiet_learn_hours = section.number("quiet_learn_hours");
  out.options.amplitude = section.boolean("follow_amplitude");
  if (section.given("temperature_channel"))
    out.temperature_channel = section.text("temperature_channel");
  out.options.temperature = !out.temperature_channel.empty();
  return out;
}

void load_watch_baseline(Config& config, std::vector<ConfigProblem>& problems) {
  if (!config.watch || config.watch->baseline_path.empty()) return;
  const std::filesystem::path beside = std::filesystem::path(config.path).parent_path();
  config.watch->baseline_path = (beside / config.watch->baseline_path).string();
  if (!std::filesystem::exists(config.watch->baseline_path)) return;
  config.watch->baseline = load_baseline(config.watch->baseline_path,
                                         ParameterTable(config.pipeline.structure), problems);
}

}  // namespace framewatch::daemon
