#include "drivers/zstd_file.h"

#include <fcntl.h>
#include <unistd.h>
#include <zstd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include <fmt/core.h>

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

UnpackedFile failed(UnpackedFile out, const char* what) {
  out.error = fmt::format("{}: {}", what, std::strerror(errno));
  if (out.file >= 0) ::close(out.file);
  out.file = -1;
  return out;
}

}  // namespace

UnpackedFile unpack_zstd(int file) {
  UnpackedFile out;
  out.file = unnamed_file();
  if (out.file < 0) return failed(out, "no temporary file to unpack to");
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
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
      if (!write_all(out.file, plain.data(), output.pos))
        return failed(out, "cannot be unpacked to a temporary file");
      out.bytes += static_cast<std::int64_t>(output.pos);
      if (ZSTD_isError(wanted) == 0) continue;
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
