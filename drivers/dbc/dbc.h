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
  std::string multiplexor;             ///< the signal that switches this one; empty: none
  std::vector<ValueRange> present_at;  ///< values of that signal; empty: in every frame
  std::string unit;
  std::int64_t line = 0;
};

/// A rule that a message breaks; `line` is that of the statement.
struct DbcRule {
  std::int64_t line;
  std::string message;
};

/// A message of a DBC file.
struct DbcMessage {
  std::string name;
  std::uint32_t id = 0;  ///< 11 or 29 bits
  bool extended = false;
  int length = 0;      ///< bytes, 0..64; 65: more
  double cycle_s = 0;  ///< GenMsgCycleTime; 0: not given
  std::vector<DbcSignal> signals;
  std::int64_t line = 0;
  std::vector<DbcRule> contradictions;  ///< to other statements of the file

  /// Returns the signal of this name, or null.
  const DbcSignal* find(const std::string& signal) const;
};

/// The messages of a DBC file, from BO_, SG_, SG_MUL_VAL_, SIG_VALTYPE_ and the attribute
/// GenMsgCycleTime.
struct Dbc {
  std::vector<DbcMessage> messages;

  /// Returns the first message of this name, or null.
  const DbcMessage* find(const std::string& message) const;
};

/// Parses the `text` of a DBC file; `path` names it in messages. Accepts a byte-order mark, CRLF,
/// Latin-1, statements over several lines and remarks after //. Skips statements that are not
/// needed, and VECTOR__INDEPENDENT_SIG_MSG, the list of signals without a message. Returns nullopt
/// and appends the first 20 problems at path:line for malformed statements. Messages may break
/// other rules: see broken_rules().
std::optional<Dbc> parse_dbc(const std::string& path, const std::string& text,
                             std::vector<Problem>& problems);

/// Returns the rules that a message breaks, each of which makes its values uncertain. They concern
/// its id and length, names and ids that the file has twice, signals that overlap or do not fit,
/// and multiplexors that are missing, ambiguous or too narrow. A message may break them as long as
/// its frames are not decoded.
std::vector<DbcRule> broken_rules(const DbcMessage& message);

/// Returns the switches of a signal, that of its multiplexor first: it is in a frame in which all
/// are on. Follows at most 16 multiplexors; broken_rules() refuses more.
std::vector<CanSwitch> switches_of(const DbcMessage& message, const DbcSignal& signal);

}  // namespace framewatch::drivers
