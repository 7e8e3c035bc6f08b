#include "drivers/files/file_window.h"

#include <algorithm>

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kBufferBytes = 1 << 20;

}  // namespace

const std::uint8_t* FileWindow::at(std::int64_t offset, std::int64_t bytes, std::string& error) {
  if (holds(offset, bytes)) return buffer_.data() + (offset - begin_);
  const std::int64_t wanted = std::min(std::max(bytes, kBufferBytes), file_.size() - offset);
  if (std::ssize(buffer_) < wanted) buffer_.resize(static_cast<std::size_t>(wanted));
  begin_ = offset;
  held_ = std::max<std::int64_t>(0, file_.read(buffer_.data(), wanted, offset));
  bytes_read_ += held_;
  if (held_ == wanted) return buffer_.data();
  error = file_.error().empty() ? "became shorter while it was read" : file_.error();
  held_ = 0;
  return nullptr;
}

}  // namespace framewatch::drivers
