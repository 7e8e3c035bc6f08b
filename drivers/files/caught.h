#pragma once

#include <functional>
#include <string>

namespace framewatch::drivers {

/// What `work` threw, in words; empty when it threw nothing.
std::string caught(const std::function<void()>& work);

}  // namespace framewatch::drivers
