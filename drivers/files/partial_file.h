// SPDX-License-Identifier: MIT
#pragma once

#include <sys/stat.h>

#include <cstdio>
#include <string>

namespace framewatch::drivers {

/// Writes a file as PATH.partial, which commit() renames to PATH. Never follows a symbolic link.
/// open() first removes a PATH.partial that an earlier run left behind: a regular file of the same
/// user that no process is writing. It refuses anything else of that name, and a PATH that exists
/// and is not a regular file. The path "-" is standard output, once per process; bytes written go
/// there at once.
class PartialFile {
 public:
  PartialFile() = default;
  /// Calls discard().
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  /// Creates PATH.partial. Returns false and sets error() when the system refuses.
  [[nodiscard]] bool open(const std::string& path);
  bool is_open() const { return file_ >= 0; }
  /// Returns -1 when no file is open.
  int descriptor() const { return file_; }
  /// Returns a new stream on the same file, to be closed before commit(). Returns null and sets
  /// error() when the system refuses.
  [[nodiscard]] std::FILE* stream();
  /// Forces the bytes onto the disk and renames the file. Returns false and sets error() when that
  /// fails; the partial file is then removed.
  [[nodiscard]] bool commit();
  /// Removes the partial file. PATH does not change.
  void discard();
  const std::string& error() const { return error_; }

 private:
  bool make(const std::string& partial);
  bool still_ours() const;
  bool open_standard_output();
  bool fail(const std::string& why);
  void close();

  std::string path_;
  std::string error_;
  int file_ = -1;
  bool is_standard_output_ = false;
  int mark_ = -1;  ///< its place in the list of remove_partial_files(); -1: not in it
};

/// Renames PATH.partial, which an interrupted run left behind, to PATH.cut-off-N, so that the next
/// PartialFile of PATH does not remove it. Returns the new name. Returns an empty string when there
/// is no such file: a regular file of the same user, not empty, that no process is writing.
std::string keep_cut_off(const std::string& path);

/// Opens a file whose name can be guessed, such as a lock, with the flags of open(2). Refuses
/// symbolic links, pipes and devices. Returns its descriptor, or -1 with errno.
int open_own_file(const std::string& path, int flags, mode_t mode = 0644);

/// Forces the folder of `path` onto the disk, so that a new name survives a power cut.
void sync_folder_of(const std::string& path);

/// Removes the uncommitted partial files of this process and reports each on stderr. Call it in
/// signal handlers before the process ends.
void remove_partial_files();

}  // namespace framewatch::drivers
