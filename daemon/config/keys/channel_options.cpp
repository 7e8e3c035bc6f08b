// SPDX-License-Identifier: MIT
#include "daemon/config/keys/channel_options.h"

#include "daemon/config/keys/option_table.h"
#include "estimator/structure/sensors.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;
using enum Reach;

constexpr std::string_view kForce = "the field of an accelerometer's key, for a force";
constexpr std::string_view kPlace = "story, frame and direction decide the place together";

const Option kChannel[] = {
    {.key = "name",
     .required = true,
     .meaning = "Unique name.",
     .target = into<&estimator::SensorAxis::name>},
    {.key = "story",
     .type = integer,
     .required = true,
     .range = {0, 1000},
     .meaning = "Floor of the sensor; 0 is the base.",
     .by_hand = kPlace},
    {.key = "frame",
     .type = text,
     .meaning = "Frame along which it measures. Without one, the channel is at x_m, y_m.",
     .by_hand = kPlace},
    {.key = "direction",
     .choices = "x|y|z",
     .meaning = "Direction, if neither frame nor azimuth is given. z is upward; vertical base "
                "channels show rocking: three not in line, or two along x or y.",
     .by_hand = kPlace},
    {.key = "x_m",
     .unit = "m",
     .range = {-1e4, 1e4},
     .meaning = "Place in plan, from the first y-parallel frame. Default: the middle.",
     .by_hand = kPlace},
    {.key = "y_m",
     .unit = "m",
     .range = {-1e4, 1e4},
     .meaning = "Place in plan, from the first x-parallel frame. Default: the middle.",
     .by_hand = kPlace},
    {.key = "azimuth_deg",
     .unit = "deg",
     .range = {-360, 360},
     .meaning =
         "Compass direction of the positive axis, instead of direction. Needs azimuth_y_deg.",
     .by_hand = kPlace},
    {.key = "quantity",
     .default_value = "\"acceleration\"",
     .choices = "acceleration|force",
     .meaning = "Acceleration, or the force of a shaker or hammer in N, positive toward +x or +y "
                "(docs/force.md). With a force and without base channels, the base rests.",
     .by_hand = "decides which units the other keys have"},
    {.key = "use",
     .type = boolean,
     .default_value = "true",
     .meaning = "Whether the estimation uses it; false for a free-field sensor, for example.",
     .by_hand = "unused channels get no axis"},
    {.key = "check",
     .meaning =
         "Only compare it with its prediction from the other channels; do not identify from it.",
     .target = into<&estimator::SensorAxis::check>},
    {.key = "source",
     .type = table,
     .meaning = "Where live samples come from. Default: read from files only.",
     .by_hand = "a table with its own section"},
    {.key = "scale",
     .range = {-1e12, 1e12},
     .meaning = "Factor from raw values to m/s^2; not 0.",
     .target = into<&estimator::SensorAxis::scale>},
    {.key = "offset_mps2",
     .unit = "m/s^2",
     .range = {-1e6, 1e6},
     .meaning = "Subtracted after scaling.",
     .target = into<&estimator::SensorAxis::offset>},
    {.key = "offset_n",
     .unit = "N",
     .range = {-1e12, 1e12},
     .meaning = "Offset of a force, subtracted after scaling.",
     .by_hand = kForce},
    {.key = "polarity",
     .type = integer,
     .range = {-1, 1},
     .meaning = "1, or -1 for an axis mounted backwards.",
     .target = into<&estimator::SensorAxis::polarity>},
    {.key = "delay_s",
     .unit = "s",
     .range = {-10, 10},
     .meaning = "Subtracted from a sample's time stamp.",
     .target = into<&estimator::SensorAxis::delay>},
    {.key = "tilt_deg",
     .unit = "deg",
     .range = {-60, 60},
     .meaning = "Angle of the positive axis above the horizontal. Gravity and the smaller share of "
                "the motion are corrected.",
     .target = into<&estimator::SensorAxis::tilt>.in(radians)},
    {.key = "mount_angle_deg",
     .unit = "deg",
     .range = {-60, 60},
     .meaning = "Angle in plan between the axis and its direction, counter-clockwise from above. "
                "Needs cross_channel.",
     .target = into<&estimator::SensorAxis::mount_angle>.in(radians)},
    {.key = "cross_channel",
     .type = text,
     .meaning = "Nearest channel of the other horizontal direction.",
     .by_hand = "the name of another channel, which may stand further down"},
    {.key = "group",
     .type = text,
     .meaning = "Name of a node, cable or supply. Channels with the same name fail together, so "
                "none of them confirms what another shows. Default: the node or CAN message.",
     .target = into<&estimator::SensorAxis::group>},
    {.key = "range_mps2",
     .unit = "m/s^2",
     .range = {0, 1e6},
     .meaning =
         "Full scale. Samples at it are clipped, samples beyond 1.25 of it rejected. 0: unknown; "
         "then flat peaks show clipping, and samples over 200 m/s^2 from offset_mps2 are rejected.",
     .target = into<&estimator::SensorAxis::range>},
    {.key = "range_n",
     .unit = "N",
     .range = {0, 1e12},
     .meaning = "Full scale of a force. Default: not judged.",
     .by_hand = kForce},
    {.key = "noise_n_per_rthz",
     .unit = "N/sqrt(Hz)",
     .range = {0, 1e9},
     .meaning = "Noise density of a force sensor.",
     .by_hand = kForce},
    {.key = "noise_mps2_per_rthz",
     .unit = "m/s^2/sqrt(Hz)",
     .range = {0, 1e3},
     .meaning = "Noise density. 0: measured between 0.29 and 0.45 of the sampling rate.",
     .reload = window,
     .target = into<&estimator::SensorAxis::noise_density>},
};

const Option kChannelSource[] = {
    {.key = "lcm",
     .default_value = "\"ACCEL\"",
     .meaning = "LCM channel of the accel_t messages.",
     .target = into<&AxisSource::lcm_channel>},
    {.key = "node",
     .required = true,
     .range = {0, 2147483647},
     .meaning = "Number of the node in its messages.",
     .target = into<&AxisSource::sensor_node>},
    {.key = "axis",
     .required = true,
     .choices = "x|y|z",
     .meaning = "Axis of the node.",
     .target = into<&AxisSource::axis>},
};

}  // namespace

std::vector<OptionSection> channel_options() {
  return {{"channel", kChannel, Reach::restart},
          {"channel.source", kChannelSource, Reach::restart}};
}

}  // namespace framewatch::daemon
