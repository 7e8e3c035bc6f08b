// SPDX-License-Identifier: MIT
#include "daemon/config/keys/can_options.h"

#include "daemon/config/keys/channel_options.h"
#include "daemon/config/keys/option_table.h"
#include "drivers/can/can_map.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;

const Option kChannelSourceCan[] = {
    {.key = "can",
     .required = true,
     .meaning = "Interface of a [[can]] table.",
     .target = into<&AxisSource::can>},
    {.key = "dbc_signal",
     .required = true,
     .meaning = "Message.Signal of the DBC files; set scale to convert to m/s^2. # is the sample "
                "number in frames with several: \"Block.AccX_#\".",
     .target = into<&AxisSource::dbc_signal>},
    {.key = "can_node",
     .default_value = "\"\"",
     .meaning = "The [[can_node]] that sends it; required if several have the message. Without "
                "any, samples are timed by arrival.",
     .target = into<&AxisSource::can_node>},
};

const Option kCan[] = {
    {.key = "interface",
     .required = true,
     .meaning = "CAN interface, such as can0.",
     .target = into<&drivers::CanBusMap::interface>},
    {.key = "dbc",
     .type = texts,
     .required = true,
     .meaning = "DBC files, relative to this file.",
     .by_hand = "the files are read"},
    {.key = "fd",
     .meaning = "Whether the bus carries CAN FD frames.",
     .target = into<&drivers::CanBusMap::fd>},
    {.key = "bit_rate",
     .unit = "bit/s",
     .range = {10000, 1000000},
     .meaning = "Bit rate for the load that check prints; the system sets the interface.",
     .target = into<&drivers::CanBusMap::bit_rate>},
    {.key = "data_bit_rate",
     .unit = "bit/s",
     .range = {10000, 10000000},
     .meaning = "Data bit rate of CAN FD frames.",
     .target = into<&drivers::CanBusMap::data_bit_rate>},
    {.key = "sync_id",
     .range = {1, 2047},
     .meaning = "Id of the SYNC (CANopen 1005h).",
     .target = into<&drivers::CanBusMap::sync_id>},
    {.key = "sync_period_s",
     .unit = "s",
     .default_value = "0",
     .range = {0, 3600},
     .meaning = "SYNC period (CANopen 1006h). 0: one per sample of estimator.rate_hz.",
     .by_hand = "0 stands for a period of estimator.rate_hz"},
    {.key = "sync_overflow",
     .range = {0, 240},
     .meaning = "Largest value of the SYNC's counter (CANopen 1019h). 0: no counter.",
     .target = into<&drivers::CanBusMap::sync_overflow>},
    {.key = "send_sync",
     .meaning = "Send the SYNC if no other device does.",
     .target = into<&drivers::CanBusMap::send_sync>},
    {.key = "nmt_start",
     .meaning = "Start all CANopen nodes (NMT), also when they boot later.",
     .target = into<&drivers::CanBusMap::nmt_start>},
    {.key = "receive_buffer_bytes",
     .unit = "bytes",
     .range = {4096, 1073741824},
     .meaning = "Socket buffer, 766 bytes per frame. Limited by net.core.rmem_max (deploy/can).",
     .target = into<&drivers::CanBusMap::receive_buffer_bytes>},
};

const Option kCanNode[] = {
    {.key = "name",
     .required = true,
     .meaning = "Unique name.",
     .target = into<&drivers::CanNodeMap::name>},
    {.key = "can",
     .type = text,
     .default_value = "\"\"",
     .meaning = "Interface of its bus; optional with one bus.",
     .by_hand = "the name of a [[can]]"},
    {.key = "messages",
     .required = true,
     .meaning = "DBC messages of a sample. The one with counter or clock, else the first, comes "
                "first; the others follow within half a period.",
     .target = into<&CanNodeSettings::messages>},
    {.key = "id_offset",
     .range = {0, 536870911},
     .meaning = "Added to the DBC's ids, such as a CANopen node number.",
     .target = into<&CanNodeSettings::id_offset>},
    {.key = "j1939",
     .meaning = "Match the parameter group number, whatever the priority and source address.",
     .target = into<&CanNodeSettings::j1939>},
    {.key = "source_address",
     .range = {-1, 253},
     .meaning = "J1939 source address; -1: any.",
     .target = into<&CanNodeSettings::source_address>},
    {.key = "timing",
     .choices = "sync|clock|counter|period",
     .meaning = "Sample time from the preceding SYNC, the node's clock, its counter, or arrival "
                "(period). Default: clock or counter if given, else period.",
     .by_hand = "without it the other keys decide"},
    {.key = "counter",
     .type = text,
     .default_value = "\"\"",
     .meaning = "Message.Signal of the frame counter, +1 per frame, may wrap. With timing = "
                "\"sync\" it identifies the SYNC.",
     .by_hand = "the name of a signal of the DBC files"},
    {.key = "clock",
     .type = text,
     .default_value = "\"\"",
     .meaning = "Message.Signal of the node's clock, may wrap.",
     .by_hand = "the name of a signal of the DBC files"},
    {.key = "clock_unit_s",
     .unit = "s",
     .range = above(0, 1),
     .meaning = "Unit of the clock's value after the DBC's factor.",
     .target = into<&drivers::CanNodeMap::clock_unit_us>.in(microseconds)},
    {.key = "rate_hz",
     .unit = "Hz",
     .default_value = "0",
     .range = {0, 100000},
     .meaning = "Sampling rate. 0: estimator.rate_hz. Not for timing = \"sync\".",
     .by_hand = "0 stands for estimator.rate_hz; a SYNC has its own"},
    {.key = "delay_s",
     .unit = "s",
     .range = {0, 1},
     .meaning = "From the SYNC to the sample.",
     .target = into<&drivers::CanNodeMap::delay_us>.in(microseconds)},
    {.key = "latency_s",
     .unit = "s",
     .range = {0, 1},
     .meaning = "Other timings: from the last sample to the arrival of its frame on an idle bus.",
     .target = into<&drivers::CanNodeMap::latency_us>.in(microseconds)},
    {.key = "samples_per_frame",
     .range = {1, 64},
     .meaning = "Instants per frame, oldest first.",
     .target = into<&drivers::CanNodeMap::samples_per_frame>},
    {.key = "canopen_id",
     .range = {0, 127},
     .meaning = "CANopen node number, for boot-up and emergency messages. 0: none.",
     .target = into<&drivers::CanNodeMap::canopen_id>},
};

}  // namespace

std::vector<OptionSection> can_options() {
  return {{"channel.source.can", kChannelSourceCan, Reach::restart},
          {"can", kCan, Reach::restart},
          {"can_node", kCanNode, Reach::restart}};
}

}  // namespace framewatch::daemon
