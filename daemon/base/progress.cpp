#include "daemon/base/progress.h"

#include <unistd.h>

#include <utility>

#include <fmt/core.h>

namespace framewatch::daemon {

Progress::Progress(std::string command, std::int64_t total, std::string rate_unit, double scale,
                   bool quiet)
    : command_(std::move(command)),
      rate_unit_(std::move(rate_unit)),
      total_(total),
      scale_(scale),
      on_(!quiet && ::isatty(2) == 1) {}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\n");
}

void Progress::show(std::int64_t done) {
  if (done <= 0 || total_ <= 0) return;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  if (elapsed.count() < next_s_) return;
  next_s_ = elapsed.count() + 0.5;
  shown_ = true;
  const double share = static_cast<double>(done) / static_cast<double>(total_);
  fmt::print(stderr, "\r{}: {:3.0f} %, {:.3g} {}/s, {:.0f} s left ", command_, 100 * share,
             static_cast<double>(done) / scale_ / elapsed.count(), rate_unit_,
             elapsed.count() * (1 / share - 1));
}

}  // namespace framewatch::daemon
