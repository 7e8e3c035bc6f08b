#include "daemon/config_options.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

using enum OptionType;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

const Option kOptions[] = {
    {.section = "structure",
     .key = "name",
     .type = text,
     .default_value = "\"building\"",
     .meaning = "What people call the building."},
    {.section = "structure",
     .key = "stories",
     .type = integer,
     .required = true,
     .min = 1,
     .max = 1000,
     .meaning = "Number of stories; floor i lies on top of story i, 0 is the ground."},
    {.section = "structure",
     .key = "frames_x",
     .type = texts,
     .default_value = "[]",
     .meaning = "Names of the vertical frames parallel to x, in order of y; none when the building "
                "is a plane one along y."},
    {.section = "structure",
     .key = "frames_y",
     .type = texts,
     .default_value = "[]",
     .meaning = "Names of the vertical frames parallel to y, in order of x; none when the building "
                "is a plane one along x."},
    {.section = "structure",
     .key = "span_x_m",
     .type = grid,
     .unit = "m",
     .shape = "[x span]",
     .default_value = "[]",
     .min = 0,
     .max = 1000,
     .above_min = true,
     .meaning = "Distances between neighbouring y-parallel frames: one less than frames_y."},
    {.section = "structure",
     .key = "span_y_m",
     .type = grid,
     .unit = "m",
     .shape = "[y span]",
     .default_value = "[]",
     .min = 0,
     .max = 1000,
     .above_min = true,
     .meaning = "Distances between neighbouring x-parallel frames: one less than frames_x."},
    {.section = "structure",
     .key = "story_height_m",
     .type = grid,
     .unit = "m",
     .shape = "[story]",
     .required = true,
     .min = 0,
     .max = 1000,
     .above_min = true,
     .meaning = "Floor-to-floor heights."},
    {.section = "structure",
     .key = "floor",
     .type = choice,
     .default_value = "\"flexible\"",
     .choices = "flexible|rigid",
     .meaning = "Whether floor panels shear in their plane or a floor moves as one body."},
    {.section = "structure",
     .key = "node_mass_kg",
     .type = grid,
     .unit = "kg",
     .shape = "[story][y][x]",
     .required = true,
     .min = 0,
     .max = 1e9,
     .above_min = true,
     .meaning =
         "Mass at each crossing of frames: one row per x-parallel frame, in it one value per "
         "y-parallel frame. In a plane building also [story][frame]."},

    {.section = "structure.design",
     .key = "kx_npm",
     .type = grid,
     .unit = "N/m",
     .shape = "[story][frame]",
     .min = 0,
     .max = 1e13,
     .above_min = true,
     .meaning = "Design stiffness of the x-parallel frames; needed when there are any."},
    {.section = "structure.design",
     .key = "ky_npm",
     .type = grid,
     .unit = "N/m",
     .shape = "[story][frame]",
     .min = 0,
     .max = 1e13,
     .above_min = true,
     .meaning = "Design stiffness of the y-parallel frames; needed when there are any."},
    {.section = "structure.design",
     .key = "gk",
     .type = grid,
     .unit = "N/(rad*m)",
     .shape = "[story][y span][x span]",
     .min = 0,
     .max = 1e13,
     .above_min = true,
     .meaning = "Design shear stiffness of the floor panels; without it every panel of a floor "
                "starts as stiff as the mean frame of the story below it. Unused when the floors "
                "are rigid."},
    {.section = "structure.design",
     .key = "damping_ratio",
     .type = number,
     .default_value = "0.02",
     .min = 0,
     .max = 1,
     .above_min = true,
     .meaning = "Damping ratio of the first mode; design damping is proportional to stiffness, "
                "but for what the next keys say."},
    {.section = "structure.design",
     .key = "cx_nspm",
     .type = grid,
     .unit = "N*s/m",
     .shape = "[story][frame]",
     .min = 0,
     .max = 1e13,
     .above_min = true,
     .meaning = "Design damping of the x-parallel frames."},
    {.section = "structure.design",
     .key = "cy_nspm",
     .type = grid,
     .unit = "N*s/m",
     .shape = "[story][frame]",
     .min = 0,
     .max = 1e13,
     .above_min = true,
     .meaning = "Design damping of the y-parallel frames."},
    {.section = "structure.design",
     .key = "gc",
     .type = grid,
     .unit = "N*s/(rad*m)",
     .shape = "[story][y span][x span]",
     .min = 0,
     .max = 1e13,
     .above_min = true,
     .meaning = "Design damping of the floor panels. Unused when the floors are rigid."},

    {.section = "channel",
     .key = "name",
     .type = text,
     .required = true,
     .meaning = "Unique; appears in messages, record files and plots."},
    {.section = "channel",
     .key = "story",
     .type = integer,
     .required = true,
     .min = 0,
     .max = 1000,
     .meaning = "Floor it stands on; 0 is the base."},
    {.section = "channel",
     .key = "frame",
     .type = text,
     .meaning = "Frame it rides on, measuring along it; needed above the base."},
    {.section = "channel",
     .key = "direction",
     .type = choice,
     .choices = "x|y",
     .meaning = "Direction it measures; needed for a base channel without a frame."},
    {.section = "channel",
     .key = "source",
     .type = table,
     .meaning = "Where its samples come from; without it the channel is read from files only."},
    {.section = "channel",
     .key = "scale",
     .type = number,
     .default_value = "1.0",
     .min = -1e12,
     .max = 1e12,
     .meaning = "Raw value times scale is in m/s^2; not 0."},
    {.section = "channel",
     .key = "offset_mps2",
     .type = number,
     .unit = "m/s^2",
     .default_value = "0.0",
     .min = -1e6,
     .max = 1e6,
     .meaning = "Subtracted after scaling."},
    {.section = "channel",
     .key = "polarity",
     .type = integer,
     .default_value = "1",
     .min = -1,
     .max = 1,
     .meaning = "1, or -1 for an axis that is mounted backwards."},
    {.section = "channel",
     .key = "delay_s",
     .type = number,
     .unit = "s",
     .default_value = "0.0",
     .min = -10,
     .max = 10,
     .meaning = "The true instant of a sample is its stamp minus this."},
    {.section = "channel",
     .key = "tilt_deg",
     .type = number,
     .unit = "deg",
     .default_value = "0.0",
     .min = -60,
     .max = 60,
     .meaning = "Angle of the positive axis above the horizontal: gravity on it is taken off, and "
                "its smaller share of the motion corrected."},
    {.section = "channel",
     .key = "mount_angle_deg",
     .type = number,
     .unit = "deg",
     .default_value = "0.0",
     .min = -60,
     .max = 60,
     .meaning = "Angle in plan, counter-clockwise seen from above, between the axis and the "
                "direction it stands for; corrected with cross_channel."},
    {.section = "channel",
     .key = "cross_channel",
     .type = text,
     .meaning = "Channel of the other horizontal direction, at the same place or the nearest on "
                "the floor; needed for a mounting angle."},
    {.section = "channel",
     .key = "range_mps2",
     .type = number,
     .unit = "m/s^2",
     .default_value = "0.0",
     .min = 0,
     .max = 1e6,
     .meaning = "Full scale of scale times raw: samples at it are clipped and taken out. 0 when "
                "not known: then a flat peak shows it."},
    {.section = "channel",
     .key = "noise_mps2_per_rthz",
     .type = number,
     .unit = "m/s^2/sqrt(Hz)",
     .default_value = "0.0",
     .min = 0,
     .max = 1e3,
     .meaning = "Noise density of the sensor; 0 when it is not known: then it is measured "
                "between 0.25 and 0.45 of the sampling rate."},

    {.section = "channel.source",
     .key = "lcm",
     .type = text,
     .default_value = "\"ACCEL\"",
     .meaning = "LCM channel that carries the node's accel_t messages."},
    {.section = "channel.source",
     .key = "node",
     .type = integer,
     .required = true,
     .min = 0,
     .max = 2147483647,
     .meaning = "Number of the node in its messages."},
    {.section = "channel.source",
     .key = "axis",
     .type = choice,
     .required = true,
     .choices = "x|y|z",
     .meaning = "Axis of the node."},
    {.section = "estimator",
     .key = "variant",
     .type = choice,
     .default_value = "\"matched\"",
     .choices = "matched|paper",
     .meaning = "matched: every floor's equations filtered at their own frequencies; paper: the "
                "paper's common high-pass, trapezoid and plain least squares."},
    {.section = "estimator",
     .key = "rate_hz",
     .type = number,
     .unit = "Hz",
     .default_value = "100.0",
     .min = 1,
     .max = 100000,
     .meaning = "Sampling rate of all channels."},
    {.section = "estimator",
     .key = "window_s",
     .type = number,
     .unit = "s",
     .default_value = "5.0",
     .min = 0,
     .max = 3600,
     .above_min = true,
     .meaning = "Length of the window; rounded to 20 blocks of whole samples."},
    {.section = "estimator",
     .key = "other_windows_s",
     .type = grid,
     .unit = "s",
     .shape = "[window]",
     .default_value = "[1.0, 2.5, 10.0]",
     .min = 0,
     .max = 3600,
     .above_min = true,
     .meaning =
         "Lengths of further windows, summed from the main one's blocks (twentieths of it) and "
         "published five times per length, at most once per block, on ESTIMATE_1S and so on; "
         "rounded to whole blocks, at least four."},
    {.section = "estimator",
     .key = "hop_s",
     .type = number,
     .unit = "s",
     .default_value = "0.01",
     .min = 0,
     .max = 3600,
     .above_min = true,
     .meaning = "Time between published windows; rounded to whole samples, at least one."},
    {.section = "estimator",
     .key = "boxplot_windows",
     .type = integer,
     .default_value = "500",
     .min = 1,
     .max = 100000,
     .meaning = "Number of windows the boxplot statistics cover."},
    {.section = "estimator",
     .key = "high_pass_hz",
     .type = number,
     .unit = "Hz",
     .default_value = "0.3",
     .paper_default = "0.1",
     .min = 0.001,
     .max = 1000,
     .meaning = "Corner of the high-pass that controls drift."},
    {.section = "estimator",
     .key = "filter_damping",
     .type = number,
     .default_value = "0.35",
     .min = 0.05,
     .max = 2,
     .meaning = "Damping ratio of the matched low-pass filters."},
    {.section = "estimator",
     .key = "corner_ratio",
     .type = number,
     .default_value = "1.0",
     .min = 0.1,
     .max = 10,
     .meaning = "Corner of the matched filters relative to the floors' own frequencies."},
    {.section = "estimator",
     .key = "prior",
     .type = boolean,
     .default_value = "true",
     .meaning = "Weak pull toward the design where the data say little."},
    {.section = "estimator",
     .key = "self_tune",
     .type = boolean,
     .default_value = "true",
     .meaning = "Re-tune the filters to what was identified."},
    {.section = "estimator",
     .key = "settle_s",
     .type = number,
     .unit = "s",
     .default_value = "3.0",
     .min = 0,
     .max = 3600,
     .meaning = "Time a new or interrupted input needs before its windows count."},
    {.section = "estimator",
     .key = "lateness_s",
     .type = number,
     .unit = "s",
     .default_value = "0.5",
     .min = 0,
     .max = 60,
     .meaning =
         "An instant is closed this long after its time; later samples are counted and lost."},
    {.section = "estimator",
     .key = "fill_single_losses",
     .type = boolean,
     .default_value = "true",
     .meaning = "Repair a single lost sample by cubic interpolation."},
    {.section = "estimator",
     .key = "min_snr",
     .type = number,
     .default_value = "10.0",
     .min = 0,
     .max = 1e9,
     .meaning = "A value is published when its regressor's energy is this many times "
                "that of the noise."},
    {.section = "estimator",
     .key = "max_error_k_ratio",
     .type = number,
     .default_value = "0.035",
     .min = 0,
     .max = 100,
     .above_min = true,
     .meaning = "Largest relative standard error a published frame stiffness may have."},
    {.section = "estimator",
     .key = "max_error_g_ratio",
     .type = number,
     .default_value = "0.2",
     .min = 0,
     .max = 100,
     .above_min = true,
     .meaning = "The same for floor-panel stiffness."},
    {.section = "estimator",
     .key = "max_error_c_ratio",
     .type = number,
     .default_value = "0.2",
     .min = 0,
     .max = 100,
     .above_min = true,
     .meaning = "The same for damping of frames and panels."},

    {.section = "lcm",
     .key = "url",
     .type = text,
     .default_value = "\"udpm://239.255.76.67:7667?ttl=0\"",
     .meaning = "LCM provider, as LCM writes it; ttl=0 keeps the traffic on this machine."},
    {.section = "lcm",
     .key = "prefix",
     .type = text,
     .default_value = "\"FRAMEWATCH_\"",
     .meaning = "Of the channels framewatch publishes on; two daemons on one bus need two."},
    {.section = "lcm",
     .key = "queue_capacity",
     .type = integer,
     .unit = "messages",
     .default_value = "10000",
     .min = 1,
     .max = 10000000,
     .meaning = "Messages that may wait for the estimator; more are counted and lost."},
    {.section = "lcm",
     .key = "receive_buffer_bytes",
     .type = integer,
     .unit = "bytes",
     .default_value = "4194304",
     .min = 4096,
     .max = 1073741824,
     .meaning = "Size of the socket's receive buffer."},
    {.section = "lcm",
     .key = "boxplot_every",
     .type = integer,
     .unit = "windows",
     .default_value = "1",
     .min = 1,
     .max = 1000000,
     .meaning = "Boxplot statistics go out with every n-th window."},
};

}  // namespace

std::span<const Option> options() {
  static const std::vector<Option> kAll = [] {
    std::vector<Option> all(std::begin(kOptions), std::end(kOptions));
    const std::span<const Option> can = can_options();
    all.insert(all.end(), can.begin(), can.end());
    const std::span<const Option> watch = watch_options();
    all.insert(all.end(), watch.begin(), watch.end());
    const std::span<const Option> gap = gap_options();
    all.insert(all.end(), gap.begin(), gap.end());
    const std::span<const Option> history = history_options();
    all.insert(all.end(), history.begin(), history.end());
    const std::span<const Option> actions = action_options();
    all.insert(all.end(), actions.begin(), actions.end());
    const std::span<const Option> scenario = scenario_options();
    all.insert(all.end(), scenario.begin(), scenario.end());
    const std::span<const Option> effect = effect_options();
    all.insert(all.end(), effect.begin(), effect.end());
    const std::span<const Option> expectation = expectation_options();
    all.insert(all.end(), expectation.begin(), expectation.end());
    return all;
  }();
  return kAll;
}

const Option* find_option(std::string_view section, std::string_view key) {
  const std::span<const Option> all = options();
  const auto at = std::find_if(all.begin(), all.end(), [&](const Option& o) {
    return o.section == section && o.key == key;
  });
  return at == all.end() ? nullptr : &*at;
}

std::vector<std::string> choices(const Option& option) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  while (begin < option.choices.size()) {
    const std::size_t end = std::min(option.choices.find('|', begin), option.choices.size());
    out.emplace_back(option.choices.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

std::string constraint(const Option& option) {
  if (!option.choices.empty()) {
    std::string list;
    for (const std::string& choice : choices(option))
      list += (list.empty() ? "\"" : ", \"") + choice + "\"";
    return "one of " + list;
  }
  std::string rule;
  if (option.min > -kUnlimited)
    rule = fmt::format("{} {:.10g}", option.above_min ? ">" : ">=", option.min);
  if (option.max < kUnlimited)
    rule += fmt::format("{}<= {:.10g}", rule.empty() ? "" : " and ", option.max);
  if (!rule.empty() && !option.unit.empty()) rule += fmt::format(" {}", option.unit);
  return rule;
}

std::string expected(const Option& option) {
  const std::string unit = option.unit.empty() ? "" : fmt::format(" ({})", option.unit);
  switch (option.type) {
    case text:
      return "a text in quotes";
    case choice:
      return constraint(option);
    case integer:
      return "a whole number" + unit;
    case number:
      return "a number" + unit;
    case boolean:
      return "true or false";
    case texts:
      return "a list of texts";
    case grid:
      return fmt::format("a number{} or {}", unit, option.shape);
    case table:
      return "a table";
  }
  return "";
}

}  // namespace framewatch::daemon
