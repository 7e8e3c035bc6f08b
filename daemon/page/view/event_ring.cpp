// SPDX-License-Identifier: MIT
#include "daemon/page/view/event_ring.h"

#include <algorithm>
#include <cstring>

#include <fmt/core.h>

namespace framewatch::daemon {

std::string EventRing::text(const std::string& name, const std::string& data) {
  return "event: " + name + "\ndata: " + data + "\n\n";
}

void EventRing::push(const std::string& name, const std::string& data) {
  events_[count_++ % events_.size()] = text(name, data);
}

std::size_t EventRing::read(Cursor& cursor, char* buffer, std::size_t size) const {
  std::size_t copied = 0;
  while (copied < size) {
    if (cursor.offset == cursor.pending.size()) {
      if (cursor.next == count_) break;
      cursor.offset = 0;
      if (count_ - cursor.next > events_.size()) {
        // The oldest event will be overwritten soon too, so continue with the newest.
        const std::uint64_t lost = count_ - 1 - cursor.next;
        cursor.dropped += lost;
        cursor.next = count_ - 1;
        cursor.pending = text("dropped", fmt::format("{{\"events\":{}}}", cursor.dropped));
      } else {
        cursor.pending = events_[cursor.next++ % events_.size()];
      }
    }
    const std::size_t part = std::min(size - copied, cursor.pending.size() - cursor.offset);
    std::memcpy(buffer + copied, cursor.pending.data() + cursor.offset, part);
    cursor.offset += part;
    copied += part;
  }
  return copied;
}

}  // namespace framewatch::daemon
