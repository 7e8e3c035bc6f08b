// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/estimates/estimate_output.h"
#include "daemon/monitor/estimates/summary_intake.h"
#include "daemon/monitor/history/summary_store.h"
#include "drivers/files/partial_file.h"

namespace framewatch::daemon {

/// Writes the messages of an estimation as the tables of a history (docs/history.md). The file
/// appears only when it is complete. The same messages give the same bytes.
class HistoryOutput : public EstimateOutput {
 public:
  /// Takes the summary periods of `config.history`, or the default ones. `config` must outlive
  /// this.
  explicit HistoryOutput(const Config& config);

  [[nodiscard]] bool open(const std::string& path);
  /// Limits what is stored to periods that start, and events that happen, from `from_us` to before
  /// `to_us`, sensor time. Both must be multiples of the longest period. Call it before the first
  /// put().
  void keep(std::int64_t from_us, std::int64_t to_us);
  [[nodiscard]] bool put(std::int64_t time_us, const std::string& channel,
                         const std::vector<std::uint8_t>& bytes) override;
  [[nodiscard]] bool close() override;
  std::string error() const override { return error_; }

  std::int64_t longest_s() const { return settings_.summary_s.back(); }  ///< the longest period

 private:
  bool store();
  bool fail(const std::string& why);

  HistorySettings settings_;
  SummaryIntake intake_;
  SummaryStore store_;
  drivers::PartialFile file_;
  std::int64_t from_us_ = std::numeric_limits<std::int64_t>::min();
  std::int64_t to_us_ = std::numeric_limits<std::int64_t>::max();
  std::string error_;
};

}  // namespace framewatch::daemon
