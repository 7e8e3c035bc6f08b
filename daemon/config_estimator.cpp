#include <fmt/core.h>

#include "daemon/config_parts.h"
#include "daemon/config_section.h"

namespace framewatch::daemon {
namespace {

constexpr double kLongestOther = 20;

}  // namespace

EstimatorOptions read_estimator(const TomlValue& document, std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("estimator");
  ConfigSection section("estimator", "estimator", entry ? &entry->value : nullptr, {1, 1},
                        problems);
  EstimatorOptions o;
  o.variant = section.text("variant") == "paper" ? Variant::paper : Variant::matched;
  o.rate_hz = section.number("rate_hz");
  o.window_s = section.number("window_s");
  if (section.given("other_windows_s")) {
    const TomlValue& windows = *section.value("other_windows_s");
    const auto count = windows.kind == TomlKind::array ? windows.items.size() : 1;
    o.other_windows_s = section.grid("other_windows_s", {static_cast<int>(count)});
  }
  o.hop_s = section.number("hop_s");
  o.boxplot_windows = section.integer("boxplot_windows");
  o.high_pass_hz = section.number_for("high_pass_hz", o.variant == Variant::paper);
  o.filter_damping = section.number("filter_damping");
  o.corner_ratio = section.number("corner_ratio");
  o.prior = section.boolean("prior");
  o.self_tune = section.boolean("self_tune");
  o.settle_s = section.number("settle_s");
  o.lateness_s = section.number("lateness_s");
  o.fill_single_losses = section.boolean("fill_single_losses");
  o.min_snr = section.number("min_snr");
  o.max_error_k = section.number("max_error_k_ratio");
  o.max_error_g = section.number("max_error_g_ratio");
  o.max_error_c = section.number("max_error_c_ratio");
  if (section.good("rate_hz") && section.good("high_pass_hz") && o.high_pass_hz >= o.rate_hz / 2)
    section.problem("high_pass_hz",
                    fmt::format("must be below half the sampling rate, {:g} Hz", o.rate_hz / 2));
  constexpr double kLeastRows = 40;
  if (section.good("rate_hz") && section.good("window_s") && o.window_s * o.rate_hz < kLeastRows)
    section.problem("window_s", fmt::format("must hold at least {:g} samples: >= {:g} s at {:g} Hz",
                                            kLeastRows, kLeastRows / o.rate_hz, o.rate_hz));
  if (section.good("window_s") && section.good("other_windows_s"))
    for (const double other_s : o.other_windows_s)
      if (other_s > kLongestOther * o.window_s)
        section.problem("other_windows_s",
                        fmt::format("{:g} s is over {:g} times window_s", other_s, kLongestOther));
  if (section.good("window_s") && section.good("hop_s") && o.hop_s > o.window_s)
    section.problem("hop_s", fmt::format("must not be longer than the window, {:g} s", o.window_s));
  return o;
}

LcmSettings read_lcm(const TomlValue& document, std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("lcm");
  ConfigSection section("lcm", "lcm", entry ? &entry->value : nullptr, {1, 1}, problems);
  LcmSettings out;
  out.url = section.text("url");
  out.prefix = section.text("prefix");
  out.queue_capacity = section.integer("queue_capacity");
  out.receive_buffer_bytes = section.integer("receive_buffer_bytes");
  out.boxplot_every = section.integer("boxplot_every");
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

}  // namespace framewatch::daemon
