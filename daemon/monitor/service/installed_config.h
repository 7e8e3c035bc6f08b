#pragma once

namespace framewatch::daemon {

/// The configuration of the services that the package installs.
inline constexpr const char* kInstalledConfig = "/etc/framewatch/building.toml";

}  // namespace framewatch::daemon
