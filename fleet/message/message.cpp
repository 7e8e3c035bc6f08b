// SPDX-License-Identifier: MIT
#include "fleet/message/message.h"

#include <utility>

#include <zstd.h>

#include <fmt/core.h>

namespace framewatch::fleet {
namespace {

constexpr std::size_t kWorthwhile = 512;  // bytes
constexpr int kLevel = 3;
constexpr const char* kZstd = "zstd";

}  // namespace

std::string Message::header(const char* name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? std::string() : found->second;
}

std::size_t Message::size() const {
  std::size_t out = subject.size() + reply.size() + bytes.size();
  for (const auto& [name, value] : headers) out += name.size() + value.size() + 4;
  return out;
}

Message packed(std::string subject, std::string key, std::string type, Bytes content,
               const std::string& config_sha256) {
  Message out;
  out.subject = std::move(subject);
  if (!key.empty()) out.headers[header::kKey] = std::move(key);
  out.headers[header::kType] = std::move(type);
  out.headers[header::kVersion] = FRAMEWATCH_VERSION;
  if (!config_sha256.empty()) out.headers[header::kConfig] = config_sha256;
  out.bytes = std::move(content);
  if (out.bytes.size() < kWorthwhile) return out;
  Bytes smaller(ZSTD_compressBound(out.bytes.size()));
  const std::size_t size =
      ZSTD_compress(smaller.data(), smaller.size(), out.bytes.data(), out.bytes.size(), kLevel);
  if (ZSTD_isError(size) != 0 || size >= out.bytes.size()) return out;
  smaller.resize(size);
  out.bytes = std::move(smaller);
  out.headers[header::kEncoding] = kZstd;
  return out;
}

std::optional<Bytes> unpacked(const Message& message, std::size_t most, std::string& why) {
  const std::string encoding = message.header(header::kEncoding);
  const auto fails = [&](std::string reason) {
    why = std::move(reason);
    return std::nullopt;
  };
  if (encoding.empty()) {
    if (message.bytes.size() > most) return fails(fmt::format("more than {} bytes", most));
    return message.bytes;
  }
  if (encoding != kZstd) return fails("unknown encoding");
  const unsigned long long size =
      ZSTD_getFrameContentSize(message.bytes.data(), message.bytes.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN)
    return fails("damaged: not zstd");
  if (size > most) return fails(fmt::format("unpacks to more than {} bytes", most));
  Bytes out(static_cast<std::size_t>(size));
  const std::size_t got =
      ZSTD_decompress(out.data(), out.size(), message.bytes.data(), message.bytes.size());
  if (ZSTD_isError(got) != 0 || got != out.size()) return fails("damaged: zstd ends too soon");
  return out;
}

}  // namespace framewatch::fleet
