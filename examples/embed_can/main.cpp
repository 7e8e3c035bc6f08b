// SPDX-License-Identifier: MIT
// Reads the accelerometers of a one-story building from a CAN interface and prints estimates. Node
// 1 is on the base, node 2 on the roof. A node sends a frame of id 0x180 + node every 10 ms. The
// first two bytes are the acceleration along x, a little-endian int16 in 0.001 m/s^2. The time of a
// sample is the kernel's receive stamp, rounded to 10 ms.
//
// g++ -std=c++20 -O2 main.cpp $(pkg-config --cflags --libs framewatch) -o embed_can
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <linux/sockios.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include <framewatch/estimator/pipeline/pipeline.h>

namespace fw = framewatch::estimator;

int failed(const char* interface, const char* what) {
  std::fprintf(stderr, "embed_can: %s: %s: %s\n", interface, what, std::strerror(errno));
  return 1;
}

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "usage: embed_can INTERFACE\n"), 2;
  const char* interface = arguments[1];
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface));
  if (address.can_ifindex == 0) return failed(interface, "there is no such interface");
  const int bus = socket(PF_CAN, SOCK_RAW, CAN_RAW);
  if (bus < 0) return failed(interface, "this kernel has no raw CAN sockets");
  const can_filter nodes[] = {{0x181, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG},
                              {0x182, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG}};
  if (setsockopt(bus, SOL_CAN_RAW, CAN_RAW_FILTER, nodes, sizeof nodes) != 0 ||
      bind(bus, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return failed(interface, "it is not a CAN interface");

  fw::PipelineConfig config;
  config.structure.stories = 1;
  config.structure.frames_x = {"y1"};
  config.structure.story_height = {3.0};  // m
  config.structure.node_mass = {1000.0};  // kg
  config.axes = {{.name = "base"}, {.name = "roof", .story = 1, .frame = 0}};
  config.options.hop_s = 1;  // one estimate per second
  fw::Pipeline pipeline(config);
  for (can_frame frame; read(bus, &frame, sizeof frame) == sizeof frame;) {
    timeval stamp{};
    if (frame.can_dlc < 2 || ioctl(bus, SIOCGSTAMP, &stamp) != 0) continue;
    const std::int64_t tick =
        (std::int64_t{stamp.tv_sec} * 1'000'000 + stamp.tv_usec + 5000) / 10'000;
    const int axis = frame.can_id == 0x181 ? 0 : 1;
    const double accel = 0.001 * static_cast<std::int16_t>(frame.data[0] | frame.data[1] << 8);
    fw::each_main_window(pipeline.push({fw::from_microseconds(10'000 * tick), axis, accel}),
                         [&](const fw::WindowEstimate& estimate) {
                           if (estimate.status != fw::WindowStatus::valid) return;
                           std::printf("stiffness %.0f N/m, damping %.0f N*s/m\n",
                                       estimate.value[0], estimate.value[1]);
                         });
  }
  return failed(interface, "reading stopped");
}
