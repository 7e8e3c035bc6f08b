#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/can/can_frame.h"

namespace framewatch::drivers {

/// A line as `candump -l` writes it: "(1631416514.717133) can0 0D0#A8FF00000000FF01". Ids of eight
/// digits are 29-bit ones, "##" with a digit of flags is CAN FD, "#R" a remote frame, the flag
/// 20000000 in an id an error frame.
/// False when the line is none; `rule` says what it breaks.
bool parse_candump_line(std::string_view line, CanFrame& frame, std::string_view& interface,
                        std::string& rule);

/// Without a line end; `candump -l` would have written the same.
std::string candump_line(const CanFrame& frame, std::string_view interface);

}  // namespace framewatch::drivers
