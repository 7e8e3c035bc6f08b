#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_frame.h"
#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

struct DbcSignal {
  std::string name;
  CanField field;
  bool is_multiplexor = false;
  std::optional<std::int64_t> multiplexed_by;  ///< value of the multiplexor it is present at
  std::string unit;
  std::int64_t line = 0;
};

struct DbcMessage {
  std::string name;
  std::uint32_t id = 0;  ///< 11 or 29 bits
  bool extended = false;
  int length = 0;      ///< bytes, 0..64
  double cycle_s = 0;  ///< GenMsgCycleTime; 0: not said
  std::vector<DbcSignal> signals;
  std::int64_t line = 0;

  const DbcSignal* find(const std::string& signal) const;
  const DbcSignal* multiplexor() const;
};

/// The messages of a DBC file: BO_, SG_, SIG_VALTYPE_ and the attribute GenMsgCycleTime; every
/// other statement is read over.
struct Dbc {
  std::vector<DbcMessage> messages;

  const DbcMessage* find(const std::string& message) const;
};

/// Reads a whole DBC file. Strict: a statement that is not as it must be, signals that overlap or
/// do not fit, multiplexors that are missing, double or too narrow, names and ids given twice are
/// problems at path:line, the first 20 of them. A byte-order mark, CRLF and Latin-1 texts are
/// taken as they are. Empty when there was a problem.
std::optional<Dbc> parse_dbc(const std::string& path, const std::string& text,
                             std::vector<Problem>& problems);

/// Problems of one message beyond its syntax; `line` is that of the signal or message.
struct DbcRule {
  std::int64_t line;
  std::string message;
};
std::vector<DbcRule> broken_rules(const DbcMessage& message);

}  // namespace framewatch::drivers
