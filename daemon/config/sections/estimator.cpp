// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {
namespace {

constexpr double kLongestOther = 20;

}  // namespace

LcmSettings read_lcm(const TomlValue& document, std::vector<TextProblem>& problems) {
  ConfigSection section("lcm", document, problems);
  auto out = section.read<LcmSettings>();
  if (section.good("url") && out.url.find("://") == std::string::npos)
    section.problem("url", fmt::format("expected a provider such as udpm://, memq:// or "
                                       "file://, got \"{}\"",
                                       out.url));
  constexpr std::size_t kLongestSuffix = 24;
  if (out.prefix.size() + kLongestSuffix > 63)
    section.problem("prefix", fmt::format("at most {} characters: LCM allows a channel 63",
                                          63 - kLongestSuffix));
  return out;
}

CommandSettings read_commands(const TomlValue& document, std::vector<TextProblem>& problems) {
  return ConfigSection("commands", document, problems).read<CommandSettings>();
}

estimator::EstimatorOptions read_estimator(const TomlValue& document,
                                           std::vector<TextProblem>& problems) {
  ConfigSection section("estimator", document, problems);
  if (section.text("variant") == "paper") section.use_paper_defaults();
  const auto o = section.read<estimator::EstimatorOptions>();
  if (section.good("rate_hz") && section.good("high_pass_hz") && o.high_pass_hz >= o.rate_hz / 2)
    section.problem("high_pass_hz",
                    fmt::format("must be below half the sampling rate, {:g} Hz", o.rate_hz / 2));
  constexpr double kMinRows = 40;
  if (section.good("rate_hz") && section.good("window_s") && o.window_s * o.rate_hz < kMinRows)
    section.problem("window_s", fmt::format("must hold at least {:g} samples: >= {:g} s at {:g} Hz",
                                            kMinRows, kMinRows / o.rate_hz, o.rate_hz));
  if (section.good("window_s") && section.good("other_windows_s"))
    for (const double other_s : o.other_windows_s)
      if (other_s > kLongestOther * o.window_s)
        section.problem("other_windows_s",
                        fmt::format("{:g} s is over {:g} times window_s", other_s, kLongestOther));
  if (section.good("window_s") && section.good("hop_s") && o.hop_s > o.window_s)
    section.problem("hop_s", fmt::format("must not be longer than the window, {:g} s", o.window_s));
  return o;
}

}  // namespace framewatch::daemon
