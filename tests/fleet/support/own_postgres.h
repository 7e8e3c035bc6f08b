// SPDX-License-Identifier: MIT
#pragma once

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "fleet/store/database.h"

namespace framewatch::fleet {

/// A PostgreSQL of this process on a Unix socket in a temporary folder. Ends with the process. If
/// FRAMEWATCH_POSTGRES names one, that one is emptied and used.
class OwnPostgres {
 public:
  static OwnPostgres& instance() {
    static OwnPostgres one;
    return one;
  }
  const std::string& where() const { return where_; }
  /// Returns the problem; empty if it runs.
  const std::string& why_not() const { return why_not_; }

 private:
  OwnPostgres() {
    if (const char* given = std::getenv("FRAMEWATCH_POSTGRES")) {
      where_ = given;
      return;
    }
    const std::string bin = newest_bin();
    if (bin.empty()) {
      why_not_ = "no PostgreSQL (deploy/install-deps --with fleet)";
      return;
    }
    char folder[] = "/tmp/fw-pg-XXXXXX";
    if (::mkdtemp(folder) == nullptr) {
      why_not_ = "no temporary folder";
      return;
    }
    folder_ = folder;
    // The server refuses root, also one of a namespace.
    as_user_ = ::geteuid() == 0 ? "unshare -U --map-user=1000 --map-group=1000 " : "";
    const std::string made =
        fmt::format("{}{}/initdb -D {}/data -A trust -U fleet --no-sync >{}/log 2>&1", as_user_,
                    bin, folder_, folder_);
    if (std::system(made.c_str()) != 0) {
      why_not_ = "initdb does not work here: " + made;
      return;
    }
    start(bin);
  }
  ~OwnPostgres() {
    if (child_ > 0) {
      ::kill(child_, SIGQUIT);
      ::waitpid(child_, nullptr, 0);
    }
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
  }
  static std::string newest_bin() {
    std::string out;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator("/usr/lib/postgresql", none))
      if (std::filesystem::exists(entry.path() / "bin/postgres")) out = entry.path() / "bin";
    return out;
  }
  void start(const std::string& bin) {
    const std::string command = fmt::format(
        "exec {}{}/postgres -D {}/data -k {} -c listen_addresses= -c fsync=off >>{}/log 2>&1",
        as_user_, bin, folder_, folder_, folder_);
    child_ = ::fork();
    if (child_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGQUIT);
      ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
      ::_exit(127);
    }
    where_ = fmt::format("host={} user=fleet dbname=postgres", folder_);
    Database look;
    for (int i = 0; i < 600 && !look.open(where_); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (!look.is_open()) why_not_ = "PostgreSQL does not begin: " + look.error();
  }

  std::string where_, why_not_, folder_, as_user_;
  pid_t child_ = -1;
};

/// Starts with an empty database.
class OnPostgres : public testing::Test {
 protected:
  void SetUp() override {
    OwnPostgres& server = OwnPostgres::instance();
    if (!server.why_not().empty()) GTEST_SKIP() << server.why_not();
    where_ = server.where();
    ASSERT_TRUE(look_.open(where_)) << look_.error();
    ASSERT_TRUE(look_.execute("DROP SCHEMA public CASCADE; CREATE SCHEMA public")) << look_.error();
  }

  std::string where_;
  Database look_;
};

}  // namespace framewatch::fleet
