#include "daemon/monitor/service/unit_state.h"

#include <systemd/sd-bus.h>

#include <cstdlib>
#include <memory>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr const char* kSystemd = "org.freedesktop.systemd1";
constexpr std::uint64_t kTimeout_us = 1'000'000;

struct Free {
  void operator()(sd_bus* bus) const { ::sd_bus_flush_close_unref(bus); }
  void operator()(char* text) const { std::free(text); }
};

class Unit {
 public:
  explicit Unit(const std::string& name) {
    sd_bus* bus = nullptr;
    if (::sd_bus_open_system(&bus) < 0) return;
    bus_.reset(bus);
    ::sd_bus_set_method_call_timeout(bus, kTimeout_us);
    char* path = nullptr;
    if (::sd_bus_path_encode("/org/freedesktop/systemd1/unit", name.c_str(), &path) >= 0)
      path_.reset(path);
  }
  bool reached() const { return bus_ && path_; }

  std::string text(const char* interface, const char* property) const {
    char* value = nullptr;
    if (::sd_bus_get_property_string(bus_.get(), kSystemd, path_.get(), interface, property,
                                     nullptr, &value) < 0)
      return {};
    const std::unique_ptr<char, Free> owned(value);
    return value;
  }
  std::uint32_t number(const char* interface, const char* property) const {
    std::uint32_t value = 0;
    if (::sd_bus_get_property_trivial(bus_.get(), kSystemd, path_.get(), interface, property,
                                      nullptr, 'u', &value) < 0)
      return 0;
    return value;
  }

 private:
  std::unique_ptr<sd_bus, Free> bus_;
  std::unique_ptr<char, Free> path_;
};

std::string times(std::int64_t n) {
  return n == 1 ? "once" : fmt::format("{} times", n);
}

}  // namespace

std::optional<UnitState> unit_state(const std::string& unit) {
  constexpr const char* kUnit = "org.freedesktop.systemd1.Unit";
  constexpr const char* kService = "org.freedesktop.systemd1.Service";
  const Unit found(unit);
  if (!found.reached() || found.text(kUnit, "LoadState") != "loaded") return std::nullopt;
  return UnitState{found.text(kUnit, "ActiveState"), found.text(kUnit, "SubState"),
                   found.text(kService, "Result"), found.number(kService, "NRestarts")};
}

std::string unit_text(const UnitState& s) {
  std::string out = fmt::format("{} ({})", s.active, s.sub);
  if (s.result != "success" && !s.result.empty()) out += ", the last result was " + s.result;
  if (s.restarts > 0)
    out += fmt::format(", restarted {} by systemd since somebody started it", times(s.restarts));
  return out;
}

std::string unit_oddity(const UnitState& s) {
  if (s.active == "failed" && s.result == "start-limit-hit")
    return "systemd has given up: it came and went too often; journalctl -u framewatch, then "
           "systemctl reset-failed framewatch";
  if (s.active == "failed") return "the service has failed: " + s.result;
  if (s.sub == "auto-restart")
    return fmt::format("it comes and goes: systemd has restarted it {}: journalctl -u framewatch",
                       times(s.restarts));
  return {};
}

}  // namespace framewatch::daemon
