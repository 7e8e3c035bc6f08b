#pragma once

#include <string_view>

#include "daemon/config/keys/target.h"

namespace framewatch::daemon {

namespace fields_detail {
void place_files(std::string_view section, const void* owner, std::string_view directory,
                 void* settings);
void take_reloadable(std::string_view section, const void* owner, const void* from, void* to);
}  // namespace fields_detail

/// Paths of files that the section names, relative to `directory` in the file, become whole.
template <class Settings>
void place_files(std::string_view section, std::string_view directory, Settings& settings) {
  fields_detail::place_files(section, &kOwner<Settings>, directory, &settings);
}

/// Copies the fields of the section's keys that do not take a restart.
template <class Settings>
void take_reloadable(std::string_view section, const Settings& from, Settings& to) {
  fields_detail::take_reloadable(section, &kOwner<Settings>, &from, &to);
}

}  // namespace framewatch::daemon
