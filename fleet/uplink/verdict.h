#pragma once

#include <string>

#include "fleet/message/message.h"

namespace framewatch::fleet {

/// What a stream said of a message.
struct Verdict {
  static constexpr int kUnavailable = 503;  ///< nobody is there, or has no leader just now

  int code = kUnavailable;  ///< of an error; 0: the stream has the message
  std::string why = "what answered is no stream";
  bool duplicate = false;  ///< it had it before
};

Verdict verdict_of(const Message& answer);

}  // namespace framewatch::fleet
