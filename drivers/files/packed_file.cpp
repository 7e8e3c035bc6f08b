// SPDX-License-Identifier: MIT
#include "drivers/files/packed_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "drivers/files/descriptor.h"
#include "drivers/files/input_file.h"
#include "drivers/files/partial_file.h"

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kMaxOfGzread = std::int64_t{1} << 20;

/// Returns a temporary file without a name, or -1.
int unnamed_file() {
  std::error_code none;
  std::filesystem::path folder = std::filesystem::temp_directory_path(none);
  if (none) folder = "/tmp";
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
  // Not every file system has O_TMPFILE.
  std::string name = (folder / "framewatch-XXXXXX").string();
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

UnpackedFile refused(UnpackedFile out, std::string why) {
  out.error = std::move(why);
  if (out.file >= 0) ::close(out.file);
  out.file = -1;
  return out;
}

UnpackedFile failed(UnpackedFile out, const char* what) {
  return refused(std::move(out), fmt::format("{}: {}", what, std::strerror(errno)));
}

/// Compresses `in` into `out`. Returns false with errno when reading, writing or memory fails.
bool pack(int in, int out, const std::atomic<bool>& stop) {
  constexpr int kLevel = 3;  // level 19 saves a tenth and takes forty times as long
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                     &ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::vector<std::uint8_t> plain(ZSTD_CStreamInSize()), packed(ZSTD_CStreamOutSize());
  for (bool last = false; !last;) {
    if (stop) {
      errno = ECANCELED;
      return false;
    }
    const ssize_t got = ::read(in, plain.data(), plain.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    last = got == 0;
    ZSTD_inBuffer input{plain.data(), static_cast<std::size_t>(got), 0};
    for (bool done = false; !done;) {
      ZSTD_outBuffer output{packed.data(), packed.size(), 0};
      const std::size_t left =
          ZSTD_compressStream2(context.get(), &output, &input, last ? ZSTD_e_end : ZSTD_e_continue);
      if (ZSTD_isError(left) != 0) {
        errno = ENOMEM;
        return false;
      }
      if (!write_fully(out, packed.data(), output.pos)) return false;
      done = last ? left == 0 : input.pos == input.size;
    }
  }
  return true;
}

}  // namespace

GzipInput::~GzipInput() {
  if (file_ != nullptr) gzclose(file_);
}

bool GzipInput::open(const std::string& path) {
  InputFile input;
  if (!input.open(path)) {
    error_ = "cannot be opened: " + input.error();
    return false;
  }
  packed_bytes_ = input.size();
  file_ = gzdopen(input.release(), "rb");
  if (file_ == nullptr) error_ = "cannot be opened: out of memory";
  return file_ != nullptr;
}

std::int64_t GzipInput::read(void* to, std::int64_t bytes) {
  std::int64_t done = 0;
  while (file_ != nullptr && error_.empty() && done < bytes) {
    errno = 0;
    const std::int64_t wanted = std::min(bytes - done, kMaxOfGzread);
    const z_off_t before = gzoffset(file_);
    const int got = gzread(file_, static_cast<char*>(to) + done, static_cast<unsigned int>(wanted));
    count_bytes_read(gzoffset(file_) - before);
    done += std::max(got, 0);
    unpacked_bytes_ += std::max(got, 0);
    if (gzdirect(file_) == 0 && unpacked_bytes_ > unpack_limit(packed_bytes_)) {
      error_ = over_unpack_limit(packed_bytes_);
    } else if (got < wanted) {
      int code = Z_OK;
      const char* text = gzerror(file_, &code);
      if (code == Z_BUF_ERROR)
        error_ = "the gzip stream is cut off";
      else if (code == Z_ERRNO)
        error_ = fmt::format("cannot be read: {}", std::strerror(errno));
      else if (code != Z_OK && code != Z_STREAM_END)
        error_ = fmt::format("the gzip stream is damaged: {}", text);
      break;
    }
  }
  return error_.empty() ? done : -1;
}

std::string pack_zstd(const std::string& from, const std::string& to,
                      const std::atomic<bool>& stop) {
  InputFile in;
  if (!in.open(from)) return fmt::format("{}: {}", from, in.error());
  PartialFile out;
  if (!out.open(to)) return fmt::format("{}: {}", to, out.error());
  if (!pack(in.descriptor(), out.descriptor(), stop))
    return fmt::format("{}: {}", to, std::strerror(errno));
  return out.commit() ? "" : fmt::format("{}: {}", to, out.error());
}

UnpackedFile unpack_zstd(int file) {
  UnpackedFile out;
  out.file = unnamed_file();
  if (out.file < 0) return failed(out, "cannot create a temporary file to unpack to");
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kUnpackMemoryLog2);
  struct stat status {};
  if (::fstat(file, &status) != 0) return failed(out, "cannot be read");
  const std::int64_t most_bytes = unpack_limit(status.st_size);
  std::vector<std::uint8_t> packed(ZSTD_DStreamInSize()), plain(ZSTD_DStreamOutSize());
  std::int64_t read_bytes = 0;
  std::size_t wanted = 1;  // 0: the frame is complete
  for (;;) {
    const ssize_t got = ::pread(file, packed.data(), packed.size(), read_bytes);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return failed(out, "cannot be read");
    if (got == 0) break;
    ZSTD_inBuffer input{packed.data(), static_cast<std::size_t>(got), 0};
    while (input.pos < input.size) {
      ZSTD_outBuffer output{plain.data(), plain.size(), 0};
      wanted = ZSTD_decompressStream(context.get(), &output, &input);
      out.bytes += static_cast<std::int64_t>(output.pos);
      if (out.bytes > most_bytes) return refused(out, over_unpack_limit(status.st_size));
      if (!write_fully(out.file, plain.data(), output.pos))
        return failed(out, "cannot be unpacked to a temporary file");
      if (ZSTD_isError(wanted) == 0) continue;
      if (ZSTD_getErrorCode(wanted) == ZSTD_error_frameParameter_windowTooLarge)
        return refused(out, fmt::format("needs more than {} of memory to be unpacked",
                                        size_text(std::int64_t{1} << kUnpackMemoryLog2)));
      out.damage =
          fmt::format("the zstd file is damaged near its byte {}: {}",
                      read_bytes + static_cast<std::int64_t>(input.pos), ZSTD_getErrorName(wanted));
      return out;
    }
    read_bytes += got;
  }
  if (wanted != 0) out.damage = fmt::format("the zstd file is cut off at its byte {}", read_bytes);
  return out;
}

}  // namespace framewatch::drivers
