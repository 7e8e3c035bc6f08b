#include "drivers/files/zstd_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "drivers/files/input_file.h"
#include "drivers/files/partial_file.h"
#include "drivers/files/unpack_limit.h"

namespace framewatch::drivers {
namespace {

int unnamed_file() {
  std::error_code none;
  std::filesystem::path folder = std::filesystem::temp_directory_path(none);
  if (none) folder = "/tmp";
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
  std::string name =
      (folder / "framewatch-XXXXXX").string();  // not every file system has O_TMPFILE
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

bool write_all(int file, const std::uint8_t* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(file, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
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

/// False, with errno, when something of `in` could not be read or written.
bool pack(int in, int out, const std::atomic<bool>& stop) {
  constexpr int kLevel = 3;  // -19 buys a tenth for forty times the time
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
      if (!write_all(out, packed.data(), output.pos)) return false;
      done = last ? left == 0 : input.pos == input.size;
    }
  }
  return true;
}

}  // namespace

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
  if (out.file < 0) return failed(out, "no temporary file to unpack to");
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kUnpackMemoryLog2);
  struct stat status {};
  if (::fstat(file, &status) != 0) return failed(out, "cannot be read");
  const std::int64_t most_bytes = unpack_limit(status.st_size);
  std::vector<std::uint8_t> packed(ZSTD_DStreamInSize()), plain(ZSTD_DStreamOutSize());
  std::int64_t read_bytes = 0;
  std::size_t wanted = 1;  // 0: a frame is whole
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
      if (!write_all(out.file, plain.data(), output.pos))
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
