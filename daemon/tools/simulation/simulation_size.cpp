#include "daemon/tools/simulation/simulation_size.h"

#include <fmt/core.h>

#include "daemon/config/config_size.h"

namespace framewatch::daemon {
namespace {

constexpr double kMaxInstants = 1e9;  // 116 days at 100 Hz

}  // namespace

std::string size_problem(const Scenario& s) {
  const double instants = s.duration_s * s.rate_hz;
  if (!(instants <= kMaxInstants))
    return fmt::format(
        "duration: {:g} s at {:g} Hz are {:.3g} instants, at most {:g} are simulated", s.duration_s,
        s.rate_hz, instants, kMaxInstants);
  return simulated_size_problem(s.config.pipeline.structure);
}

}  // namespace framewatch::daemon
