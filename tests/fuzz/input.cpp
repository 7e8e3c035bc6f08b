// SPDX-License-Identifier: MIT
#include "tests/fuzz/input.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace framewatch::test {

InputFile::InputFile(Bytes bytes)
    : file_(::memfd_create("fuzz", MFD_CLOEXEC)), path_("/proc/self/fd/" + std::to_string(file_)) {
  require(file_ >= 0, "a file in memory");
  require(::write(file_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
          "its bytes");
}

InputFile::~InputFile() {
  ::close(file_);
}

std::vector<std::uint8_t> changed(const std::vector<std::uint8_t>& whole, Pieces& input) {
  std::vector<std::uint8_t> out = whole;
  while (!input.empty() && !out.empty()) {
    const auto what = input.take<std::uint8_t>();
    const std::size_t at = input.take<std::uint32_t>() % out.size();
    const auto begin = out.begin() + static_cast<std::ptrdiff_t>(at);
    const std::size_t after = out.size() - at;
    switch (what % 5) {
      case 0: {  // a number of 1, 2, 4 or 8 bytes
        const Bytes value = input.take_bytes(std::size_t{1} << what / 5 % 4);
        std::copy_n(value.begin(), std::min(value.size(), after), begin);
        break;
      }
      case 1: {
        const std::size_t size = std::min<std::size_t>(input.take<std::uint16_t>(), after);
        out.erase(begin, begin + static_cast<std::ptrdiff_t>(size));
        break;
      }
      case 2: {
        const std::size_t size = std::min<std::size_t>(input.take<std::uint16_t>(), after);
        const std::vector<std::uint8_t> twice(begin, begin + static_cast<std::ptrdiff_t>(size));
        out.insert(begin, twice.begin(), twice.end());
        break;
      }
      case 3: {
        const Bytes more = input.take_bytes(input.take<std::uint8_t>());
        out.insert(begin, more.begin(), more.end());
        break;
      }
      default:
        out.resize(at);
    }
  }
  return out;
}

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

std::string repository_file(const std::string& path) {
  std::ifstream file(FRAMEWATCH_SOURCE_DIR "/" + path, std::ios::binary);
  require(file.good(), path.c_str());
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace framewatch::test
