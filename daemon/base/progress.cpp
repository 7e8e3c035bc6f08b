// SPDX-License-Identifier: MIT
#include "daemon/base/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <fmt/core.h>

#include "drivers/files/caught.h"
#include "drivers/files/input_file.h"

namespace framewatch::daemon {
namespace {

constexpr std::chrono::milliseconds kFirst{2000}, kBetween{500};

}  // namespace

std::string time_left_text(double seconds) {
  const auto s = static_cast<std::int64_t>(std::ceil(std::clamp(seconds, 0.0, 1e9)));
  if (s < 100) return fmt::format("{} s left", s);
  const std::int64_t minutes = (s + 59) / 60;
  if (minutes < 100) return fmt::format("{} min left", minutes);
  return fmt::format("{} h {} min left", minutes / 60, minutes % 60);
}

ProgressLine::ProgressLine(std::string command, bool quiet) : command_(std::move(command)) {
  if (quiet || ::isatty(STDERR_FILENO) != 1) return;
  // Without a thread, the work continues without a progress line.
  (void)drivers::caught([&] {
    drawing_ = std::jthread(
        [this](const std::stop_token& stop) { (void)drivers::caught([&] { draw(stop); }); });
  });
}

ProgressLine::~ProgressLine() {
  if (!is_on()) return;
  drawing_.request_stop();
  drawing_.join();
  if (shown_) (void)std::fputs("\r\033[K", stderr);
}

void ProgressLine::operator()(const std::string& what, double share) {
  if (!is_on()) return;
  const std::lock_guard lock(mutex_);
  what_ = what;
  share_ = std::min(share, 1.0);
  followed_ = nullptr;
}

void ProgressLine::follow(const std::string& what, std::function<double()> share) {
  if (!is_on()) return;
  const std::lock_guard lock(mutex_);
  what_ = what;
  share_ = 0;
  followed_ = std::move(share);
  start_ = Clock::now();
}

void ProgressLine::follow_reading(const std::string& what, const std::vector<std::string>& paths,
                                  int times) {
  std::int64_t bytes = 0;
  bool known = true;
  for (const std::string& path : paths) {
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    known = known && !error && !path.ends_with(".zst");
    if (!error) bytes += static_cast<std::int64_t>(size);
  }
  const double all = known ? static_cast<double>(times * bytes) : 0;
  follow(what, [all, before = drivers::bytes_read()] {
    return all > 0 ? static_cast<double>(drivers::bytes_read() - before) / all : 0;
  });
}

void ProgressLine::part_begins() {
  const std::lock_guard lock(mutex_);
  start_ = Clock::now();
}

double ProgressLine::elapsed_s() const {
  const std::lock_guard lock(mutex_);
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

std::string ProgressLine::text() const {
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - start_).count();
  if (!(share_ > 0)) return fmt::format("{}: {}, {:.0f} s so far", command_, what_, elapsed_s);
  return fmt::format("{}: {:.0f} %, {}, {}", command_, 100 * share_,
                     time_left_text(elapsed_s * (1 / share_ - 1)), what_);
}

void ProgressLine::draw(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  const auto stopped = [&] { return stop.stop_requested(); };
  for (auto pause = kFirst; !wake_.wait_for(lock, stop, pause, stopped); pause = kBetween) {
    if (what_.empty()) continue;
    if (followed_) share_ = std::min(followed_(), 1.0);
    const std::string line = "\r\033[K" + text();
    shown_ = true;
    (void)std::fputs(line.c_str(), stderr);
    (void)std::fflush(stderr);
  }
}

void Progress::show(std::int64_t done) {
  if (done <= 0 || total_ <= 0) return;
  line_(fmt::format("{:.3g} {}/s", static_cast<double>(done) / scale_ / line_.elapsed_s(),
                    rate_unit_),
        static_cast<double>(done) / static_cast<double>(total_));
}

}  // namespace framewatch::daemon
