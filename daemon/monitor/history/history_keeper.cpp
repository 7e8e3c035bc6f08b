#include "daemon/monitor/history/history_keeper.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/base/process.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_retention.h"
#include "daemon/monitor/history/raw_log_care.h"
#include "drivers/files/caught.h"

namespace framewatch::daemon {
namespace {

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

HistoryKeeper::HistoryKeeper(HistorySettings settings)
    : settings_(std::move(settings)), thread_([this] { work(); }) {}

HistoryKeeper::~HistoryKeeper() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
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
  // Not by nice: the sandbox of a service does not allow it.
  const sched_param idle{};
  ::pthread_setschedparam(::pthread_self(), SCHED_IDLE, &idle);
  while (!stop_) {
    guarded([this] {
      close_retired();
      look();
    });
    std::unique_lock<std::mutex> lock(mutex_);
    wake_.wait_for(lock, kBetweenLooks, [this] { return stop_.load() || !retired_.empty(); });
  }
}

/// What is thrown, for want of memory, is said; the next look begins anew.
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

void HistoryKeeper::look() {
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
  // A clock of the sensors that goes wrong makes nothing old.
  if (newest_us != INT64_MIN) remove_old_raw_logs(settings_, std::min(newest_us, host_clock_us()));
  const Room room = room_in(settings_.directory);
  const std::lock_guard<std::mutex> lock(mutex_);
  room_ = room;
}

}  // namespace framewatch::daemon
