// SPDX-License-Identifier: MIT
#include "fleet/hub/certificates.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/base/process.h"
#include "drivers/files/input_file.h"

namespace framewatch::fleet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOpenssl = "/usr/bin/openssl";
constexpr std::chrono::milliseconds kLook{5};

/// A temporary folder for files that must not be seen before they are complete.
class WorkFolder {
 public:
  explicit WorkFolder(const fs::path& beside) {
    std::string pattern = (beside / ".openssl-XXXXXX").string();
    if (::mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~WorkFolder() {
    std::error_code none;
    if (!path_.empty()) fs::remove_all(path_, none);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  bool good() const { return !path_.empty(); }
  std::string operator/(const char* name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

std::string openssl(const std::vector<std::string>& arguments) {
  std::string error;
  auto process = daemon::ChildProcess::start(arguments, error, kOpenssl, "/dev/null");
  if (!process) return fmt::format("{}: {}", kOpenssl, error);
  for (;;) {
    if (const auto status = process->ended())
      return *status == 0
                 ? ""
                 : fmt::format("openssl {} failed (status {})", arguments.front(), *status);
    std::this_thread::sleep_for(kLook);
  }
}

std::string moved(const std::string& from, const std::string& to) {
  std::error_code problem;
  fs::rename(from, to, problem);
  return problem ? fmt::format("{}: {}", to, problem.message()) : "";
}

std::string put(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
  return daemon::sha256_of_file(path).empty() ? path + ": cannot write" : "";
}

/// Runs steps one after another until one fails.
template <class... Steps>
std::string in_turn(const Steps&... steps) {
  std::string problem;
  (void)((problem = steps(), problem.empty()) && ...);
  return problem;
}

bool is_address(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return ::inet_pton(AF_INET, host.c_str(), bytes.data()) == 1 ||
         ::inet_pton(AF_INET6, host.c_str(), bytes.data()) == 1;
}

/// Returns the certificate extensions of a server, or of a client if `hosts` is empty.
std::string extensions(const std::string& name, const std::vector<std::string>& hosts) {
  std::string names;
  for (const std::string& host : hosts)
    names +=
        fmt::format("{}{}:{}", names.empty() ? "" : ",", is_address(host) ? "IP" : "DNS", host);
  if (names.empty()) names = "DNS:" + name;
  return fmt::format(
      "basicConstraints=critical,CA:FALSE\nkeyUsage=critical,digitalSignature\nsubjectAltName={}\n"
      "extendedKeyUsage={}clientAuth\n",
      names, hosts.empty() ? "" : "serverAuth,");
}

}  // namespace

bool is_host(const std::string& name) {
  return !name.empty() && name.size() <= 253 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '.' || c == '-' || c == ':';
         });
}

std::string Authority::path(const std::string& name) const {
  return (fs::path(directory_) / name).string();
}

std::string Authority::make() const {
  if (!drivers::is_absent(path("ca.key")) || !drivers::is_absent(path("ca.pem")))
    return path("ca.pem") + ": an authority exists already";
  const ::mode_t before = ::umask(077);
  const WorkFolder work(directory_);
  const std::string problem =
      !work.good()
          ? directory_ + ": cannot write"
          : in_turn(
                [&] {
                  return openssl({"req", "-x509", "-newkey", "ed25519", "-nodes", "-days",
                                  std::to_string(kAuthorityDays), "-keyout", work / "key", "-out",
                                  work / "pem", "-subj", "/O=framewatch fleet/CN=fleet authority"});
                },
                [&] { return moved(work / "key", path("ca.key")); },
                [&] { return moved(work / "pem", path("ca.pem")); });
  ::umask(before);
  return problem;
}

std::string Authority::issue(const std::string& name, const std::vector<std::string>& hosts) const {
  const ::mode_t before = ::umask(077);
  const WorkFolder work(directory_);
  const std::string problem =
      !work.good()
          ? directory_ + ": cannot write"
          : in_turn([&] { return make_request(name, work / "key", work / "csr"); },
                    [&] { return put(work / "ext", extensions(name, hosts)); },
                    [&] {
                      return openssl({"x509", "-req", "-in", work / "csr", "-CA", path("ca.pem"),
                                      "-CAkey", path("ca.key"), "-CAserial", path("ca.srl"),
                                      "-CAcreateserial", "-days", std::to_string(kDays), "-extfile",
                                      work / "ext", "-out", work / "pem"});
                    },
                    [&] { return moved(work / "key", path(name + ".key")); },
                    [&] { return moved(work / "pem", path(name + ".pem")); });
  ::umask(before);
  return problem;
}

std::string Authority::sign(const std::string& building, const std::string& request,
                            const std::string& certificate) const {
  const WorkFolder work(directory_);
  if (!work.good()) return directory_ + ": cannot write";
  if (const std::string why = drivers::why_no_file(request); !why.empty())
    return fmt::format("{}: {}", request, why);
  return in_turn(
      [&] {
        return openssl({"req", "-in", request, "-noout", "-subject", "-nameopt", "RFC2253", "-out",
                        work / "subject"});
      },
      [&] {
        std::string error;
        const auto subject = daemon::read_text_file(work / "subject", error);
        return subject == "subject=CN=" + building + "\n"
                   ? ""
                   : fmt::format("{}: its subject must be exactly CN={}", request, building);
      },
      [&] { return put(work / "ext", extensions(building, {})); },
      [&] {
        return openssl({"x509", "-req", "-in", request, "-CA", path("ca.pem"), "-CAkey",
                        path("ca.key"), "-CAserial", path("ca.srl"), "-CAcreateserial", "-days",
                        std::to_string(kDays), "-extfile", work / "ext", "-out", work / "pem"});
      },
      [&] { return moved(work / "pem", certificate); });
}

std::string make_request(const std::string& building, const std::string& key,
                         const std::string& request) {
  const ::mode_t before = ::umask(077);
  const std::string problem = openssl({"req", "-newkey", "ed25519", "-nodes", "-keyout", key,
                                       "-out", request, "-subj", "/CN=" + building});
  ::umask(before);
  return problem;
}

}  // namespace framewatch::fleet
