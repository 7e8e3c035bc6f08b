// SPDX-License-Identifier: MIT
// An LCM event log, plain or compressed, for every reader of logs.
#include <cstdint>

#include "daemon/monitor/estimates/session_estimates.h"
#include "daemon/monitor/history/raw_history_reader.h"
#include "daemon/tools/replay/repair_command.h"
#include "drivers/lcm/accel_log.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/fuzz/message_sequence.h"
#include "tests/fuzz/shaken.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

using drivers::LogRead;

/// Runs the code of `framewatch repair`: every byte must belong to an event or to a damage.
void survey(const std::string& path) {
  drivers::LcmLogReader reader;
  if (!reader.open(path)) return;
  daemon::LogSurvey survey;
  drivers::LogEvent event;
  std::int64_t end = 0;
  for (LogRead read; (read = reader.next(event)) != LogRead::end && read != LogRead::error;) {
    const std::int64_t offset = read == LogRead::event ? event.offset : reader.damage().offset;
    require(offset >= end && offset <= reader.size(), "one after the other");
    require(reader.position() <= reader.size(), "nothing beyond the end");
    end = offset;
    if (read == LogRead::event)
      survey.intact(event);
    else
      survey.damaged(reader.damage(), read == LogRead::truncated);
  }
  require(survey.damaged_bytes() <= reader.size(), "no byte is damaged twice");
}

void read_log(Bytes input) {
  const InputFile file(input);
  survey(file.path());
  if (!drivers::is_event_log(file.path())) return;
  std::vector<drivers::Problem> problems;
  if (const auto contents = drivers::log_contents(file.path(), problems))
    for (const std::string& channel : contents->accel)
      (void)drivers::read_accel_log(file.path(), channel, problems);
  (void)daemon::read_session_estimates(file.path(), problems);
  std::vector<std::string> notes;
  std::string problem;
  (void)daemon::read_raw_history({{file.path()}}, INT64_MIN / 2, INT64_MAX / 2,
                                 {[](const auto&, double) {}, [](const auto&) {}}, notes, problem);
}

std::vector<std::string> log_seeds() {
  std::string each, shaken;
  std::int64_t number = 0;
  const auto append = [&](std::string& log, const std::string& channel, const auto& payload) {
    drivers::append_log_event(log, number, 1'000'000 + number, channel, payload.data(),
                              payload.size());
    ++number;
  };
  for (const auto& [channel, payload] : example_messages()) append(each, channel, payload);
  ShakenNodes nodes;
  nodes.shake(4, [&](const auto& bytes) { append(shaken, "ACCEL", bytes); });
  return {each, shaken, each.substr(0, each.size() - 7), std::string(40, '\0') + shaken};
}

}  // namespace

const FuzzTarget kLogTarget{"log", &read_log, &log_seeds};

}  // namespace framewatch::test
