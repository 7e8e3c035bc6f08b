// SPDX-License-Identifier: MIT
#include "tests/fuzz/scratch.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/fuzz/input.h"

namespace framewatch::test {

const std::string& scratch_folder() {
  static const std::string folder = [] {
    const auto path =
        std::filesystem::temp_directory_path() / ("framewatch-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directories(path);
    return path.string();
  }();
  return folder;
}

void write_scratch_file(const std::string& path, const void* data, std::size_t size) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  require(file.good(), path.c_str());
}

}  // namespace framewatch::test
