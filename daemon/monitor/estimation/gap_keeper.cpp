#include "daemon/monitor/estimation/gap_keeper.h"

#include <utility>

#include <fmt/core.h>

#include "daemon/base/log.h"
#include "daemon/config/learned_files.h"

namespace framewatch::daemon {
namespace {

/// When the file was last written; the epoch when there is none.
std::filesystem::file_time_type put_there(const std::string& path) {
  std::error_code none;
  const auto at = std::filesystem::last_write_time(path, none);
  return none ? std::filesystem::file_time_type{} : at;
}

}  // namespace

GapKeeper::GapKeeper(const Config& config) : config_(&config) {
  if (config.gap && !config.gap->model_path.empty()) seen_ = put_there(config.gap->model_path);
}

void GapKeeper::look(Estimation& estimation, std::int64_t now_us) {
  if (!config_->gap || config_->gap->model_path.empty() || !second_.due(now_us)) return;
  const std::string& path = config_->gap->model_path;
  const auto at = put_there(path);
  if (at == std::exchange(seen_, at) || at == std::filesystem::file_time_type{}) return;
  std::vector<ConfigProblem> problems;
  if (const auto model = load_gap_model_file(*config_, path, problems)) {
    estimation.adopt(*model);
    log(LogLevel::notice, fmt::format("adopted {}: {} effects", path, model->effects.size()));
  }
  for (const ConfigProblem& p : problems)
    log(LogLevel::error, fmt::format("not adopted: {}: {}", p.where, p.message));
}

}  // namespace framewatch::daemon
