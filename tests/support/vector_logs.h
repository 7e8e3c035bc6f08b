// SPDX-License-Identifier: MIT
#pragma once

#include <zlib.h>

#include <array>
#include <cstdint>
#include <string>

#include <fmt/core.h>

#include "drivers/can/can_frame.h"

namespace framewatch::test {

/// Writes a binary log of Vector, with the layout that Tobias Lorenz's Vector_BLF describes.
class BlfWriter {
 public:
  /// Appends a number of `bytes` bytes, little-endian.
  static void put(std::string& to, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i, value >>= 8) to += static_cast<char>(value);
  }

  /// Returns an object with a header of version 1 or 2. `stamp` is in nanoseconds, or with
  /// `flags` = 1 in units of 10 us.
  static std::string object(std::uint32_t type, std::uint64_t stamp, const std::string& body,
                            std::uint32_t flags = 2, int version = 1) {
    const std::size_t header = version == 1 ? 32 : 40;
    std::string out = "LOBJ";
    put(out, header, 2);
    put(out, static_cast<std::uint64_t>(version), 2);
    put(out, header + body.size(), 4);
    put(out, type, 4);
    put(out, flags, 4);
    put(out, 0, 4);
    put(out, stamp, 8);
    if (version == 2) put(out, 0, 8);
    out += body;
    return out.append((header + body.size()) % 4, '\0');
  }

  /// Returns the CAN_MESSAGE (1) or CAN_MESSAGE2 (86) of a classical frame.
  static std::string message(const drivers::CanFrame& frame, unsigned channel,
                             std::uint64_t stamp_ns, std::uint32_t type = 1,
                             unsigned direction = 0) {
    std::string body;
    put(body, channel, 2);
    put(body, (frame.remote ? 0x80u : 0u) | direction, 1);
    put(body, frame.length, 1);
    put(body, frame.id | (frame.extended ? 0x80000000u : 0u), 4);
    body.append(frame.data.begin(), frame.data.begin() + 8);
    if (type == 86) put(body, 0, 8);
    return object(type, stamp_ns, body);
  }

  /// Returns a container of objects, packed by zlib or (method 0) not.
  static std::string container(const std::string& objects, int method = 2) {
    std::string packed = objects;
    if (method == 2) {
      uLongf bytes = ::compressBound(static_cast<uLong>(objects.size()));
      packed.resize(bytes);
      ::compress(reinterpret_cast<Bytef*>(packed.data()), &bytes,
                 reinterpret_cast<const Bytef*>(objects.data()),
                 static_cast<uLong>(objects.size()));
      packed.resize(bytes);
    }
    std::string out = "LOBJ";
    put(out, 16, 2);
    put(out, 1, 2);
    put(out, 32 + packed.size(), 4);
    put(out, 10, 4);
    put(out, static_cast<std::uint64_t>(method), 2);
    put(out, 0, 6);
    put(out, objects.size(), 4);
    put(out, 0, 4);
    out += packed;
    return out.append(packed.size() % 4, '\0');
  }

  /// Returns a file of containers. Its start is 2026-11-27 23:30:05.250.
  static std::string file(const std::string& containers) {
    std::string out = "LOGG";
    put(out, 144, 4);
    put(out, 0, 32);
    for (const int part : {2026, 11, 5, 27, 23, 30, 5, 250})
      put(out, static_cast<std::uint64_t>(part), 2);
    out.resize(144, '\0');
    return out + containers;
  }
};

/// Returns a classical data frame as a line of a Vector text log in hexadecimal. `time` is in
/// seconds, as text.
inline std::string asc_line(const drivers::CanFrame& frame, unsigned channel,
                            const std::string& time) {
  std::string out = fmt::format("{:>11} {}  {:X}{:<12} Rx   d {:x}", time, channel, frame.id,
                                frame.extended ? "x" : "", frame.length);
  for (std::size_t i = 0; i < frame.length; ++i) out += fmt::format(" {:02X}", frame.data[i]);
  return out + fmt::format("  Length = 244016 BitCount = 125 ID = {}{}\n", frame.id,
                           frame.extended ? "x" : "");
}

}  // namespace framewatch::test
