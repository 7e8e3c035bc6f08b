#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <framewatch/parameter_table_t.hpp>

#include "fleet/message/message.h"

namespace framewatch::fleet {

/// What the hub keeps the newest of (stream FW_LAST): when which is due. service every 60 s and
/// when an event begins or ends, what is acknowledged when that changes, all but service at the
/// start, after every new connection, when the configuration has changed, and every 10 min, texts
/// of our own every day. Times are of a clock that is never set.
class NewestMessages {
 public:
  static constexpr std::int64_t kService_us = 60'000'000, kOther_us = 600'000'000,
                                kText_us = 86'400'000'000;

  /// LCM channels without the prefix.
  static const std::vector<std::string>& channels();

  /// A message of LCM; bytes that are not of the channel's type are left alone.
  void heard(std::string_view channel, std::span<const std::uint8_t> bytes);
  /// A text of our own, of kind config or inventory.
  void text(const std::string& kind, const std::string& type, const std::string& content);
  /// Everything is due again.
  void again();

  struct Due {
    std::string kind, type;
    Bytes content;
  };
  /// The next one that is due; it counts as given.
  std::optional<Due> due(std::int64_t now_us);

  /// Of the newest service or parameter table; empty when none has come.
  const std::string& config_sha256() const { return config_sha256_; }
  const std::optional<parameter_table_t>& table() const { return table_; }

 private:
  struct Newest {
    std::string type;
    Bytes content;
    std::optional<std::int64_t> given_us;
  };
  void take_service(std::span<const std::uint8_t> bytes);
  void take_acknowledged(std::span<const std::uint8_t> bytes);
  void config_is(const std::string& sha256);

  std::map<std::string, Newest> newest_;  ///< by kind
  std::optional<parameter_table_t> table_;
  std::string config_sha256_;
  std::vector<std::int64_t> raised_, acknowledged_;  ///< ids of events, as they were heard last
};

}  // namespace framewatch::fleet
