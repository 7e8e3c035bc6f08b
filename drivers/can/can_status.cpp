// SPDX-License-Identifier: MIT
#include "drivers/can/can_status.h"

#include <linux/can/error.h>

namespace framewatch::drivers {

std::string to_string(CanBusState state) {
  switch (state) {
    case CanBusState::active:
      return "error-active";
    case CanBusState::warning:
      return "error-warning";
    case CanBusState::passive:
      return "error-passive";
    case CanBusState::off:
      return "bus-off";
  }
  return "";
}

void count_error_frame(const CanFrame& frame, CanBusCounters& c) {
  ++c.error_frames;
  const bool off = (frame.id & CAN_ERR_BUSOFF) != 0;
  if (off && c.state != CanBusState::off) ++c.bus_off;
  if (off) c.state = CanBusState::off;
  if ((frame.id & CAN_ERR_RESTARTED) != 0) {
    ++c.restarted;
    c.state = CanBusState::active;
  }
  if ((frame.id & (CAN_ERR_PROT | CAN_ERR_ACK | CAN_ERR_TRX | CAN_ERR_BUSERROR)) != 0)
    ++c.bus_errors;
  if ((frame.id & CAN_ERR_CRTL) == 0) return;
  const unsigned what = frame.data[1];
  if ((what & CAN_ERR_CRTL_RX_OVERFLOW) != 0) ++c.overflow;
  if ((what & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0)
    c.state = CanBusState::passive;
  else if ((what & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0)
    c.state = CanBusState::warning;
  else if ((what & CAN_ERR_CRTL_ACTIVE) != 0)
    c.state = CanBusState::active;
}

}  // namespace framewatch::drivers
