#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace framewatch::fleet {

using Bytes = std::vector<std::uint8_t>;

/// Names of headers (docs/fleet.md).
namespace header {
inline constexpr const char* kKey = "Nats-Msg-Id";       ///< key.h, sealed
inline constexpr const char* kType = "Fw-Type";          ///< event_t, toml, json, ...
inline constexpr const char* kEncoding = "Fw-Encoding";  ///< zstd, or none
inline constexpr const char* kVersion = "Fw-Version";    ///< of the program that sends
inline constexpr const char* kConfig = "Fw-Config";      ///< SHA-256 of the configuration
inline constexpr const char* kWho = "Fw-Who";            ///< commands: the person
inline constexpr const char* kRequest = "Fw-Request";    ///< commands: obeyed once
inline constexpr const char* kUntil = "Fw-Until";        ///< commands: Unix time in s, then void
inline constexpr const char* kPiece = "Fw-Piece";        ///< raw: number, from 0
inline constexpr const char* kPieces = "Fw-Pieces";      ///< raw: how many
inline constexpr const char* kFile = "Fw-File";          ///< raw: name that says the format
inline constexpr const char* kStatus = "Status";         ///< 503: nobody is there
}  // namespace header

/// A message of the hub.
struct Message {
  std::string subject;
  std::string reply;  ///< empty: none is wanted
  std::map<std::string, std::string> headers;
  Bytes bytes;

  /// Empty when it is not there.
  std::string header(const char* name) const;
  /// Of its parts, about what the network carries.
  std::size_t size() const;
};

/// A message with the content of an LCM type (or of another `type`), compressed with zstd where
/// that makes it smaller.
Message packed(std::string subject, std::string key, std::string type, Bytes content,
               const std::string& config_sha256);

/// What was packed. Empty with the reason: an encoding that is not known, damaged bytes, or more
/// than `most` bytes.
std::optional<Bytes> unpacked(const Message& message, std::size_t most, std::string& why);

}  // namespace framewatch::fleet
