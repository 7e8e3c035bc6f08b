// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_keeper.h"

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <framewatch/accel_counts_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/base/process.h"
#include "daemon/base/sqlite_file.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_schema.h"
#include "drivers/files/caught.h"
#include "drivers/files/descriptor.h"
#include "drivers/files/input_file.h"
#include "drivers/files/packed_file.h"
#include "drivers/files/partial_file.h"
#include "drivers/lcm/count_block.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;

/// Returns the byte after the last intact event of a log; 0 without an intact event, -1 if the log
/// cannot be read.
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
  const drivers::Descriptor file(drivers::open_own_file(path, O_WRONLY));
  return file.get() >= 0 && ::ftruncate(file.get(), bytes) == 0 && ::fsync(file.get()) == 0;
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
    log(LogLevel::warning,
        fmt::format("history: set aside {}: it has no intact event", path + ".damaged"));
    return;
  }
  if ((end < size && !cut(partial, end)) || std::rename(partial.c_str(), path.c_str()) != 0) {
    log(LogLevel::error, fmt::format("history: {}: {}", partial, std::strerror(errno)));
    return;
  }
  log(LogLevel::notice,
      fmt::format("history: {} was not closed: cut off {} bytes of an incomplete event", path,
                  size - end));
}

bool within(const accel_counts_t& block, const std::vector<TimeSpan>& spans) {
  if (block.offset_us.empty()) return false;
  const auto [first, last] = std::minmax_element(block.offset_us.begin(), block.offset_us.end());
  const std::int64_t from_us = block.time_us + *first, to_us = block.time_us + *last;
  return std::any_of(spans.begin(), spans.end(), [&](const TimeSpan& span) {
    return span.from_us <= to_us && from_us <= span.to_us;
  });
}

constexpr double kGigabyte = 1e9;

/// Returns the times around events that concern the building, not the instruments; nullopt if they
/// cannot be read.
std::optional<std::vector<TimeSpan>> spans_of_events(const HistorySettings& settings) {
  const std::string path = summary_file(settings.directory);
  std::vector<TimeSpan> out;
  if (drivers::is_absent(path)) return out;
  SqliteFile file;
  if (!file.open_to_read(path) || !version_problem(file, history_schema()).empty())
    return std::nullopt;
  SqliteStatement events = file.prepare(
      "SELECT min(since_us, time_us), time_us FROM event"
      " WHERE state = 1 AND kind IN ('stiffness_change', 'gap')");
  while (events.row())
    out.push_back(
        {events.integer(0) - static_cast<std::int64_t>(kSecond_us * settings.event_before_s),
         events.integer(1) + static_cast<std::int64_t>(kSecond_us * settings.event_after_s)});
  if (file.failed()) return std::nullopt;
  return out;
}

constexpr std::chrono::seconds kBetweenLooks{10};

HistoryKeeper::Room room_in(const std::string& directory) {
  HistoryKeeper::Room room;
  std::error_code none;
  using Walk = std::filesystem::recursive_directory_iterator;
  for (Walk at(directory, none), end; !none && at != end; at.increment(none)) {
    std::error_code gone;
    const auto bytes = at->is_regular_file(gone) ? at->file_size(gone) : 0;
    if (!gone) room.stored_bytes += static_cast<std::int64_t>(bytes);
  }
  room.free_bytes = disk_free_bytes(directory);
  return room;
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
    log(LogLevel::warning, "history: cannot compress " + problem);
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

void remove_old_raw_logs(const HistorySettings& settings, std::int64_t now_us) {
  std::vector<RawLog> logs = raw_logs(raw_folder(settings.directory));
  std::int64_t bytes = 0;
  for (const RawLog& raw : logs) bytes += raw.bytes;
  const auto most_bytes = static_cast<std::int64_t>(kGigabyte * settings.keep_gb);
  const auto oldest_us = now_us - static_cast<std::int64_t>(kDay_us * settings.keep_days);
  std::optional<std::vector<TimeSpan>> spans;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    // A log ends where the next one starts.
    const bool old = i + 1 < logs.size() && logs[i + 1].start_us < oldest_us;
    if (logs[i].partial || (!old && bytes <= most_bytes)) continue;
    if (!spans && !(spans = spans_of_events(settings))) return;
    const std::string problem =
        excerpt_raw_log(logs[i].path, *spans, event_folder(settings.directory));
    std::error_code failure;
    if (problem.empty()) std::filesystem::remove(logs[i].path, failure);
    if (!problem.empty() || failure) {
      log(LogLevel::warning, fmt::format("history: cannot remove the old log {}: {}", logs[i].path,
                                         problem.empty() ? failure.message() : problem));
      continue;
    }
    bytes -= logs[i].bytes;
  }
}

HistoryKeeper::HistoryKeeper(HistorySettings settings)
    : settings_(std::move(settings)), thread_([this] { work(); }) {}

HistoryKeeper::~HistoryKeeper() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  // The end should not wait until the processor is idle; not every system permits this.
  const sched_param usual{};
  ::pthread_setschedparam(thread_.native_handle(), SCHED_OTHER, &usual);
  thread_.join();
  close_retired();
}

void HistoryKeeper::retire(std::unique_ptr<drivers::DurableFile> log) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    retired_.push_back(std::move(log));
  }
  wake_.notify_one();
}

void HistoryKeeper::newest(std::int64_t time_us) {
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_us_ = time_us;
}

HistoryKeeper::Room HistoryKeeper::room() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return room_;
}

void HistoryKeeper::work() {
  guarded([this] {
    repair_raw_logs(raw_folder(settings_.directory));
    remove_unfinished_compressions(raw_folder(settings_.directory));
    remove_unfinished_compressions(event_folder(settings_.directory));
  });
  // nice() is not allowed in the sandbox of a service.
  const sched_param idle{};
  ::pthread_setschedparam(::pthread_self(), SCHED_IDLE, &idle);
  while (!stop_) {
    guarded([this] {
      close_retired();
      tidy();
    });
    std::unique_lock<std::mutex> lock(mutex_);
    wake_.wait_for(lock, kBetweenLooks, [this] { return stop_.load() || !retired_.empty(); });
  }
}

/// Logs an exception, such as a lack of memory; the next round tries again.
void HistoryKeeper::guarded(const std::function<void()>& work) {
  if (const std::string thrown = drivers::caught(work); !thrown.empty())
    log(LogLevel::error, "history: " + thrown);
}

void HistoryKeeper::close_retired() {
  std::vector<std::unique_ptr<drivers::DurableFile>> logs;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    logs.swap(retired_);
  }
  for (const auto& file : logs)
    if (std::string error; !file->close(error))
      log(LogLevel::error, "history: raw samples are missing at the end of " + error);
}

void HistoryKeeper::tidy() {
  const std::string folder = raw_folder(settings_.directory);
  repair_raw_logs(folder);
  for (const std::string& where : {folder, event_folder(settings_.directory)})
    for (const RawLog& raw : raw_logs(where)) {
      if (stop_) return;
      if (settings_.compress && !raw.partial && !raw.compressed) compress_raw_log(raw.path, stop_);
    }
  std::int64_t newest_us = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_us = newest_us_;
  }
  // The host's clock bounds the age, in case the clock of the sensors runs far ahead.
  if (newest_us != INT64_MIN) remove_old_raw_logs(settings_, std::min(newest_us, host_clock_us()));
  const Room room = room_in(settings_.directory);
  const std::lock_guard<std::mutex> lock(mutex_);
  room_ = room;
}

}  // namespace framewatch::daemon
