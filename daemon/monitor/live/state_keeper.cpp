// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/state_keeper.h"

#include <chrono>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/monitor/estimation/state_file.h"
#include "drivers/files/caught.h"

namespace framewatch::daemon {
namespace {

std::string written_or_why(const std::string& path, const SavedState& state) {
  std::string problem;
  const std::string thrown = drivers::caught([&] { problem = write_state(path, state); });
  return thrown.empty() ? problem : thrown;
}

}  // namespace

StateKeeper::StateKeeper(std::string path, int every_s)
    : path_(std::move(path)), every_us_(1'000'000LL * every_s) {}

void StateKeeper::update(const Config& config, Estimation& estimation, std::int64_t now_us) {
  if (path_.empty()) return;
  if (next_us_ == 0) next_us_ = now_us + every_us_;
  if (now_us < next_us_ || !written()) return;
  next_us_ = now_us + every_us_;
  const std::string thrown = drivers::caught([&] {
    writing_ = std::async(std::launch::async,
                          [path = path_, state = saved_state(config, estimation, 0)]() {
                            return written_or_why(path, state);
                          });
  });
  if (!thrown.empty()) report("cannot start a thread: " + thrown);
}

void StateKeeper::keep(const Config& config, Estimation& estimation) {
  if (writing_.valid()) report(writing_.get());
  std::string problem;
  const std::string thrown =
      drivers::caught([&] { problem = write_state(path_, saved_state(config, estimation, 0)); });
  report(thrown.empty() ? problem : thrown);
}

bool StateKeeper::written() {
  if (!writing_.valid()) return true;
  if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  report(writing_.get());
  return true;
}

void StateKeeper::report(std::string problem) {
  if (problem.empty()) written_us_ = host_clock_us();
  if (!problem.empty())
    log(LogLevel::error,
        fmt::format(
            "{}: cannot write the state: {}. Check the disk: a restart resumes from an older state",
            path_, problem));
  problem_ = std::move(problem);
}

}  // namespace framewatch::daemon
