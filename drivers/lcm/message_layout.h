#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace framewatch::drivers {

/// One field of a message, as its .lcm file declares it.
struct FieldLayout {
  std::string_view name;
  int bytes;         ///< of one element; 0: a string, which says its own length
  int elements;      ///< of an array of fixed length; else 1
  int length_field;  ///< index of the field that holds the array's length; -1: none
  bool is_length;    ///< arrays after it have this length, which must not be negative
};

/// One type of message. <framewatch/message_layouts.hpp>, which the build makes from
/// lcmtypes/*.lcm, holds kMessageLayouts with all of them, and each one's fields (kAccelFields for
/// accel_t).
struct MessageLayout {
  const char* type;               ///< "accel_t"
  std::int64_t (*fingerprint)();  ///< the first 8 bytes of every payload
  std::string_view lcm_channel;   ///< "FRAMEWATCH_STATUS", "ACCEL*", "*_CHANNELS"
  std::span<const FieldLayout> fields;
};

/// Byte of a payload at which the field begins; the first is 8, after the fingerprint. For constant
/// expressions: does not compile when a field before it has no fixed size or there is none of this
/// name.
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
