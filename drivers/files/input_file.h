// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace framewatch::drivers {

/// Returns the bytes that this process has read from its input files so far. Compressed files count
/// with their size on disk. For progress displays; any thread may call it.
std::int64_t bytes_read();
/// Adds to bytes_read(). Readers of input files call it; any thread may.
void count_bytes_read(std::int64_t bytes);

/// Returns why `path` cannot be read as a file: the system's message, or "is a FIFO, not a file".
/// Returns an empty string for a regular file or a symbolic link to one. Does not open the file:
/// opening alone can block, or start a watchdog.
std::string why_no_file(const std::string& path);

/// Returns true if nothing has this name. Returns false also when the system cannot tell (a loop of
/// links).
bool is_absent(const std::string& path);

/// Holds a regular file open for reading. Every reader opens its input through this class, which
/// refuses directories, FIFOs, sockets and devices without opening them.
class InputFile {
 public:
  InputFile() = default;
  explicit InputFile(const std::string& path) { (void)open(path); }
  ~InputFile() { close(); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Opens a file. Returns false and sets error() when it cannot be opened or is not a regular
  /// file.
  [[nodiscard]] bool open(const std::string& path);
  /// Reads from `descriptor` from now on and owns it. `size` becomes size(), in bytes.
  void adopt(int descriptor, std::int64_t size);
  /// Returns the descriptor, which the caller then owns; -1 when no file is open.
  int release();
  void close();
  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  /// Returns the size in bytes at the time of opening.
  std::int64_t size() const { return size_; }
  const std::string& error() const { return error_; }

  /// Reads up to `bytes` bytes at `offset` into `to` and returns how many it read: fewer only at
  /// the end of the file. Returns -1 and sets error() when the system refuses.
  std::int64_t read(void* to, std::int64_t bytes, std::int64_t offset);

 private:
  int descriptor_ = -1;
  std::int64_t size_ = 0;
  std::string error_;
};

/// Gives access to parts of a file through a buffer. Cheap while offsets ascend; a reader of two
/// places uses two windows.
class FileWindow {
 public:
  explicit FileWindow(InputFile& file) : file_(file) {}
  void clear() { begin_ = held_ = bytes_read_ = 0; }
  /// Returns `bytes` bytes at `offset`, valid until the next call. Returns null and sets `error`
  /// when the system refuses or the file has shrunk. Precondition: they lie within file.size().
  const std::uint8_t* at(std::int64_t offset, std::int64_t bytes, std::string& error);
  /// Returns true if these bytes are in the buffer.
  bool holds(std::int64_t offset, std::int64_t bytes) const {
    return offset >= begin_ && offset + bytes <= begin_ + held_;
  }
  /// Returns the bytes read from the file so far.
  std::int64_t bytes_read() const { return bytes_read_; }

 private:
  InputFile& file_;
  std::vector<std::uint8_t> buffer_;
  std::int64_t begin_ = 0, held_ = 0, bytes_read_ = 0;
};

/// Returns the contents of a file of at most `most_bytes` bytes. Returns nullopt and sets `error`
/// when the file is larger or cannot be read.
std::optional<std::string> read_whole_file(const std::string& path, std::int64_t most_bytes,
                                           std::string& error);

/// Returns the bytes that a compressed file of `packed_bytes` may unpack to: the larger of 64 MiB
/// and 4,000 times its size, at most 4 GiB, unless set_unpack_limit() set another limit.
std::int64_t unpack_limit(std::int64_t packed_bytes);

/// Sets unpack_limit() for the whole process, whatever the size of the file (--max-size).
void set_unpack_limit(std::int64_t bytes);

/// Returns the message for a file beyond the limit: "unpacks to more than 64 MiB, from 250 KiB;
/// ...".
std::string over_unpack_limit(std::int64_t packed_bytes);

/// Returns a size for messages, such as "16 MiB".
std::string size_text(std::int64_t bytes);

}  // namespace framewatch::drivers
