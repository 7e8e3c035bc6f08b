// SPDX-License-Identifier: MIT
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
inline constexpr const char* kKey = "Nats-Msg-Id";       ///< address.h, sealed
inline constexpr const char* kType = "Fw-Type";          ///< event_t, toml, json, ...
inline constexpr const char* kEncoding = "Fw-Encoding";  ///< zstd, or missing
inline constexpr const char* kVersion = "Fw-Version";    ///< of the sending program
inline constexpr const char* kConfig = "Fw-Config";      ///< SHA-256 of the configuration
inline constexpr const char* kWho = "Fw-Who";            ///< commands: the person
inline constexpr const char* kRequest = "Fw-Request";    ///< commands: id, executed only once
inline constexpr const char* kUntil = "Fw-Until";        ///< commands: void after this Unix time, s
inline constexpr const char* kPiece = "Fw-Piece";        ///< raw: number, from 0
inline constexpr const char* kPieces = "Fw-Pieces";      ///< raw: number of pieces
inline constexpr const char* kFile = "Fw-File";          ///< raw: file name with the format
inline constexpr const char* kStatus = "Status";         ///< 503: no receiver
}  // namespace header

/// A message to or from the hub.
struct Message {
  std::string subject;
  std::string reply;  ///< subject for the reply; empty: no reply wanted
  std::map<std::string, std::string> headers;
  Bytes bytes;

  /// Returns a header; empty if it is missing.
  std::string header(const char* name) const;
  /// Returns the size of all parts in bytes, about the size on the network.
  std::size_t size() const;
};

/// Makes a message with content of an LCM or other `type`, compressed with zstd if that is smaller.
/// key: empty: without Nats-Msg-Id. config_sha256: empty: without Fw-Config.
Message packed(std::string subject, std::string key, std::string type, Bytes content,
               const std::string& config_sha256);

/// Returns the content of a message. Returns nullopt and sets `why` if the encoding is unknown, the
/// bytes are damaged, or the content exceeds `most` bytes.
std::optional<Bytes> unpacked(const Message& message, std::size_t most, std::string& why);

}  // namespace framewatch::fleet
