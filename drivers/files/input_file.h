#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace framewatch::drivers {

/// Why `path` is no file to read: the system's word, or "is a FIFO, not a file". Empty: it is a
/// regular file, or a symbolic link to one. It is not opened: that alone can block, or start a
/// watchdog.
std::string why_no_file(const std::string& path);

/// Whether nothing has this name; false also when that cannot be said (a loop of links).
bool is_absent(const std::string& path);

/// A regular file that is open for reading, until the object goes. Every reader opens its input
/// here: directories, FIFOs, sockets and devices are refused at once, whatever they are.
class InputFile {
 public:
  InputFile() = default;
  explicit InputFile(const std::string& path) { (void)open(path); }
  ~InputFile() { close(); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// False, with error(), when it cannot be opened or is no regular file.
  [[nodiscard]] bool open(const std::string& path);
  /// Reads this descriptor from now on, and closes it; `size` is what size() will say.
  void adopt(int descriptor, std::int64_t size);
  /// Gives the descriptor away; whoever takes it closes it.
  int release();
  void close();
  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  /// Bytes, when it was opened.
  std::int64_t size() const { return size_; }
  const std::string& error() const { return error_; }

  /// Up to `bytes` bytes at `offset`; fewer only at the end of the file. -1, with error(), when the
  /// system refuses.
  std::int64_t read(void* to, std::int64_t bytes, std::int64_t offset);

 private:
  int descriptor_ = -1;
  std::int64_t size_ = 0;
  std::string error_;
};

/// The whole of a file of at most `most_bytes`; empty, with the reason, when it is larger or cannot
/// be read.
std::optional<std::string> read_whole_file(const std::string& path, std::int64_t most_bytes,
                                           std::string& error);

/// "16 MiB", for messages.
std::string size_text(std::int64_t bytes);

}  // namespace framewatch::drivers
