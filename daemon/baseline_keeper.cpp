#include "daemon/baseline_keeper.h"

#include <fmt/core.h>

#include "daemon/baseline_file.h"
#include "daemon/log.h"
#include "drivers/text_output.h"

namespace framewatch::daemon {

BaselineKeeper::BaselineKeeper(const Config& config) : table_(config.pipeline.structure) {
  if (config.watch && !config.watch->baseline) path_ = config.watch->baseline_path;
}

void BaselineKeeper::look(const Estimation& estimation) {
  if (path_.empty() || estimation.baseline() == nullptr) return;
  const std::string problem =
      drivers::write_text_file(path_, baseline_text(*estimation.baseline(), table_));
  if (problem.empty())
    log(LogLevel::notice, fmt::format("baseline learned, written to {}", path_));
  else
    log(LogLevel::error, fmt::format("the learned baseline is not stored: {}", problem));
  path_.clear();
}

}  // namespace framewatch::daemon
