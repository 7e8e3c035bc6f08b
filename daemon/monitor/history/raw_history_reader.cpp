// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/raw_history_reader.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <framewatch/accel_counts_t.hpp>

#include <fmt/core.h>

#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxNotes = 100;
constexpr std::int64_t kMargin_us = 600'000'000;      // for clocks that step
constexpr std::int64_t kLongest_us = 86'400'000'000;  // a raw log ends after a day at the latest

std::string stem(const RawLog& log) {
  const std::string name = std::filesystem::path(log.path).filename().string();
  return name.substr(0, name.find('.'));
}

/// Opens a log under its present name: it may have been closed and compressed since it was listed.
bool open_log(drivers::LcmLogReader& reader, const RawLog& log) {
  const std::string closed = closed_path(log);
  for (const std::string& path : {log.path, closed, closed + ".zst"}) {
    if (reader.open(path)) return true;
    if (std::error_code none; std::filesystem::exists(path, none)) return false;
  }
  return false;
}

}  // namespace

std::vector<RawLog> raw_logs_between(const std::string& directory, std::int64_t from_us,
                                     std::int64_t to_us) {
  const std::vector<RawLog> raw = raw_logs(raw_folder(directory));
  std::vector<RawLog> out;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const bool over = i + 1 < raw.size() && raw[i + 1].start_us < from_us - kMargin_us;
    if (!over && raw[i].start_us < to_us + kMargin_us) out.push_back(raw[i]);
  }
  for (const RawLog& event : raw_logs(event_folder(directory))) {
    const bool there = std::ranges::find(raw, stem(event), stem) != raw.end();
    if (!there && event.start_us < to_us + kMargin_us &&
        event.start_us > from_us - kLongest_us - kMargin_us)
      out.push_back(event);
  }
  std::ranges::stable_sort(out, {}, &RawLog::start_us);
  return out;
}

std::vector<int> axes_of(const std::vector<std::string>& channels,
                         const std::vector<estimator::SensorAxis>& axes) {
  std::vector<int> out(channels.size(), -1);
  for (std::size_t i = 0; i < channels.size(); ++i)
    for (std::size_t a = 0; a < axes.size(); ++a)
      if (axes[a].name == channels[i]) out[i] = static_cast<int>(a);
  return out;
}

bool read_raw_history(const std::vector<RawLog>& logs, std::int64_t from_us, std::int64_t to_us,
                      const RawVisitor& visitor, std::vector<std::string>& notes,
                      std::string& problem) {
  std::vector<std::string> names;
  for (const RawLog& log : logs) {
    drivers::LcmLogReader reader;
    drivers::LogEvent event;
    auto read = open_log(reader, log) ? reader.next(event) : drivers::LogRead::error;
    for (; read != drivers::LogRead::end && read != drivers::LogRead::error;
         read = reader.next(event)) {
      if (read != drivers::LogRead::event) {
        if (!log.partial && notes.size() <= kMaxNotes)
          notes.push_back(notes.size() == kMaxNotes
                              ? "further damage is not listed"
                              : fmt::format("{}: {} bytes from byte {} on are damaged: {}",
                                            log.path, reader.damage().bytes, reader.damage().offset,
                                            reader.damage().reason));
        continue;
      }
      if (event.channel == drivers::kCountsTableChannel) {
        const auto table = drivers::decode_channel_table(event.data.data(), event.data.size());
        if (!table) continue;
        std::vector<std::string> now;
        for (const auto& entry : table->entries) now.push_back(entry.name);
        if (now != names) visitor.channels(names = std::move(now), table->rate_hz);
        continue;
      }
      if (event.channel != drivers::kCountsChannel) {
        if (visitor.message && event.timestamp_us >= from_us && event.timestamp_us < to_us)
          visitor.message(event);
        continue;
      }
      const auto block = drivers::decoded<accel_counts_t>(event.data);
      if (!block) continue;
      for (std::size_t i = 0; i < block->count.size(); ++i) {
        const std::int64_t time_us = block->time_us + block->offset_us[i];
        const auto channel = static_cast<std::size_t>(block->channel[i]);
        if (time_us >= from_us && time_us < to_us && channel < names.size())
          visitor.sample({time_us, channel, block->count[i], block->resolution_mps2});
      }
    }
    if (read == drivers::LogRead::error) {
      problem = fmt::format("{}: {}", log.path, reader.error());
      return false;
    }
  }
  return true;
}

}  // namespace framewatch::daemon
