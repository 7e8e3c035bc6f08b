// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace framewatch::drivers {

/// Runs `work` and returns the text of the exception it threw; empty when it threw none.
std::string caught(const std::function<void()>& work);

/// How an attempt in a child process ended.
enum class AttemptEnd { survived, crashed, too_long, not_begun };

/// Runs `attempt` in a child process, a copy of this one, for at most `most_cpu_s` seconds of
/// processor time and ten times that by the clock. Use it before handing a library bytes that may
/// crash it: if the child survives, the parent can safely do the same. Changes made by the attempt
/// are lost, and an exception counts as survived.
AttemptEnd try_apart(const std::function<void()>& attempt, int most_cpu_s);

}  // namespace framewatch::drivers
