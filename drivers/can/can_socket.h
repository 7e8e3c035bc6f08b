#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/can/can_frame.h"
#include "drivers/can/lower_envelope_clock.h"

namespace framewatch::drivers {

/// What the kernel lets through: an id and the bits of it that must agree.
struct CanFilter {
  std::uint32_t id = 0, mask = 0;
  bool extended = false;
};

/// A raw CAN socket, or any descriptor of sequenced packets that carry struct can_frame and struct
/// canfd_frame. Non-blocking; owns the descriptor.
class CanSocket {
 public:
  enum class Read { frames, idle, down, failed };

  CanSocket() = default;
  explicit CanSocket(int descriptor) : fd_(descriptor) {}
  CanSocket(CanSocket&& other) noexcept;
  CanSocket& operator=(CanSocket&& other) noexcept;
  ~CanSocket();

  /// False with the reason when there is no such interface or no CAN here. An interface that is
  /// down can be opened: reading says `down` once.
  [[nodiscard]] bool open(const std::string& interface, int receive_buffer_bytes,
                          const std::vector<CanFilter>& filters, bool own_frames,
                          std::string& error);
  bool is_open() const { return fd_ >= 0; }
  int descriptor() const { return fd_; }
  int interface_index() const { return index_; }
  /// What the kernel granted.
  int receive_buffer_bytes() const { return buffer_bytes_; }

  /// Takes up to a batch of frames. Stamps are the controller's, brought to the host's clock, where
  /// it gives any, else the kernel's.
  [[nodiscard]] Read read(std::vector<CanFrame>& frames);
  /// Frames the kernel dropped because nobody read them in time.
  std::int64_t dropped() const { return dropped_; }
  /// False when the frame cannot be sent now; errno says why.
  [[nodiscard]] bool write(const CanFrame& frame) const;

 private:
  std::int64_t stamp_us(const void* message);

  int fd_ = -1, index_ = 0, buffer_bytes_ = 0;
  std::uint32_t dropped_before_ = 0;
  std::int64_t dropped_ = 0;
  LowerEnvelopeClock controller_{};  ///< the clock of the controller's stamps
};

/// Index of a network interface, 0 when there is none, and whether it is up.
int find_interface(const std::string& name, bool& up);

}  // namespace framewatch::drivers
