#include "daemon/estimation/state_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "drivers/base/input_file.h"
#include "drivers/base/partial_file.h"

namespace framewatch::daemon {
namespace {

const std::string kMagic = "framewatch state\n";
constexpr std::int32_t kFormat = 15;  ///< goes up whenever archive() of any class changes
constexpr std::size_t kDigestBytes = 64;
constexpr std::int64_t kMostBytes = std::int64_t{1} << 30;

std::string digest_of(const std::vector<std::uint8_t>& bytes, std::size_t size) {
  return sha256({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
}

/// The head of the file, before the state of the estimation.
struct Head {
  std::string magic = kMagic;
  std::int32_t format = kFormat;
  std::string version = FRAMEWATCH_VERSION;
  std::string config_sha256;
  std::int64_t events_before = 0;

  template <typename Archive>
  void archive(Archive& a) {
    a(magic, format, version, config_sha256, events_before);
  }
};

std::string problem_of(const Head& head, const Config& config) {
  // Another version of the program may load it, so that an upgrade keeps the window.
  if (head.format != kFormat)
    return fmt::format("was written by framewatch {} (format {}), this is {} (format {})",
                       head.version, head.format, FRAMEWATCH_VERSION, kFormat);
  if (head.config_sha256 != config.sha256)
    return fmt::format("belongs to another configuration (sha256 {}...), {} has {}...",
                       head.config_sha256.substr(0, 12), config.path, config.sha256.substr(0, 12));
  return {};
}

}  // namespace

std::vector<std::uint8_t> state_bytes(const Config& config, Estimation& estimation,
                                      std::int64_t events_before) {
  estimator::StateWriter state;
  Head head;
  head.config_sha256 = config.sha256;
  head.events_before = events_before;
  state(head);
  estimation.save(state);
  return state.bytes();
}

std::string write_state(const std::string& path, std::vector<std::uint8_t> bytes) {
  const std::string digest = digest_of(bytes, bytes.size());
  bytes.insert(bytes.end(), digest.begin(), digest.end());
  drivers::PartialFile file;
  if (!file.open(path)) return file.error();
  std::size_t at = 0;
  ssize_t written = 0;
  while (at < bytes.size() && written >= 0) {
    written = ::write(file.descriptor(), bytes.data() + at, bytes.size() - at);
    if (written < 0 && errno == EINTR) written = 0;
    if (written > 0) at += static_cast<std::size_t>(written);
  }
  if (at < bytes.size()) return std::strerror(errno);
  return file.commit() ? "" : file.error();
}

LoadedState load_state(const std::string& path, const Config& config, Estimation& estimation,
                       bool& touched) {
  touched = false;
  std::string unread;
  const std::optional<std::string> text = drivers::read_whole_file(path, kMostBytes, unread);
  if (!text) return {unread, 0};
  const std::vector<std::uint8_t> bytes{text->begin(), text->end()};
  estimator::StateReader reader(bytes);
  Head head;
  head.magic.clear();
  reader(head.magic);
  if (head.magic != kMagic) return {"is no state of framewatch", 0};
  const std::size_t size = bytes.size() < kDigestBytes ? 0 : bytes.size() - kDigestBytes;
  if (digest_of(bytes, size) != std::string(bytes.begin() + std::ptrdiff_t(size), bytes.end()))
    return {"is damaged or cut off: its digest is another", 0};
  const std::vector<std::uint8_t> content(bytes.begin(), bytes.begin() + std::ptrdiff_t(size));
  estimator::StateReader state(content);
  state(head);
  if (const std::string problem = problem_of(head, config); !problem.empty()) return {problem, 0};
  touched = true;
  if (!estimation.load(state) || !state.whole())
    return {"does not fit this program: its parts have other sizes or impossible numbers", 0};
  return {"", head.events_before};
}

}  // namespace framewatch::daemon
