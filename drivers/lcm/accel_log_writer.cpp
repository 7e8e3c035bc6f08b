#include <cmath>

#include <fmt/core.h>

#include "drivers/lcm/accel_log.h"
#include "drivers/lcm/lcm_log.h"

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kTablePeriodUs = 1'000'000;

bool write_all(LcmLogWriter& log, std::int64_t time_us, const std::vector<Message>& messages) {
  for (const Message& message : messages)
    if (!log.write(time_us, message.channel, message.bytes.data(), message.bytes.size()))
      return false;
  return true;
}

}  // namespace

std::string write_accel_log(const std::string& path, const Record& record,
                            const std::vector<AxisAddress>& addresses, std::int64_t start_us,
                            const std::function<void(double)>& progress) {
  AccelMessages messages(record.names, addresses, record.rate_hz);
  LcmLogWriter log;
  if (!log.open(path)) return log.error();
  std::vector<double> values(record.names.size());
  std::int64_t next_table_us = INT64_MIN;
  for (std::size_t i = 0; i < record.time_s.size(); ++i) {
    const std::int64_t time_us = start_us + std::llround(record.time_s[i] * 1e6);
    if (time_us >= next_table_us) {
      if (!write_all(log, time_us, messages.tables(time_us))) return log.error();
      next_table_us = time_us + kTablePeriodUs;
      if (progress) progress(static_cast<double>(i) / static_cast<double>(record.time_s.size()));
    }
    for (std::size_t c = 0; c < values.size(); ++c) values[c] = record.accel_mps2[c][i];
    if (!write_all(log, time_us, messages.samples(time_us, values))) return log.error();
  }
  return log.close() ? "" : log.error();
}

}  // namespace framewatch::drivers
