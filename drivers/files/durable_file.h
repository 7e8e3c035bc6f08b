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

/// Appends to a file from a thread of its own, so that a slow disk delays nobody. The file is
/// PATH.partial until close(); it is given to the operating system four times a second and forced
/// onto the disk (fsync) every second, and nothing ever removes it. While the disk refuses, what
/// comes waits, and is written when it takes again; what does not fit into the queue is dropped and
/// counted.
class DurableFile {
 public:
  static constexpr std::size_t kQueueBytes = std::size_t{64} << 20;

  struct Counters {
    std::int64_t appended = 0, dropped = 0;  ///< calls of append()
    std::int64_t bytes = 0;                  ///< given to the operating system
    std::size_t queued = 0;                  ///< bytes that wait
    std::size_t queue_high_water = 0;        ///< the most there ever were
  };

  explicit DurableFile(std::size_t queue_bytes = kQueueBytes) : queue_bytes_(queue_bytes) {}
  /// As close(), but the file keeps its partial name.
  ~DurableFile();
  DurableFile(const DurableFile&) = delete;
  DurableFile& operator=(const DurableFile&) = delete;

  /// False, with the reason, when the file cannot be made or another process appends to it.
  [[nodiscard]] bool open(const std::string& path, std::string& error);
  /// The same, but the thread makes the file when there is something to write, and tries again four
  /// times a second while the disk refuses. `path` is asked for each time, in the thread, and
  /// should name a file that is not there.
  void open_when_needed(std::function<std::string()> path);
  bool is_open() const { return wanted_; }
  /// Never waits for the disk. False: dropped.
  bool append(std::string_view bytes);
  Counters counters() const;
  /// Why the disk does not take what waits; empty: it does.
  std::string trouble() const;
  /// Writes the rest, for `patience` at most while the disk refuses it, and renames. False, with
  /// the reason, when something is missing: then the file stays PATH.partial. A file that was never
  /// needed is not made.
  [[nodiscard]] bool close(std::string& error,
                           std::chrono::milliseconds patience = std::chrono::seconds(5));

  /// Whether some process has PATH.partial open().
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
  std::string writing_;  ///< of the thread: what it is at
  std::size_t written_ = 0;

  mutable std::mutex mutex_;  ///< guards what is below
  std::condition_variable wake_;
  std::string filling_;
  std::size_t waiting_ = 0;  ///< bytes of writing_ that are not yet written
  Counters counters_;
  std::string trouble_;
  bool closing_ = false;
  std::chrono::steady_clock::time_point give_up_{};
};

}  // namespace framewatch::drivers
