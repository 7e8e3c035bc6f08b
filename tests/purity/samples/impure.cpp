// SPDX-License-Identifier: MIT
// Everything the estimator must not do; tests/purity/symbols-check-fails expects each to be caught.
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <thread>

namespace purity {

void output(const char* text) {
  std::printf("%s %d\n", text, 1);
  std::puts(text);
  std::cout << text;
  std::cerr << text;
}

void end_process(int code) {
  if (code == 1) std::exit(code);
  if (code == 2) std::abort();
}

double clocks() {
  timespec ts{};
  timeval tv{};
  clock_gettime(CLOCK_REALTIME, &ts);
  gettimeofday(&tv, nullptr);
  return static_cast<double>(std::chrono::system_clock::now().time_since_epoch().count() +
                             std::chrono::steady_clock::now().time_since_epoch().count() +
                             std::time(nullptr) + ts.tv_sec + tv.tv_sec);
}

int outside_world(const char* path) {
  std::FILE* file = std::fopen(path, "r");
  const int descriptor = open(path, O_RDONLY) + socket(AF_INET, SOCK_DGRAM, 0);
  std::ifstream stream(path);
  return descriptor + std::rand() + (file != nullptr) + (std::getenv(path) != nullptr) +
         stream.get();
}

void wait() {
  std::this_thread::sleep_for(std::chrono::seconds(1));
  usleep(1);
}

}  // namespace purity
