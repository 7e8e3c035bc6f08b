#include "daemon/monitor/history/raw_log_care.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <framewatch/accel_counts_t.hpp>

#include <fmt/core.h>

#include "daemon/base/log.h"
#include "daemon/monitor/history/history_files.h"
#include "drivers/files/durable_file.h"
#include "drivers/files/packed_file.h"
#include "drivers/files/partial_file.h"
#include "drivers/lcm/count_block.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;

/// Byte after the last intact event of a log; 0: there is none, -1: it cannot be read.
std::int64_t end_of_events(const std::string& path) {
  drivers::LcmLogReader reader;
  drivers::LogEvent event;
  std::int64_t end = 0;
  auto read = reader.open(path) ? reader.next(event) : drivers::LogRead::error;
  for (; read != drivers::LogRead::end && read != drivers::LogRead::error;
       read = reader.next(event))
    if (read == drivers::LogRead::event) end = reader.position();
  return read == drivers::LogRead::end ? end : -1;
}

bool cut(const std::string& path, std::int64_t bytes) {
  const int file = drivers::open_own_file(path, O_WRONLY);
  if (file < 0) return false;
  const bool done = ::ftruncate(file, bytes) == 0 && ::fsync(file) == 0;
  ::close(file);
  return done;
}

void repair(const std::string& partial) {
  const std::string path = partial.substr(0, partial.size() - std::strlen(".partial"));
  std::error_code failure;
  const auto size = static_cast<std::int64_t>(fs::file_size(partial, failure));
  if (failure) return;
  if (size == 0) {
    fs::remove(partial, failure);
    return;
  }
  const std::int64_t end = end_of_events(partial);
  if (end < 0) return;
  if (end == 0) {
    fs::rename(partial, path + ".damaged", failure);
    log(LogLevel::warning, fmt::format("history: {} holds no whole event", path + ".damaged"));
    return;
  }
  if ((end < size && !cut(partial, end)) || std::rename(partial.c_str(), path.c_str()) != 0) {
    log(LogLevel::error, fmt::format("history: {}: {}", partial, std::strerror(errno)));
    return;
  }
  log(LogLevel::notice,
      fmt::format("history: {} was not closed; {} bytes of an event cut off", path, size - end));
}

bool within(const accel_counts_t& block, const std::vector<TimeSpan>& spans) {
  if (block.offset_us.empty()) return false;
  const auto [first, last] = std::minmax_element(block.offset_us.begin(), block.offset_us.end());
  const std::int64_t from_us = block.time_us + *first, to_us = block.time_us + *last;
  return std::any_of(spans.begin(), spans.end(), [&](const TimeSpan& span) {
    return span.from_us <= to_us && from_us <= span.to_us;
  });
}

}  // namespace

void repair_raw_logs(const std::string& folder) {
  for (const RawLog& raw : raw_logs(folder))
    if (raw.partial &&
        !drivers::DurableFile::in_use(raw.path.substr(0, raw.path.rfind(".partial"))))
      repair(raw.path);
}

void remove_unfinished_compressions(const std::string& folder) {
  std::error_code none;
  std::vector<fs::path> found;
  for (fs::directory_iterator at(folder, none), end; !none && at != end; at.increment(none))
    if (at->path().string().ends_with(".lcmlog.zst.partial")) found.push_back(at->path());
  for (const fs::path& path : found) fs::remove(path, none);
}

void compress_raw_log(const std::string& path, const std::atomic<bool>& stop) {
  const std::string problem = drivers::pack_zstd(path, path + ".zst", stop);
  std::error_code none;
  if (problem.empty())
    fs::remove(path, none);
  else if (!stop)
    log(LogLevel::warning, "history: not compressed: " + problem);
}

std::string excerpt_raw_log(const std::string& path, const std::vector<TimeSpan>& spans,
                            const std::string& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  std::string name = fs::path(path).filename().string();
  if (name.ends_with(".zst")) name.resize(name.size() - std::strlen(".zst"));
  drivers::LcmLogReader reader;
  drivers::LcmLogWriter out;
  drivers::LogEvent event, table;
  bool opened = false;
  auto read = reader.open(path) ? reader.next(event) : drivers::LogRead::error;
  for (; read != drivers::LogRead::end && read != drivers::LogRead::error;
       read = reader.next(event)) {
    if (read != drivers::LogRead::event) continue;
    if (event.channel == drivers::kCountsTableChannel) table = event;
    if (event.channel != drivers::kCountsChannel) continue;
    const auto block = drivers::decoded<accel_counts_t>(event.data);
    if (!block || !within(*block, spans)) continue;
    if (!opened && (!out.open((fs::path(folder) / name).string()) || !out.copy(table)))
      return out.error();
    opened = true;
    if (!out.copy(event)) return out.error();
  }
  if (read == drivers::LogRead::error) return reader.error();
  return !opened || out.close() ? "" : out.error();
}

}  // namespace framewatch::daemon
