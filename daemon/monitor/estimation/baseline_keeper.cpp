// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/baseline_keeper.h"

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/base/log.h"
#include "daemon/config/learned_files.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {

BaselineKeeper::BaselineKeeper(const Config& config)
    : table_(config.pipeline.parameters()), written_(static_cast<std::size_t>(table_.size())) {
  if (!config.watch) return;
  path_ = config.watch->baseline_path;
  if (config.watch->baseline) written_ = *config.watch->baseline;
}

void BaselineKeeper::update(const Estimation& estimation) {
  const estimator::Baseline* baseline = estimation.baseline();
  if (path_.empty() || baseline == nullptr || written_.holds(*baseline)) return;
  std::string none;
  const std::string there = read_text_file(path_, none).value_or("");
  const std::string text = there.empty()
                               ? baseline_text(*baseline, table_)
                               : extended_baseline_text(there, written_, *baseline, table_);
  written_ = *baseline;
  if (text == there) return;
  const std::string problem = drivers::write_text_file(path_, text);
  if (problem.empty())
    log(LogLevel::notice, fmt::format("learned the baseline of {} parameters and wrote it to {}",
                                      baseline->known(), path_));
  else
    log(LogLevel::error, fmt::format("cannot store the learned baseline: {}", problem));
}

}  // namespace framewatch::daemon
