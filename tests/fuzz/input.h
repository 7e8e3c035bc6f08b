// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace framewatch::test {

/// Tools that read a fuzzer's input.
using Bytes = std::span<const std::uint8_t>;

/// Reads an input piece by piece from its front. Missing pieces are 0 or empty.
class Pieces {
 public:
  explicit Pieces(Bytes bytes) : bytes_(bytes) {}

  bool empty() const { return bytes_.empty(); }
  template <typename T>
  requires std::is_arithmetic_v<T> T take() {
    T value{};
    const Bytes piece = take_bytes(sizeof value);
    if (!piece.empty()) std::memcpy(&value, piece.data(), piece.size());
    return value;
  }
  Bytes take_bytes(std::size_t most) {
    const Bytes piece = bytes_.first(std::min(most, bytes_.size()));
    bytes_ = bytes_.subspan(piece.size());
    return piece;
  }
  /// Reads a size of at most 65535 and that many bytes.
  Bytes take_block() { return take_bytes(take<std::uint16_t>()); }
  Bytes rest() { return take_bytes(bytes_.size()); }

 private:
  Bytes bytes_;
};

/// Writes an input in the format that Pieces reads.
class PiecesWriter {
 public:
  template <typename T>
  requires std::is_arithmetic_v<T> PiecesWriter& put(T value) {
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  PiecesWriter& put_bytes(Bytes bytes) {
    text_.append(bytes.begin(), bytes.end());
    return *this;
  }
  PiecesWriter& put_block(Bytes bytes) {
    return put(static_cast<std::uint16_t>(bytes.size())).put_bytes(bytes);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

inline std::string text_of(Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}
inline std::vector<std::uint8_t> copy_of(Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}

/// Bytes as a regular file, in memory.
class InputFile {
 public:
  explicit InputFile(Bytes bytes);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  int file_;
  std::string path_;
};

/// Returns `whole` with the changes that an input requests: numbers replaced, bytes removed,
/// doubled and inserted. So the result is almost valid, in the format that this program writes
/// today.
std::vector<std::uint8_t> changed(const std::vector<std::uint8_t>& whole, Pieces& input);

/// Ends the program unless `holds`, which the fuzzer reports as a finding.
void require(bool holds, const char* what);

/// Returns the content of a file of the repository.
std::string repository_file(const std::string& path);

}  // namespace framewatch::test
