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

/// One file to replay: an LCM event log, a candump log, or a record held in memory.
struct ReplayInput {
  std::string path;
  bool is_record = false;
  drivers::Record record;
  std::vector<int> axis_of_column;  ///< of the record; -1: a column no axis is named after
};

/// Part of the input, seconds after its first sample, or after a sensor time; the rest is ignored.
struct ReplaySpan {
  double from_s = 0;
  double to_s = std::numeric_limits<double>::infinity();
  std::optional<std::int64_t> zero_us = {};  ///< of both; empty: the first sample's
  bool whole() const { return from_s <= 0 && to_s == std::numeric_limits<double>::infinity(); }
};

/// Looks at every input: what it holds, what is damaged, and whether it can be what the
/// configuration describes. On its way it may give what it reads to an Estimation, so that nothing
/// is read twice; whoever does so throws the estimates away when there are problems in the end.
class ReplaySurvey {
 public:
  /// salvage: damaged, undecodable and infinite input is noted and left out instead of refused.
  ReplaySurvey(const Config& config, bool salvage, ReplaySpan span = {});

  /// What record files do not say themselves. Nothing is read when it cannot be understood.
  void declare(const RecordFileArguments& arguments);

  /// From now on every sample is passed to `estimation` too, which must outlive the calls of add().
  void feed(Estimation& estimation) { estimation_ = &estimation; }
  /// The estimation has seen what was before --from: tables there are not given again.
  void goes_on() { goes_on_ = true; }
  /// What to do at each event or instant of a record, before it is given on: bytes read so far of
  /// all files, and the time of the event or instant, microseconds.
  using Step = std::function<void(std::int64_t bytes, std::int64_t time_us)>;
  void at_each(Step step) { step_ = std::move(step); }

  /// The rest of the input is not read once this is true; it is asked before every event or
  /// instant.
  void end_when(std::function<bool()> ended) { ended_ = std::move(ended); }

  void add(const std::string& path);
  /// To be called after the last add(): problems of the whole.
  void finish();

  /// Problems because of which the replay must not start, each "place: rule".
  const std::vector<std::string>& problems() const { return problems_; }
  /// Damage and other notes for the user.
  const std::vector<std::string>& notes() const { return notes_; }
  std::vector<ReplayInput>& inputs() { return inputs_; }
  std::int64_t bytes() const { return bytes_; }
  std::int64_t damaged_bytes() const { return damaged_bytes_; }
  /// Whether --salvage would leave out all that is wrong.
  bool salvageable() const { return faults_ > 0 && faults_ == problems_.size(); }
  bool any_sample() const { return any_; }  ///< within the span; else the next two say nothing
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
    bool left_out = false;              ///< something lies outside the span
    bool is_raw = false;                ///< a raw log of a history
    std::string malformed;              ///< why the first such message is
  };

  void add_record(ReplayInput input);
  void give_record(const ReplayInput& input);
  bool outside(std::int64_t time_us);
  bool left_out(const drivers::LogEvent& event);
  const drivers::AccelIntake& intake() const {
    return estimation_ != nullptr ? estimation_->intake() : intake_;
  }
  void add_log(const std::string& path);
  void add_candump(const std::string& path);
  void look_at(const drivers::LogEvent& event, LogSeen& seen);
  void look_at_counts(const drivers::LogEvent& event, LogSeen& seen);
  void judge_raw_log(const std::string& path, const LogSeen& seen);
  void judge_log(const std::string& path, const LogSeen& seen, std::int64_t malformed);
  void check_rate(const std::string& place, double rate_hz);
  /// False, with the problem, when it is not after the file before it.
  bool extend(const std::string& path, std::int64_t first_us, std::int64_t last_us);

  void fault(std::string message);

  const Config& config_;
  bool salvage_;
  drivers::RecordOptions record_options_;
  bool declared_ = false, misdeclared_ = false;
  ReplaySpan span_;
  bool spanned_;
  bool goes_on_ = false;
  /// Where the newest sample stood: what has no time of its own is with it.
  enum class Place { before, inside, after } place_;
  std::int64_t span_zero_us_ = std::numeric_limits<std::int64_t>::min();
  drivers::AccelIntake intake_;  ///< while nobody is fed
  CountsIntake counts_;
  bool any_raw_ = false;
  std::string ignored_;  ///< channels of the last raw log that no axis is named as
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
