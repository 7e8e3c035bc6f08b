#include "drivers/message_check.h"

#include <string_view>

namespace framewatch::drivers {
namespace {

std::uint64_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

/// Walks over a payload's fields without ever leaving it.
class Walk {
 public:
  explicit Walk(std::span<const std::uint8_t> payload) : rest_(payload) {}

  bool skip(std::size_t bytes) {
    if (bytes > rest_.size()) return false;
    rest_ = rest_.subspan(bytes);
    return true;
  }
  bool count(std::size_t& value) {
    if (rest_.size() < 4) return false;
    const std::uint64_t read = big_endian(rest_.first(4));
    if (read > INT32_MAX) return false;
    value = read;
    return skip(4);
  }
  bool string() {
    std::size_t length = 0;  // with its closing zero
    return count(length) && length >= 1 && length <= rest_.size() && rest_[length - 1] == 0 &&
           skip(length);
  }
  bool ended() const { return rest_.empty(); }

 private:
  std::span<const std::uint8_t> rest_;
};

/// Whether `payload` has the layout: per field 8, 4 or 2 bytes ('8', '4', '2'), a string ('s'), a
/// count
/// ('n'); between brackets the arrays of the last count.
bool laid_out(std::span<const std::uint8_t> payload, std::string_view layout) {
  Walk walk(payload);
  std::size_t count = 0;
  std::size_t times = 1;
  for (const char field : layout) {
    bool sound = true;
    if (field == '[') times = count;
    if (field == ']') times = 1;
    if (field == 'n') sound = walk.count(count);
    if (field == '8') sound = walk.skip(8 * times);
    if (field == '4') sound = walk.skip(4 * times);
    if (field == '2') sound = walk.skip(2 * times);
    if (field == 's')
      for (std::size_t i = 0; i < times && sound; ++i) sound = walk.string();
    if (!sound) return false;
  }
  return walk.ended();
}

template <typename Type>
std::optional<Type> decode(std::span<const std::uint8_t> payload, std::string_view layout) {
  if (fingerprint(payload) != Type::getHash() || !laid_out(payload, layout)) return std::nullopt;
  Type message{};
  const int size = static_cast<int>(payload.size());
  if (message.decode(payload.data(), 0, size) != size) return std::nullopt;
  return message;
}

}  // namespace

std::optional<std::int64_t> fingerprint(std::span<const std::uint8_t> payload) {
  if (payload.size() < 8) return std::nullopt;
  return static_cast<std::int64_t>(big_endian(payload.first(8)));
}

// In the layouts the first '8' is the fingerprint.
std::optional<parameter_table_t> decode_parameter_table(std::span<const std::uint8_t> payload) {
  return decode<parameter_table_t>(payload, "88sss8444n[ss448]n[s4]");
}

std::optional<window_estimate_t> decode_window_estimate(std::span<const std::uint8_t> payload) {
  return decode<window_estimate_t>(payload, "8888448n[884444]n[4888]4n[8888844]");
}

std::optional<status_t> decode_status(std::span<const std::uint8_t> payload) {
  return decode<status_t>(payload, "88ss8888488n[s88888888]");
}

std::optional<event_t> decode_event(std::span<const std::uint8_t> payload) {
  return decode<event_t>(payload, "888844ss88sss");
}

std::optional<gap_t> decode_gap(std::span<const std::uint8_t> payload) {
  return decode<gap_t>(payload, "88888n[s88]");
}

std::optional<can_status_t> decode_can_status(std::span<const std::uint8_t> payload) {
  return decode<can_status_t>(payload, "888n[s48888888]");
}

std::optional<accel_counts_t> decode_accel_counts(std::span<const std::uint8_t> payload) {
  return decode<accel_counts_t>(payload, "888n[424]");
}

std::optional<history_status_t> decode_history_status(std::span<const std::uint8_t> payload) {
  return decode<history_status_t>(payload, "88s8888s888s88");
}

std::optional<action_status_t> decode_action_status(std::span<const std::uint8_t> payload) {
  return decode<action_status_t>(payload, "88n[s88888s]");
}

std::optional<acknowledge_t> decode_acknowledge(std::span<const std::uint8_t> payload) {
  return decode<acknowledge_t>(payload, "8888ss");
}

std::optional<acknowledged_t> decode_acknowledged(std::span<const std::uint8_t> payload) {
  return decode<acknowledged_t>(payload, "888sn[8ss8ss]");
}

std::optional<session_command_t> decode_session_command(std::span<const std::uint8_t> payload) {
  return decode<session_command_t>(payload, "88ssss888");
}

std::optional<session_status_t> decode_session_status(std::span<const std::uint8_t> payload) {
  return decode<session_status_t>(payload, "884ssss8s888888888n[s8888884s]");
}

std::optional<service_t> decode_service(std::span<const std::uint8_t> payload) {
  return decode<service_t>(payload, "888884sss88s8s8888888n[888]n[s8]n[884sss]");
}

std::optional<watch_t> decode_watch(std::span<const std::uint8_t> payload) {
  return decode<watch_t>(payload, "88888n[4888888888]");
}

std::optional<temperature_t> decode_temperature(std::span<const std::uint8_t> payload) {
  return decode<temperature_t>(payload, "888");
}

}  // namespace framewatch::drivers
