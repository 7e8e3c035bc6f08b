#pragma once

#include <cstddef>
#include <string_view>

#include "daemon/base/toml_document.h"

namespace framewatch::daemon {

/// Whether a section gives the key as a list, not as a number that stands for all.
bool is_list(const TomlValue& section, std::string_view key);

/// Where the value of item `index` of `count` of a grid begins: the number that stands for all when
/// it is no list, the section when it lacks the key.
TextPlace place_in(const TomlValue& section, std::string_view key, std::size_t index,
                   std::size_t count);

}  // namespace framewatch::daemon
