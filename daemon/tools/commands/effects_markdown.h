#pragma once

#include <string>

namespace framewatch::daemon {

/// docs/effects.md, made from the catalogue of effects.
std::string effects_markdown();

}  // namespace framewatch::daemon
