// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

struct gzFile_s;

namespace framewatch::drivers {

/// Reads the bytes of a file, plain or gzip, from its beginning to its end.
class GzipInput {
 public:
  GzipInput() = default;
  explicit GzipInput(const std::string& path) { (void)open(path); }
  ~GzipInput();
  GzipInput(const GzipInput&) = delete;
  GzipInput& operator=(const GzipInput&) = delete;

  /// Opens a file; call at most once. Returns false and sets error() when it cannot be opened.
  [[nodiscard]] bool open(const std::string& path);
  bool is_open() const { return file_ != nullptr; }
  /// Reads the next `bytes` bytes into `to` and returns how many it read: fewer only at the end.
  /// Returns -1 and sets error() when the file is damaged, cannot be read, or unpacks to more than
  /// unpack_limit().
  [[nodiscard]] std::int64_t read(void* to, std::int64_t bytes);
  const std::string& error() const { return error_; }

 private:
  gzFile_s* file_ = nullptr;
  std::int64_t packed_bytes_ = 0, unpacked_bytes_ = 0;
  std::string error_;
};

/// The first bytes of every zstd file.
inline constexpr std::array<std::uint8_t, 4> kZstdMagic{0x28, 0xB5, 0x2F, 0xFD};

inline constexpr int kUnpackMemoryLog2 = 27;  ///< 128 MiB, like `zstd` without --memory

/// The contents of a zstd file, in a temporary file without a name.
struct UnpackedFile {
  int file = -1;  ///< descriptor, owned by the caller; -1: see error
  std::int64_t bytes = 0;
  std::string damage;  ///< why the contents are incomplete; what precedes the damage is there
  std::string error;   ///< the system refused something, or the contents are too large
};

/// Unpacks the zstd file behind the descriptor `file` from its start, in bounded memory, into the
/// folder for temporary files (TMPDIR). Sets `error` in the result when the contents exceed
/// unpack_limit() or need more memory than kUnpackMemoryLog2.
UnpackedFile unpack_zstd(int file);

/// Compresses the file `from` into `to`, a PartialFile. Returns an empty string, or what went
/// wrong; `to` is then not created. Gives up soon after `stop` becomes true.
std::string pack_zstd(const std::string& from, const std::string& to,
                      const std::atomic<bool>& stop);

}  // namespace framewatch::drivers
