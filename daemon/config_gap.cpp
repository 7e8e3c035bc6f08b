#include <filesystem>

#include "daemon/config_parts.h"
#include "daemon/config_section.h"
#include "daemon/gap_model.h"

namespace framewatch::daemon {

std::optional<GapSettings> read_gap(const TomlValue& document, std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("gap");
  if (entry == nullptr) return std::nullopt;
  ConfigSection section("gap", "gap", &entry->value, {1, 1}, problems);
  GapSettings out;
  if (section.given("model")) out.model_path = section.text("model");
  if (section.given("store")) out.store = section.text("store");
  out.options.learn_s = section.number("learn_s");
  out.options.window_s = section.integer("window_s");
  out.options.raise_ratio = section.number("raise_ratio");
  out.options.lasting_s = section.number("lasting_s");
  out.before_s = section.number("store_before_s");
  out.after_s = section.number("store_after_s");
  return out;
}

void load_gap_model(Config& config, std::vector<ConfigProblem>& problems) {
  if (!config.gap) return;
  const std::filesystem::path beside = std::filesystem::path(config.path).parent_path();
  if (!config.gap->store.empty()) config.gap->store = (beside / config.gap->store).string();
  if (config.gap->model_path.empty()) return;
  config.gap->model_path = (beside / config.gap->model_path).string();
  if (!std::filesystem::exists(config.gap->model_path)) return;
  config.gap->model = load_gap_model_file(config, config.gap->model_path, problems);
}

}  // namespace framewatch::daemon
