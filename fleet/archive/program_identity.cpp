#include "fleet/archive/program_identity.h"

#include <elf.h>
#include <link.h>

#include <cstddef>
#include <cstring>
#include <string_view>

#include "daemon/base/file_digest.h"

namespace framewatch::fleet {
namespace {

constexpr std::size_t aligned(std::size_t size) {
  return (size + 3) / 4 * 4;
}

/// The build id among the notes of a segment.
std::string_view build_id_in(const char* at, std::size_t size) {
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note{};
    std::memcpy(&note, at, sizeof(note));
    const std::size_t name = sizeof(note), content = name + aligned(note.n_namesz);
    const std::size_t end = content + aligned(note.n_descsz);
    if (end > size) return {};
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == sizeof(ELF_NOTE_GNU) &&
        std::memcmp(at + name, ELF_NOTE_GNU, sizeof(ELF_NOTE_GNU)) == 0)
      return {at + content, note.n_descsz};
    at += end;
    size -= end;
  }
  return {};
}

/// The first object is the program itself.
int look(dl_phdr_info* info, std::size_t, void* out) {
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = info->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    const auto* const begin = reinterpret_cast<const char*>(info->dlpi_addr + segment.p_vaddr);
    const std::string_view id = build_id_in(begin, segment.p_memsz);
    if (!id.empty()) *static_cast<std::string*>(out) = id;
  }
  return 1;
}

}  // namespace

std::string program_identity() {
  static const std::string identity = [] {
    std::string id;
    ::dl_iterate_phdr(&look, &id);
    return id.empty() ? daemon::sha256_of_file("/proc/self/exe")
                      : daemon::sha256(FRAMEWATCH_VERSION " " + id);
  }();
  return identity;
}

}  // namespace framewatch::fleet
