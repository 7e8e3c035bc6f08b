// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/record_file_arguments.h"
#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/tools/replay/counts_intake.h"
#include "drivers/formats/record_file.h"
#include "drivers/lcm/accel_intake.h"
#include "drivers/lcm/lcm_log.h"

namespace framewatch::daemon {

/// One file to replay: an LCM event log, a log of CAN frames, or a record held in memory.
struct ReplayInput {
  std::string path;
  bool is_record = false;
  drivers::Record record;
  std::vector<int> axis_of_column;   ///< of the record; -1: no axis is named like the column
  std::optional<int> zone_min = {};  ///< of a log's dates: local time minus UTC
};

/// Part of the input to replay, in seconds after zero_us. The rest is ignored.
struct ReplaySpan {
  double from_s = 0;
  double to_s = std::numeric_limits<double>::infinity();
  std::optional<std::int64_t> zero_us = {};  ///< sensor time; empty: that of the first sample
  bool whole() const { return from_s <= 0 && to_s == std::numeric_limits<double>::infinity(); }
};

/// Returns the bytes of the record's numbers in memory.
std::int64_t bytes_of(const drivers::Record& record);

/// Checks every input for damage and against the configuration. It can pass the samples to an
/// Estimation while it reads, so that each file is read once; the caller discards the estimates
/// when the survey ends with problems.
///
/// Call declare(), then feed() and the callbacks as needed, add() for each file in order of time,
/// and finish().
class ReplaySurvey {
 public:
  /// salvage: damaged, undecodable and infinite input is noted and skipped instead of refused.
  ReplaySurvey(const Config& config, bool salvage, ReplaySpan span = {});

  /// Sets the options that record files do not state themselves. When they are invalid, add() reads
  /// nothing.
  void declare(const RecordFileArguments& arguments);

  /// Passes every sample to `estimation` from now on. It must outlive the calls of add().
  void feed(Estimation& estimation) { estimation_ = &estimation; }
  /// Skips channel tables before --from: a restored estimation has them already.
  void goes_on() { goes_on_ = true; }
  /// Called at each event of a log or instant of a record before it is passed on, with the bytes
  /// read so far of all files and the time of the event or instant, microseconds.
  using Step = std::function<void(std::int64_t bytes, std::int64_t time_us)>;
  void at_each(Step step) { step_ = std::move(step); }

  /// Stops reading once `ended` returns true. It is called before every event or instant.
  void end_when(std::function<bool()> ended) { ended_ = std::move(ended); }

  /// Reads a file.
  void add(const std::string& path);
  /// Takes a record from memory. `name` stands for it in messages.
  void add(const std::string& name, drivers::Record record);
  /// Checks the input as a whole.
  void finish();

  /// Problems that forbid the replay, each "place: rule".
  const std::vector<std::string>& problems() const { return problems_; }
  /// Damage and other notes for the user.
  const std::vector<std::string>& notes() const { return notes_; }
  std::vector<ReplayInput>& inputs() { return inputs_; }
  std::int64_t bytes() const { return bytes_; }
  std::int64_t damaged_bytes() const { return damaged_bytes_; }
  /// Returns true if --salvage would skip everything that is wrong.
  bool salvageable() const { return faults_ > 0 && faults_ == problems_.size(); }
  bool any_sample() const { return any_; }  ///< within the span; if false, the next two are unset
  double measured_seconds() const { return static_cast<double>(last_us_ - first_us_) * 1e-6; }
  /// Sensor time of the first sample that was used, microseconds.
  std::int64_t first_us() const { return first_us_; }

 private:
  struct Stamp {
    std::int64_t sequence, time_us;
  };
  struct LogSeen {
    std::map<std::string, std::int64_t> channels;                  ///< events by channel
    std::pair<const std::string, std::int64_t>* newest = nullptr;  ///< of the last event
    std::int64_t events = 0, samples = 0, first_malformed_offset = -1, backwards_offset = -1;
    std::int64_t infinite_offset = -1, elsewhere_offset = -1, renamed_offset = -1;
    std::int64_t malformed_counts = 0;  ///< messages of a raw log
    bool left_out = false;              ///< a sample lies outside the span
    bool is_raw = false;                ///< a raw log of a history
    std::string malformed;              ///< why the first malformed message is
  };

  void add_record(ReplayInput input, std::int64_t bytes);
  void give_record(const ReplayInput& input, std::int64_t bytes);
  bool outside(std::int64_t time_us);
  bool left_out(const drivers::LogEvent& event);
  const drivers::AccelIntake& intake() const {
    return estimation_ != nullptr ? estimation_->intake() : intake_;
  }
  void add_log(const std::string& path);
  void add_can_log(const std::string& path);
  void take_event(const drivers::LogEvent& event, LogSeen& seen);
  void take_counts(const drivers::LogEvent& event, LogSeen& seen);
  void judge_raw_log(const std::string& path, const LogSeen& seen);
  void judge_log(const std::string& path, const LogSeen& seen, std::int64_t malformed);
  void check_rate(const std::string& place, double rate_hz);
  /// Returns false and adds a problem when the file is not after the file before it.
  bool extend(const std::string& path, std::int64_t first_us, std::int64_t last_us);
  /// Adds a problem that --salvage turns into a note.
  void add_fault(std::string message);

  const Config& config_;
  bool salvage_;
  drivers::RecordOptions record_options_;
  bool declared_ = false, misdeclared_ = false;
  bool any_dated_ = false;  ///< a log of CAN frames has local dates, to which --zone applies
  ReplaySpan span_;
  bool spanned_;
  bool goes_on_ = false;
  /// Place of the newest sample relative to the span. Messages without a time share it.
  enum class Place { before, inside, after } place_;
  std::int64_t span_zero_us_ = std::numeric_limits<std::int64_t>::min();
  drivers::AccelIntake intake_;  ///< used without an estimation to feed
  CountsIntake counts_;
  bool any_raw_ = false;
  std::string ignored_;  ///< channels of the last raw log that no axis is named after
  Estimation* estimation_ = nullptr;
  Step step_;
  std::function<bool()> ended_ = [] { return false; };
  std::string last_path_;
  std::vector<ReplayInput> inputs_;
  std::vector<std::string> problems_, notes_;
  struct NodeStamps {
    std::pair<std::string, std::int32_t> place;  ///< channel and node
    std::vector<Stamp> stamps;
  };
  std::vector<NodeStamps> stamps_;  ///< of one log, by AccelIntake::last_node()
  std::int64_t bytes_ = 0, damaged_bytes_ = 0;
  std::int64_t first_us_ = 0, last_us_ = 0;  ///< of all samples
  std::int64_t log_first_us_ = 0, log_last_us_ = 0;
  bool any_ = false;
  std::size_t faults_ = 0;
};

}  // namespace framewatch::daemon
