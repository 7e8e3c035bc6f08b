// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/lcm/multicast/lcm_packet.h"

namespace framewatch::drivers {

/// Assembles messages from parts, which may come in any order. A sender has one unfinished message
/// at a time; its next message discards it. Allocates memory for bytes received, never for a size
/// that a packet claims.
class FragmentAssembly {
 public:
  static constexpr std::size_t kMaxMessageBytes = std::size_t{16} << 20;
  static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;  ///< for all senders
  static constexpr std::size_t kMaxSenders = 256;

  /// The effect of a part.
  enum class Outcome { waits, whole, unwanted, refused };
  using Wanted = std::function<bool(std::string_view channel)>;

  /// Messages on channels for which `wanted` returns false are not kept.
  explicit FragmentAssembly(Wanted wanted) : wanted_(std::move(wanted)) {}

  /// Adds a packet of a message with more than one part. Sets `channel` and `payload` when the
  /// packet completes its message (`whole`). Returns `refused` for a message that is too long and
  /// for a part that contradicts those before it.
  Outcome add(const LcmSender& sender, const LcmPacket& packet, std::string& channel,
              std::vector<std::uint8_t>& payload);

  /// Returns the messages discarded unfinished: a part never came, or memory ran out.
  std::int64_t unfinished() const { return unfinished_; }
  std::size_t bytes() const { return bytes_; }  ///< memory held now
  std::size_t senders() const { return by_sender_.size(); }

 private:
  struct Part {
    std::uint32_t offset;
    std::vector<std::uint8_t> payload;
  };
  struct Unfinished {
    LcmSender sender;
    std::uint32_t sequence = 0, message_bytes = 0;
    std::uint16_t parts = 0;
    std::string channel;
    bool unwanted = false;
    std::size_t parts_came = 0;
    std::map<std::uint16_t, Part> kept;
    std::size_t payload_bytes = 0;  ///< bytes of the parts kept
  };
  using Entry = std::list<Unfinished>::iterator;

  std::size_t bytes_of(const Unfinished& message) const;
  Entry entry_of(const LcmSender& sender, const LcmPacket& packet);
  void remove(Entry entry);
  void discard(Entry entry);
  void ignore(Unfinished& message);
  bool keep(Unfinished& message, const LcmPacket& packet);
  Outcome finish(Entry entry, std::string& channel, std::vector<std::uint8_t>& payload);
  bool join(const Unfinished& message, std::vector<std::uint8_t>& payload) const;

  Wanted wanted_;
  std::list<Unfinished> messages_;  ///< ordered by the arrival of the last part
  std::map<LcmSender, Entry> by_sender_;
  std::size_t bytes_ = 0;
  std::int64_t unfinished_ = 0;
};

}  // namespace framewatch::drivers
