#pragma once

#include <functional>

namespace framewatch::drivers {

/// Whether `attempt` comes to its end in a process of its own, a copy of this one, within so much
/// time of a processor. False when it crashes there. For what a library does with bytes that it
/// may not survive: whoever does the same afterwards does what has gone well. What the attempt
/// changes is lost.
bool survives_apart(const std::function<void()>& attempt, int most_cpu_s);

}  // namespace framewatch::drivers
