// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/stored_samples.h"

#include <cmath>

#include <fmt/core.h>

#include "daemon/config/channel_addresses.h"
#include "daemon/tools/replay/counts_intake.h"
#include "drivers/can/can_intake.h"
#include "drivers/can/can_log_file.h"
#include "drivers/lcm/lcm_log.h"

namespace framewatch::daemon {
namespace {

void push_record(const ReplayInput& input, const drivers::AccelIntake::Sink& sink) {
  const drivers::Record& record = input.record;
  for (std::size_t i = 0; i < record.time_s.size(); ++i) {
    const estimator::Time time = estimator::from_microseconds(std::llround(record.time_s[i] * 1e6));
    for (std::size_t c = 0; c < input.axis_of_column.size(); ++c)
      if (input.axis_of_column[c] >= 0)
        sink({time, input.axis_of_column[c], record.accel_mps2[c][i]});
  }
}

std::string push_log(const Config& config, const std::string& path, drivers::AccelIntake& intake,
                     const drivers::AccelIntake::Sink& sink) {
  intake.log_begins();
  CountsIntake counts(axis_names(config));
  drivers::LcmLogReader reader;
  drivers::LogEvent event;
  auto read = reader.open(path) ? reader.next(event) : drivers::LogRead::error;
  for (; read != drivers::LogRead::end && read != drivers::LogRead::error;
       read = reader.next(event))
    if (read == drivers::LogRead::event && is_of_raw_log(event.channel))
      counts.message(event.channel, event.data, sink);
    else if (read == drivers::LogRead::event)
      intake.message(event.channel, event.data.data(), event.data.size(), {}, event.timestamp_us);
  return read == drivers::LogRead::end ? "" : fmt::format("{}: {}", path, reader.error());
}

/// Ignores what is malformed: the survey has reported it.
void push_can_log(const Config& config, const ReplayInput& input,
                  const drivers::AccelIntake::Sink& sink) {
  drivers::CanIntake can(config.can, sink);
  std::vector<drivers::Problem> ignored;
  std::vector<std::string> notes;
  drivers::read_can_log(
      input.path, input.zone_min,
      [&](const drivers::CanFrame& frame, std::string_view interface) {
        if (const int bus = can.bus_of(interface); bus >= 0) can.frame(bus, frame);
      },
      notes, ignored);
  can.finish();
}

}  // namespace

std::string push_stored_samples(const Config& config, const ReplayInput& input,
                                drivers::AccelIntake& intake,
                                const drivers::AccelIntake::Sink& sink) {
  if (!input.is_record && drivers::can_log_format(input.path) != drivers::CanLogFormat::none) {
    push_can_log(config, input, sink);
    return {};
  }
  if (!input.is_record) return push_log(config, input.path, intake, sink);
  push_record(input, sink);
  return {};
}

}  // namespace framewatch::daemon
