// SPDX-License-Identifier: MIT
#include "drivers/files/line_reader.h"

#include <algorithm>

#include <fmt/core.h>

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kReadBytes = 1 << 16;

bool is_control(char c) {
  return (c >= 0 && c < 0x20 && c != '\t') || c == 0x7f;
}

}  // namespace

LineReader::LineReader(FileProblems& problems) : problems_(problems) {
  if (!file_.open(problems.path())) fail(file_.error());
}

bool LineReader::fail(const std::string& message) {
  ended_ = true;
  buffer_.clear();
  begin_ = 0;
  problems_.add(number_, message);
  return false;
}

bool LineReader::fill() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  const std::size_t kept = buffer_.size();
  buffer_.resize(kept + static_cast<std::size_t>(kReadBytes));
  const std::int64_t got = file_.read(buffer_.data() + kept, kReadBytes);
  buffer_.resize(kept + static_cast<std::size_t>(std::max<std::int64_t>(got, 0)));
  ended_ = got < kReadBytes;
  return got >= 0 || fail(file_.error());
}

std::string LineReader::left_out_note(std::string_view what) const {
  return fmt::format("line {}: the last {} has no line end and may be cut off: left out", number_,
                     what);
}

bool LineReader::next(std::string_view& line) {
  if (!file_.is_open()) return false;
  std::size_t end = buffer_.find('\n', begin_);
  while (end == std::string::npos && !ended_) {
    if (buffer_.size() - begin_ > kMaxLineBytes) {
      ++number_;
      return fail(fmt::format("line longer than {} bytes", kMaxLineBytes));
    }
    const std::size_t scanned = buffer_.size() - begin_;
    if (!fill()) return false;
    end = buffer_.find('\n', begin_ + scanned);
  }
  if (end == std::string::npos && begin_ == buffer_.size()) return false;
  ++number_;
  line_ended_ = end != std::string::npos;
  line = std::string_view(buffer_).substr(begin_, end - begin_);
  begin_ = end == std::string::npos ? buffer_.size() : end + 1;
  if (number_ == 1 && (line.substr(0, 2) == "\xFF\xFE" || line.substr(0, 2) == "\xFE\xFF"))
    return fail("is UTF-16, which spreadsheets call Unicode text: save it as CSV UTF-8 instead");
  if (number_ == 1 && line.substr(0, 3) == "\xEF\xBB\xBF") line.remove_prefix(3);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  const auto control = std::find_if(line.begin(), line.end(), is_control);
  if (control != line.end())
    return fail(fmt::format("not a text file: byte 0x{:02x} at column {}", *control,
                            control - line.begin() + 1));
  return true;
}

}  // namespace framewatch::drivers
