// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/can/can_frame.h"
#include "drivers/can/lower_envelope_clock.h"
#include "drivers/files/descriptor.h"

namespace framewatch::drivers {

/// Lets frames through whose id agrees with `id` in the bits of `mask`.
struct CanFilter {
  std::uint32_t id = 0, mask = 0;
  bool extended = false;
};

/// Reads and writes a raw CAN socket, or any descriptor of sequenced packets with struct can_frame
/// and struct canfd_frame. Non-blocking; owns the descriptor.
class CanSocket {
 public:
  enum class Read { frames, idle, down, failed };

  CanSocket() = default;
  explicit CanSocket(int descriptor) : fd_(descriptor) {}

  /// Opens an interface. `own_frames` also receives the frames sent here. Returns false and sets
  /// `error` when there is no such interface, or no CAN in this kernel. An interface that is down
  /// can be opened; read() then returns `down` once.
  [[nodiscard]] bool open(const std::string& interface, int receive_buffer_bytes,
                          const std::vector<CanFilter>& filters, bool own_frames,
                          std::string& error);
  bool is_open() const { return fd_.get() >= 0; }
  int descriptor() const { return fd_.get(); }
  int interface_index() const { return index_; }
  /// Returns the bytes that the kernel granted.
  int receive_buffer_bytes() const { return buffer_bytes_; }

  /// Reads the waiting frames, at most 64. Stamps come from the controller, converted to the host's
  /// clock, if it has them, else from the kernel.
  [[nodiscard]] Read read(std::vector<CanFrame>& frames);
  /// Returns the frames that the kernel dropped because they were not read in time.
  std::int64_t dropped() const { return dropped_; }
  /// Sends a frame. Returns false with errno when it cannot be sent now.
  [[nodiscard]] bool write(const CanFrame& frame) const;

 private:
  std::int64_t stamp_us(const void* message);

  Descriptor fd_;
  int index_ = 0, buffer_bytes_ = 0;
  std::uint32_t dropped_before_ = 0;
  std::int64_t dropped_ = 0;
  LowerEnvelopeClock controller_{};  ///< clock of the controller's stamps
};

/// Returns the index of a network interface, or 0 when it does not exist. Sets `up`.
int find_interface(const std::string& name, bool& up);

}  // namespace framewatch::drivers
