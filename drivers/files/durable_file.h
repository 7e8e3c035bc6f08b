// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace framewatch::drivers {

/// Appends to a file from a separate thread, so that a slow disk delays no caller. The file is
/// PATH.partial until close() and is never removed. The thread writes four times a second and
/// forces the bytes onto the disk (fsync) once a second. While the disk refuses, bytes wait in a
/// queue and are written later; calls of append() that do not fit into the queue are dropped and
/// counted.
class DurableFile {
 public:
  static constexpr std::size_t kQueueBytes = std::size_t{64} << 20;

  struct Counters {
    std::int64_t appended = 0, dropped = 0;  ///< calls of append()
    std::int64_t bytes = 0;                  ///< given to the operating system
    std::size_t queued = 0;                  ///< bytes waiting
    std::size_t queue_high_water = 0;        ///< largest value of `queued` so far
  };

  explicit DurableFile(std::size_t queue_bytes = kQueueBytes) : queue_bytes_(queue_bytes) {}
  /// Writes what the disk accepts at once; the file keeps its partial name.
  ~DurableFile();
  DurableFile(const DurableFile&) = delete;
  DurableFile& operator=(const DurableFile&) = delete;

  /// Creates PATH.partial. Returns false and sets `error` when the file exists or cannot be
  /// created.
  [[nodiscard]] bool open(const std::string& path, std::string& error);
  /// Creates the file when there is something to write, and tries again four times a second while
  /// the disk refuses. The thread calls `path` before each try; it should name a new file.
  void open_when_needed(std::function<std::string()> path);
  bool is_open() const { return wanted_; }
  /// Queues bytes; never waits for the disk. Returns false when the bytes were dropped.
  bool append(std::string_view bytes);
  Counters counters() const;
  /// Returns why the queue cannot be written now; empty when it can.
  std::string trouble() const;
  /// Returns true if somebody has moved, removed or replaced the file, as seen once a second.
  bool is_lost() const;
  /// Writes the rest, trying for at most `patience` while the disk refuses, and renames the file.
  /// Returns false and sets `error` when bytes are missing: the file then stays PATH.partial.
  /// Creates no file when nothing was appended.
  [[nodiscard]] bool close(std::string& error,
                           std::chrono::milliseconds patience = std::chrono::seconds(5));

  /// Returns true if a process is writing PATH.partial.
  static bool in_use(const std::string& path);

 private:
  bool make(std::string& error);
  void start();
  void begin_thread();
  void work();
  bool write_some();
  void finish(std::chrono::milliseconds patience);

  std::size_t queue_bytes_;
  std::function<std::string()> path_when_needed_;
  std::string path_;
  int file_ = -1;
  std::thread thread_;
  bool wanted_ = false;  ///< between open() and close()
  std::string writing_;  ///< bytes that the thread is writing
  std::size_t written_ = 0;

  mutable std::mutex mutex_;  ///< guards the members below
  std::condition_variable wake_;
  std::string filling_;
  std::size_t waiting_ = 0;  ///< bytes of writing_ that are not yet written
  Counters counters_;
  std::string trouble_;
  bool lost_ = false;
  bool closing_ = false;
  std::chrono::steady_clock::time_point give_up_{};
};

}  // namespace framewatch::drivers
