#pragma once

#include <cstdint>

namespace framewatch::daemon {

/// The connections of the page now, and those it has ended since its start.
struct PageUse {
  int waiting = 0;    ///< for their request to come whole
  int answering = 0;  ///< an answer is being read
  int viewers = 0;    ///< of the stream of events

  std::int64_t late_requests = 0;    ///< did not come whole in time
  std::int64_t late_answers = 0;     ///< were not read in time
  std::int64_t crowded_out = 0;      ///< gave their place to newer ones
  std::int64_t viewers_refused = 0;  ///< found no place
};

}  // namespace framewatch::daemon
