#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "drivers/lcm/lcm_log.h"

namespace framewatch::drivers {
namespace {

constexpr std::size_t kHeaderBytes = 28;
constexpr std::size_t kBufferBytes = 1 << 18;

template <typename Integer>
std::uint8_t* put_big_endian(std::uint8_t* out, Integer value) {
  for (int shift = 8 * static_cast<int>(sizeof value) - 8; shift >= 0; shift -= 8)
    *out++ = static_cast<std::uint8_t>(value >> shift);
  return out;
}

std::array<std::uint8_t, kHeaderBytes> header_of(std::int64_t number, std::int64_t timestamp_us,
                                                 std::size_t channel_bytes, std::size_t size) {
  std::array<std::uint8_t, kHeaderBytes> header{};
  std::uint8_t* out = put_big_endian(header.data(), std::uint32_t{0xEDA1DA01});
  out = put_big_endian(out, number);
  out = put_big_endian(out, timestamp_us);
  out = put_big_endian(out, static_cast<std::int32_t>(channel_bytes));
  put_big_endian(out, static_cast<std::int32_t>(size));
  return header;
}

}  // namespace

void append_log_event(std::string& out, std::int64_t number, std::int64_t timestamp_us,
                      std::string_view channel, const void* data, std::size_t size) {
  const auto header = header_of(number, timestamp_us, channel.size(), size);
  out.append(header.begin(), header.end());
  out += channel;
  out.append(static_cast<const char*>(data), size);
}

LcmLogWriter::~LcmLogWriter() {
  discard();
}

bool LcmLogWriter::open(const std::string& path) {
  discard();
  number_ = 0;
  error_.clear();
  if (partial_.open(path)) file_ = partial_.stream();
  if (file_ == nullptr) {
    error_ = partial_.error();
    partial_.discard();
    return false;
  }
  // With a buffer of its own making glibc ignores the size.
  buffer_.resize(kBufferBytes);
  std::setvbuf(file_, buffer_.data(), _IOFBF, buffer_.size());
  return true;
}

bool LcmLogWriter::copy(const LogEvent& event) {
  number_ = event.number;
  return write(event.timestamp_us, event.channel, event.data.data(), event.data.size());
}

bool LcmLogWriter::write(std::int64_t timestamp_us, const std::string& channel, const void* data,
                         std::size_t size) {
  if (file_ == nullptr || !error_.empty()) return false;
  if (channel.empty() || channel.size() > LcmLogReader::kMaxChannel) {
    error_ = "channel name must have 1 to 63 bytes";
    return false;
  }
  if (size > LcmLogReader::kMaxPayload) {
    error_ = "payload is larger than 16 MiB";
    return false;
  }
  const auto header = header_of(number_, timestamp_us, channel.size(), size);
  if (std::fwrite(header.data(), 1, header.size(), file_) != header.size() ||
      std::fwrite(channel.data(), 1, channel.size(), file_) != channel.size() ||
      (size > 0 && std::fwrite(data, 1, size, file_) != size)) {
    error_ = std::strerror(errno);
    return false;
  }
  ++number_;
  return true;
}

bool LcmLogWriter::close() {
  if (file_ == nullptr) return false;
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (error_.empty() && !closed) error_ = std::strerror(errno);
  if (error_.empty() && !partial_.commit()) error_ = partial_.error();
  discard();
  return error_.empty();
}

void LcmLogWriter::discard() {
  if (file_ != nullptr) std::fclose(std::exchange(file_, nullptr));
  partial_.discard();
}

}  // namespace framewatch::drivers
