#include "drivers/formats/mat_layout.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <utility>

#include "drivers/files/input_file.h"
#include "drivers/formats/mat_signature.h"

namespace framewatch::drivers {
namespace {

constexpr std::uint32_t kMatrix = 14, kCompressed = 15;
constexpr std::uint32_t kObjectClass = 3, kSparseClass = 5, kFunctionClass = 16, kOpaqueClass = 17;
constexpr int kDeepestArray = 16;
constexpr std::int64_t kMaxInflated = std::int64_t{1} << 29;
constexpr std::int64_t kInflateBytes = 1 << 16;

/// Bytes of an element in a file, or of one that was unpacked into memory.
using ReadAt = std::function<bool(void* to, std::int64_t bytes, std::int64_t at)>;

struct MatElement {
  std::uint32_t type = 0;
  std::int64_t content = 0, bytes = 0;  ///< where, and how many without the padding
  std::int64_t next = 0;
};

class MatLayout {
 public:
  MatLayout(ReadAt read, bool big_endian) : read_(std::move(read)), big_endian_(big_endian) {}

  std::optional<MatElement> element(std::int64_t at, std::int64_t end) const {
    const auto first = number(at), second = number(at + 4);
    if (at + 8 > end || !first || !second) return std::nullopt;
    MatElement out{*first, at + 8, *second, 0};
    if ((*first >> 16) != 0) out = {*first & 0xffff, at + 4, *first >> 16, at + 8};
    const bool small = out.next != 0;
    if (small && out.bytes > 4) return std::nullopt;
    if (!small) out.next = out.content + (out.type == kCompressed ? out.bytes : padded(out.bytes));
    if (out.next > end) return std::nullopt;
    return out;
  }

  /// Flags, dimensions, and what else a matrix has.
  bool is_sound(const MatElement& matrix, int depth) const {
    if (matrix.bytes == 0) return true;
    if (depth > kDeepestArray) return false;
    const std::int64_t end = matrix.content + matrix.bytes;
    const auto flags = element(matrix.content, end);
    const auto kind = flags && flags->bytes == 8 ? number(flags->content) : std::nullopt;
    if (!kind) return false;
    const std::uint32_t type = *kind & 0xff;
    const bool opaque = type == kOpaqueClass || type == kFunctionClass || type == kObjectClass;
    std::int64_t at = flags->next;
    for (int i = 0; at < end; ++i) {
      const auto part = element(at, end);
      if (!part) return false;
      if (i == 0 && !opaque && type != kSparseClass && !fits(*part, matrix.bytes)) return false;
      if (part->type == kMatrix && !is_sound(*part, depth + 1)) return false;
      at = part->next;
    }
    return true;
  }

 private:
  static std::int64_t padded(std::int64_t bytes) { return (bytes + 7) / 8 * 8; }

  std::optional<std::uint32_t> number(std::int64_t at) const {
    std::array<std::uint8_t, 4> bytes{};
    if (!read_(bytes.data(), 4, at)) return std::nullopt;
    if (!big_endian_) std::reverse(bytes.begin(), bytes.end());
    std::uint32_t out = 0;
    for (const std::uint8_t byte : bytes) out = out << 8 | byte;
    return out;
  }

  /// An array with these dimensions has no more values than bytes.
  bool fits(const MatElement& dimensions, std::int64_t bytes) const {
    std::int64_t count = 1;
    for (std::int64_t at = 0; at < dimensions.bytes; at += 4) {
      const auto size = number(dimensions.content + at);
      if (!size || at > 4 * 32) return false;
      if (__builtin_mul_overflow(count, std::int64_t{*size}, &count)) return false;
    }
    return count <= bytes;
  }

  ReadAt read_;
  bool big_endian_;
};

std::optional<std::string> inflated(InputFile& input, const MatElement& packed) {
  const std::int64_t most = std::min(kMaxInflated, unpack_limit(input.size()));
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return std::nullopt;
  std::string from(static_cast<std::size_t>(kInflateBytes), '\0'), out, to = from;
  int code = Z_OK;
  for (std::int64_t done = 0; code == Z_OK && done < packed.bytes && std::ssize(out) <= most;) {
    const std::int64_t bytes = std::min(kInflateBytes, packed.bytes - done);
    if (input.read(from.data(), bytes, packed.content + done) != bytes) break;
    done += bytes;
    stream.next_in = reinterpret_cast<Bytef*>(from.data());
    stream.avail_in = static_cast<uInt>(bytes);
    do {
      stream.next_out = reinterpret_cast<Bytef*>(to.data());
      stream.avail_out = static_cast<uInt>(kInflateBytes);
      code = inflate(&stream, Z_NO_FLUSH);
      out.append(to, 0, to.size() - stream.avail_out);
    } while (code == Z_OK && stream.avail_out == 0 && std::ssize(out) <= most);
    if (code == Z_BUF_ERROR) code = Z_OK;
  }
  inflateEnd(&stream);
  if (code != Z_STREAM_END || std::ssize(out) > most) return std::nullopt;
  return out;
}

bool is_sound_unpacked(const std::string& bytes, bool big_endian) {
  const ReadAt read = [&](void* to, std::int64_t count, std::int64_t at) {
    if (at + count > std::ssize(bytes)) return false;
    std::memcpy(to, bytes.data() + at, static_cast<std::size_t>(count));
    return true;
  };
  const MatLayout layout(read, big_endian);
  const auto matrix = layout.element(0, std::ssize(bytes));
  return matrix && matrix->type == kMatrix && layout.is_sound(*matrix, 1);
}

}  // namespace

std::optional<std::size_t> count_in_level_5(InputFile& input, bool big_endian) {
  const ReadAt read = [&](void* to, std::int64_t bytes, std::int64_t at) {
    return input.read(to, bytes, at) == bytes;
  };
  const MatLayout layout(read, big_endian);
  std::size_t count = 0;
  for (auto at = static_cast<std::int64_t>(kMatHeaderBytes); at < input.size(); ++count) {
    const auto top = layout.element(at, input.size());
    if (!top) return std::nullopt;
    if (top->type == kCompressed) {
      const auto bytes = inflated(input, *top);
      if (!bytes || !is_sound_unpacked(*bytes, big_endian)) return std::nullopt;
    } else if (top->type != kMatrix || !layout.is_sound(*top, 1)) {
      return std::nullopt;
    }
    at = top->next;
  }
  return count;
}

}  // namespace framewatch::drivers
