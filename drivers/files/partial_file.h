#pragma once

#include <sys/stat.h>

#include <cstdio>
#include <string>

namespace framewatch::drivers {

/// A file while it is written: PATH.partial, which commit() renames to PATH when it is whole. The
/// partial file is made anew and never through a symbolic link. One that a run before left behind,
/// a plain file of the same user that no process writes, is removed first; anything else of that
/// name is refused, and so is a PATH that is there and no plain file. The path "-" is standard
/// output, once in a process: what is written goes there at once.
class PartialFile {
 public:
  PartialFile() = default;
  /// As discard().
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  [[nodiscard]] bool open(const std::string& path);
  bool is_open() const { return file_ >= 0; }
  /// -1 when it is not open.
  int descriptor() const { return file_; }
  /// A stream of its own on the same file, to be closed before commit(); null: see error().
  [[nodiscard]] std::FILE* stream();
  /// Forces what was written onto the disk and renames. False: nothing of it stays.
  [[nodiscard]] bool commit();
  /// Removes the partial file. PATH stays as it was.
  void discard();
  const std::string& error() const { return error_; }

 private:
  bool make(const std::string& partial);
  bool still_ours() const;
  bool open_standard_output();
  bool fail(const std::string& why);

  std::string path_;
  std::string error_;
  int file_ = -1;
  bool is_standard_output_ = false;
  int mark_ = -1;  ///< its place among those that remove_partial_files() removes
};

/// Opens a file of ours under a name that can be guessed, such as a lock: made when it is missing,
/// never through a symbolic link, never a pipe or a device. -1 with errno when that fails.
int open_own_file(const std::string& path, int flags, mode_t mode = 0644);

/// Forces the folder of `path` onto the disk, so that a name survives a power cut as the bytes do.
void sync_folder_of(const std::string& path);

/// Removes the partial files of this process that are not committed, and says so on stderr. For
/// signal handlers, before the process ends.
void remove_partial_files();

}  // namespace framewatch::drivers
