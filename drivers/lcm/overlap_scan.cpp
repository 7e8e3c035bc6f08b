#include "drivers/lcm/overlap_scan.h"

#include <cstddef>
#include <iterator>

namespace framewatch::drivers {

void OverlapScan::clear() {
  open_.clear();
  ends_.clear();
}

void OverlapScan::add(std::int64_t start, std::int64_t end) {
  for (; !ends_.empty(); ends_.pop_back()) {
    Candidate& before = open_[static_cast<std::size_t>(ends_.back() - dropped_)];
    if (before.end >= end) break;
    before.over = start;
  }
  ends_.push_back(dropped_ + std::ssize(open_));
  open_.push_back({start, end});
}

void OverlapScan::drop_before(std::int64_t offset) {
  for (; !open_.empty() && open_.front().start < offset; ++dropped_) {
    if (!ends_.empty() && ends_.front() == dropped_) ends_.pop_front();
    open_.pop_front();
  }
}

}  // namespace framewatch::drivers
