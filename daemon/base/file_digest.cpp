// SPDX-License-Identifier: MIT
#include "daemon/base/file_digest.h"

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <vector>

#include <glib.h>

#include "drivers/files/input_file.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kMaxBytes = 16 << 20;

}  // namespace

std::optional<std::string> read_text_file(const std::string& path, std::string& error) {
  return drivers::read_whole_file(path, kMaxBytes, error);
}

std::string sha256(const std::string& bytes) {
  const std::unique_ptr<gchar, decltype(&g_free)> digest(
      g_compute_checksum_for_data(G_CHECKSUM_SHA256, reinterpret_cast<const guchar*>(bytes.data()),
                                  bytes.size()),
      &g_free);
  return digest.get();
}

std::string sha256_of_file(const std::string& path) {
  drivers::InputFile file;
  if (!file.open(path)) return {};
  const std::unique_ptr<GChecksum, decltype(&g_checksum_free)> sum(
      g_checksum_new(G_CHECKSUM_SHA256), &g_checksum_free);
  std::vector<guchar> part(std::size_t{1} << 20);
  for (std::int64_t at = 0, got = 1; got != 0; at += got) {
    got = file.read(part.data(), std::ssize(part), at);
    if (got < 0) return {};
    g_checksum_update(sum.get(), part.data(), got);
  }
  return g_checksum_get_string(sum.get());
}

}  // namespace framewatch::daemon
