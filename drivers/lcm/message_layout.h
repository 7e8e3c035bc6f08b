// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace framewatch::drivers {

/// Describes one field of a message as its .lcm file does.
struct FieldLayout {
  std::string_view name;
  int bytes;         ///< of one element; 0: a string, which holds its length
  int elements;      ///< number in an array of fixed length; else 1
  int length_field;  ///< index of the field with the array's length, or -1
  bool is_length;    ///< holds the length of arrays after it; must not be negative
};

/// Describes one type of message. The build generates <framewatch/message_layouts.hpp> from
/// lcmtypes/*.lcm, with kMessageLayouts for all types and a list of fields for each (kAccelFields
/// for accel_t).
struct MessageLayout {
  const char* type;               ///< "accel_t"
  std::int64_t (*fingerprint)();  ///< the first 8 bytes of every payload
  std::string_view lcm_channel;   ///< "FRAMEWATCH_STATUS", "ACCEL*", "*_CHANNELS"
  std::span<const FieldLayout> fields;
};

/// Returns the byte of a payload at which a field begins; the first field is at 8, after the
/// fingerprint. Does not compile when there is no field of this name, or when a field before it has
/// no fixed size.
consteval std::size_t offset_of(std::span<const FieldLayout> fields, std::string_view name) {
  std::size_t offset = 8;
  for (const FieldLayout& field : fields) {
    if (field.name == name) return offset;
    if (field.bytes == 0 || field.length_field >= 0) throw "a field of variable size";
    offset += static_cast<std::size_t>(field.bytes) * static_cast<std::size_t>(field.elements);
  }
  throw "no such field";
}

}  // namespace framewatch::drivers
