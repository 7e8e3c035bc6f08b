#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

namespace framewatch::drivers {

inline constexpr std::array<std::uint8_t, 4> kZstdMagic{0x28, 0xB5, 0x2F, 0xFD};

inline constexpr int kUnpackMemoryLog2 = 27;  ///< 128 MiB, as `zstd` itself without --memory

/// What a zstd file held, in a temporary file that has no name and goes with its descriptor.
struct UnpackedFile {
  int file = -1;  ///< to be closed by whoever asked; -1: see error
  std::int64_t bytes = 0;
  std::string damage;  ///< why not all of it is there; what came before the damage is
  std::string error;   ///< the operating system refused something, or it holds too much
};

/// Unpacks `file` from its start, in bounded memory, into the folder for temporary files (TMPDIR).
/// What holds more than unpack_limit(), or can only be unpacked in more memory than that, is
/// an error.
UnpackedFile unpack_zstd(int file);

/// Writes what `from` holds into `to`, a PartialFile. Empty, or why not; then nothing of `to`
/// stays. It gives up soon after `stop` has become true.
std::string pack_zstd(const std::string& from, const std::string& to,
                      const std::atomic<bool>& stop);

}  // namespace framewatch::drivers
