#include "daemon/config/gap_model.h"

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/base/toml_document.h"
#include "daemon/config/axis_names.h"
#include "daemon/config/read_config.h"
#include "daemon/config/toml_file.h"
#include "drivers/files/input_file.h"

namespace framewatch::daemon {
namespace {

/// What keeps a model from being of this building; empty when nothing does.
std::string difference(const Config& config, const Config& model) {
  const estimator::Structure &a = config.pipeline.structure, &b = model.pipeline.structure;
  if (a.stories != b.stories || a.frames_x != b.frames_x || a.frames_y != b.frames_y ||
      a.floor != b.floor)
    return "has other stories, frames or floors";
  if (axis_names(config) != axis_names(model)) return "has other channels";
  return {};
}

}  // namespace

std::optional<estimator::GapModel> parse_gap_model(const Config& config, const std::string& path,
                                                   const std::string& text,
                                                   std::vector<ConfigProblem>& problems) {
  Config model;
  const bool good = read_toml(
      path, text,
      [&](const TomlValue& document, std::vector<TextProblem>& found) {
        if (!read_config(document, model, found)) return;
        const std::string other = difference(config, model);
        if (!other.empty())
          found.push_back({{}, fmt::format("is no model of {}: it {}", config.path, other)});
        else if (model.pipeline.design.size() == 0)
          found.push_back({{}, "is no model: it has no [structure.design]"});
      },
      problems);
  if (!good) return std::nullopt;
  return estimator::GapModel{model.pipeline.design, model.effects};
}

std::optional<estimator::GapModel> load_gap_model_file(const Config& config,
                                                       const std::string& path,
                                                       std::vector<ConfigProblem>& problems) {
  std::string error;
  const std::optional<std::string> text = read_text_file(path, error);
  if (text) return parse_gap_model(config, path, *text, problems);
  problems.push_back({path, error});
  return std::nullopt;
}

void load_gap_model(Config& config, std::vector<ConfigProblem>& problems) {
  if (!config.gap || config.gap->model_path.empty()) return;
  if (drivers::is_absent(config.gap->model_path)) return;
  config.gap->model = load_gap_model_file(config, config.gap->model_path, problems);
}

std::string segment_name(const Config& config, std::int64_t gap_id) {
  const bool stored = config.gap && !config.gap->store.empty();
  return stored ? fmt::format("gap-{}.lcmlog", gap_id) : "";
}

}  // namespace framewatch::daemon
