// SPDX-License-Identifier: MIT
#include "daemon/tools/demo/demo_view.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <span>
#include <utility>

#include <fmt/core.h>
#include <fmt/format.h>

#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr double kRedraw_s = 0.25;
constexpr double kLine_s = 5;
constexpr const char *kParameters = "PARAMETERS", *kEstimate = "ESTIMATE";

std::size_t terminal_columns() {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

std::span<const std::uint8_t> payload(const drivers::LcmMessage& message) {
  return {static_cast<const std::uint8_t*>(message.data), message.size};
}

std::string describe(const GroupError& error, double limit_ratio) {
  if (!error.without.empty()) return fmt::format("no value for {}", fmt::join(error.without, ", "));
  return fmt::format("within {:.2g} % of truth ({}; limit {:g} %)", 100 * error.worst_ratio,
                     error.worst, 100 * limit_ratio);
}

bool holds(const GroupError& error, double limit_ratio) {
  return error.without.empty() && !error.worst.empty() && error.worst_ratio <= limit_ratio;
}

}  // namespace

DemoView::DemoView(std::map<std::string, double> truth, bool terminal, bool quiet)
    : truth_by_name_(std::move(truth)), terminal_(terminal), quiet_(quiet) {}

std::vector<std::string> DemoView::channels(const std::string& prefix) {
  return {prefix + kParameters, prefix + kEstimate};
}

void DemoView::message(const drivers::LcmMessage& message) {
  if (message.channel.ends_with(kParameters)) parameters(message);
  if (message.channel.ends_with(kEstimate)) estimate(message);
}

void DemoView::set_truth(std::map<std::string, double> truth) {
  truth_by_name_ = std::move(truth);
  worst_frame_ratio_ = worst_panel_ratio_ = 0;
  valid_ = 0;
  for (std::size_t i = 0; table_ && i < truth_.size(); ++i)
    truth_[i] = truth_by_name_.at(table_->name[i]);
}

void DemoView::parameters(const drivers::LcmMessage& message) {
  auto table = drivers::decoded<parameter_table_t>(payload(message));
  if (!table) return;
  truth_.clear();
  for (const std::string& name : table->name) {
    const auto at = truth_by_name_.find(name);
    truth_.push_back(at == truth_by_name_.end() ? std::numeric_limits<double>::quiet_NaN()
                                                : at->second);
  }
  table_ = std::move(table);
}

void DemoView::estimate(const drivers::LcmMessage& message) {
  auto decoded = drivers::decoded<window_estimate_t>(payload(message));
  if (!decoded) return;
  window_estimate_t& estimate = *decoded;
  if (next_sequence_ >= 0) lost_ += std::max<std::int64_t>(estimate.sequence - next_sequence_, 0);
  next_sequence_ = estimate.sequence + 1;
  ++windows_;
  // A window without statistics keeps the previous ones on the screen.
  if (estimate.boxplots == 0) {
    estimate.q1 = std::move(estimate_.q1);
    estimate.median = std::move(estimate_.median);
    estimate.q3 = std::move(estimate_.q3);
  }
  estimate_ = std::move(estimate);
  if (!table_ || estimate_.status != 1) return;
  ++valid_;
  const EstimateErrors errors = errors_against(*table_, estimate_, truth_);
  worst_frame_ratio_ = std::max(worst_frame_ratio_, errors.frames.worst_ratio);
  worst_panel_ratio_ = std::max(worst_panel_ratio_, errors.panels.worst_ratio);
}

std::string DemoView::state() const {
  std::string out = fmt::format("{} windows received, {} valid", windows_, valid_);
  if (lost_ > 0) out += fmt::format(", {} lost", lost_);
  if (valid_ > 0)
    out += fmt::format("; worst of all valid: frames {:.2g} %, panels {:.2g} %",
                       100 * worst_frame_ratio_, 100 * worst_panel_ratio_);
  return out;
}

void DemoView::update(double elapsed_s, double total_s) {
  if (quiet_ || elapsed_s < next_draw_s_) return;
  next_draw_s_ = elapsed_s + (terminal_ ? kRedraw_s : kLine_s);
  const std::string now = windows_ == 0 ? "waiting for the first window" : state();
  if (terminal_) {
    draw(fmt::format("{:.0f} of {:.0f} s, {}", elapsed_s, total_s, now));
  } else {
    fmt::print("{:3.0f} s  {}\n", elapsed_s, now);
  }
  std::fflush(stdout);
}

void DemoView::draw(const std::string& last_line) {
  std::vector<std::string> lines;
  if (table_) lines = estimate_table(*table_, estimate_, truth_);
  lines.push_back(last_line);
  if (lines_drawn_ > 0) fmt::print("\x1b[{}A", lines_drawn_);
  const std::size_t columns = terminal_columns();
  for (const std::string& line : lines) fmt::print("\x1b[2K{}\n", line.substr(0, columns - 1));
  lines_drawn_ = lines.size();
}

int DemoView::finish() {
  if (!table_) {
    fmt::print("FAILED: no estimate was received\n");
    return 1;
  }
  if (!quiet_) {
    // Cuts the live table to the terminal's width, but not the last one.
    if (lines_drawn_ > 0) fmt::print("\x1b[{}A\x1b[0J", lines_drawn_);
    for (const std::string& line : estimate_table(*table_, estimate_, truth_))
      fmt::print("{}\n", line);
    fmt::print("{}\n", state());
  }
  const EstimateErrors errors = errors_against(*table_, estimate_, truth_);
  const bool panels = std::count(table_->kind.begin(), table_->kind.end(), 1) > 0;
  const bool good = holds(errors.frames, kFrameLimit_ratio) &&
                    (!panels || holds(errors.panels, kPanelLimit_ratio));
  fmt::print("{}: frame stiffness {}{}\n", good ? "HOLDS" : "FAILED",
             describe(errors.frames, kFrameLimit_ratio),
             panels ? ", floor-panel stiffness " + describe(errors.panels, kPanelLimit_ratio) : "");
  return good ? 0 : 1;
}

}  // namespace framewatch::daemon
