#include "daemon/base/file_digest.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

#include <fmt/core.h>
#include <glib.h>

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxBytes = 16 << 20;

}  // namespace

std::optional<std::string> read_text_file(const std::string& path, std::string& error) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    error = "is a directory, not a file";
    return std::nullopt;
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    error = fmt::format("cannot be read: {}", std::strerror(errno));
    return std::nullopt;
  }
  std::string text(kMaxBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad() || text.size() > kMaxBytes) {
    error = file.bad() ? "reading failed" : "is larger than 16 MiB";
    return std::nullopt;
  }
  return text;
}

std::string sha256(const std::string& bytes) {
  const std::unique_ptr<gchar, decltype(&g_free)> digest(
      g_compute_checksum_for_data(G_CHECKSUM_SHA256, reinterpret_cast<const guchar*>(bytes.data()),
                                  bytes.size()),
      &g_free);
  return digest.get();
}

std::string sha256_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  const std::unique_ptr<GChecksum, decltype(&g_checksum_free)> sum(
      g_checksum_new(G_CHECKSUM_SHA256), &g_checksum_free);
  std::string part(1 << 20, '\0');
  while (file) {
    file.read(part.data(), static_cast<std::streamsize>(part.size()));
    g_checksum_update(sum.get(), reinterpret_cast<const guchar*>(part.data()), file.gcount());
  }
  return file.bad() ? std::string() : g_checksum_get_string(sum.get());
}

}  // namespace framewatch::daemon
