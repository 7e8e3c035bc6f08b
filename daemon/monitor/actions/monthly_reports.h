// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <string>

#include "daemon/config/config.h"
#include "daemon/monitor/actions/email.h"
#include "daemon/monitor/history/month_report.h"

namespace framewatch::daemon {

/// Returns the e-mail about a month, with the page attached.
Email month_email(const MonthReport& report);

/// The outcome of one attempt to make a monthly report.
struct MonthOutcome {
  std::string trouble = {};  ///< why the report is not complete; empty: it is
  bool news = false;         ///< this attempt wrote the page or sent it
};

/// Writes the page of `month` into the directory of [report] unless it is there, and sends it by
/// e-mail unless it was sent, which a file NAME.sent beside the page says. A refused address does
/// not stop the others and is only logged. Requires [report] and [history]. `now_us`: host clock.
MonthOutcome make_month_report(const Config& config, const Month& month, std::int64_t now_us,
                               EmailRound& round, const Abandoned& abandoned);

/// Writes the monthly reports of [report] from a thread: that of the month before, from an hour
/// after its end on. Repeats what fails every hour.
class MonthlyReports {
 public:
  MonthlyReports() = default;
  /// Waits until the thread has stopped.
  ~MonthlyReports();
  MonthlyReports(const MonthlyReports&) = delete;
  MonthlyReports& operator=(const MonthlyReports&) = delete;

  void configure(const Config& config);
  /// Starts what is due. Call it once a second; `now_us`: host clock.
  void update(std::int64_t now_us);
  /// Returns true if reports are configured.
  bool wanted() const { return config_ && config_->report && config_->report->monthly; }
  /// Returns the month whose report is complete, such as "2026-11".
  const std::string& finished() const { return finished_; }
  /// Returns how many reports were written or sent since the start of the program.
  std::int64_t done() const { return done_; }
  /// Returns why the newest attempt failed; empty: it did not.
  const std::string& trouble() const { return trouble_; }

 private:
  void collect(std::int64_t now_us);

  std::shared_ptr<const Config> config_;
  EmailRound round_;  ///< used by the thread
  std::string month_, finished_, trouble_;
  std::int64_t next_us_ = 0, done_ = 0;
  std::atomic<bool> stop_ = false;
  std::future<MonthOutcome> working_;
};

}  // namespace framewatch::daemon
