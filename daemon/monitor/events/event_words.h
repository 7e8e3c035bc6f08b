#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace framewatch::daemon {

/// Values of event_t::state.
namespace event_state {
enum : std::int32_t { cleared, raised, changed };
}
inline constexpr std::array kEventStates = {"cleared", "raised", "changed"};

/// Values of event_t::severity.
namespace severity {
enum : std::int32_t { information, warning, alarm };
}
inline constexpr std::array kSeverities = {"information", "warning", "alarm"};

/// The word for a number; a number out of range, from another program, gives the nearest word.
template <std::size_t N>
constexpr const char* word(const std::array<const char*, N>& words, std::int32_t number) {
  return words[static_cast<std::size_t>(std::clamp(number, 0, static_cast<std::int32_t>(N) - 1))];
}

}  // namespace framewatch::daemon
