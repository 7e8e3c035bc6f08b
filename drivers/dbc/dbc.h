// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_frame.h"
#include "drivers/files/file_problems.h"

namespace framewatch::drivers {

/// A signal of a DBC message.
struct DbcSignal {
  std::string name;
  CanField field;
  bool is_multiplexor = false;
  std::optional<std::int64_t> multiplexed_by;  ///< value of the multiplexor at which it is present
  std::string unit;
  std::int64_t line = 0;
};

/// A message of a DBC file.
struct DbcMessage {
  std::string name;
  std::uint32_t id = 0;  ///< 11 or 29 bits
  bool extended = false;
  int length = 0;      ///< bytes, 0..64
  double cycle_s = 0;  ///< GenMsgCycleTime; 0: not given
  std::vector<DbcSignal> signals;
  std::int64_t line = 0;

  /// Returns the signal of this name, or null.
  const DbcSignal* find(const std::string& signal) const;
  /// Returns the multiplexor, or null.
  const DbcSignal* multiplexor() const;
};

/// The messages of a DBC file, from BO_, SG_, SIG_VALTYPE_ and the attribute GenMsgCycleTime.
struct Dbc {
  std::vector<DbcMessage> messages;

  /// Returns the message of this name, or null.
  const DbcMessage* find(const std::string& message) const;
};

/// Parses the `text` of a DBC file; `path` names it in messages. Accepts a byte-order mark, CRLF
/// and Latin-1, and skips statements that are not needed. Returns nullopt and appends the first 20
/// problems at path:line for malformed statements and for signals that overlap or do not fit. Also
/// refuses multiplexors that are missing, double or too narrow, and names and ids given twice.
std::optional<Dbc> parse_dbc(const std::string& path, const std::string& text,
                             std::vector<Problem>& problems);

/// A rule that a message breaks; `line` is that of the signal or message.
struct DbcRule {
  std::int64_t line;
  std::string message;
};
/// Returns the rules that a message breaks, apart from its syntax.
std::vector<DbcRule> broken_rules(const DbcMessage& message);

}  // namespace framewatch::drivers
