#pragma once

#include <functional>

namespace framewatch::drivers {

enum class Trial { survived, crashed, too_long, not_begun };

/// How `attempt` ends in a process of its own, a copy of this one, within so much time of a
/// processor and ten times that by the clock. For what a library does with bytes that it may not
/// survive: whoever does the same afterwards does what has gone well. What the attempt changes is
/// lost, and so is what it throws: that counts as survived.
Trial try_apart(const std::function<void()>& attempt, int most_cpu_s);

}  // namespace framewatch::drivers
