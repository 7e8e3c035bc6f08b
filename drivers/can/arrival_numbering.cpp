// SPDX-License-Identifier: MIT
#include "drivers/can/arrival_numbering.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace framewatch::drivers {
namespace {

constexpr double kOnTime = 0.25;         ///< periods after it is due
constexpr int kEndOfPause = 2;           ///< frames on time that end a pause
constexpr std::size_t kMaxWaiting = 64;  ///< frames
constexpr double kNextTolerance = 0.5;   ///< periods by which the next frame may seem early
constexpr double kGridTolerance = 0.05;

}  // namespace

void ArrivalNumbering::add(double since, double tolerance) {
  auto latest = static_cast<std::int64_t>(std::floor(since + tolerance));
  const std::int64_t before = frames_.empty() ? 0 : frames_.back().latest;
  const bool alone = latest > before;
  bool repeated = false;
  if (latest <= different_) {
    // All numbers are taken: its due time is uncertain, or it came twice.
    repeated = since + kNextTolerance < static_cast<double>(different_ + 1);
    latest = repeated ? before : different_ + 1;
  }
  if (frames_.empty() && latest <= 1) unambiguous_ = true;
  const bool on_time = alone && since - static_cast<double>(latest) < kOnTime;
  on_time_ = on_time && !frames_.empty() ? on_time_ + 1 : 0;
  frames_.push_back({latest, repeated});
  different_ += !repeated;
  unambiguous_ = unambiguous_ || on_time_ >= kEndOfPause || frames_.size() >= kMaxWaiting;
}

bool ArrivalNumbering::confirm(std::int64_t number) {
  if (frames_.empty() || number > frames_.back().latest || number < different_) return false;
  frames_.back().latest = number;
  unambiguous_ = true;
  return true;
}

std::vector<std::int64_t> ArrivalNumbering::assign_numbers() {
  std::vector<std::int64_t> numbers(frames_.size());
  std::int64_t after = INT64_MAX;
  for (std::size_t i = frames_.size(); i-- > 0;) {
    if (frames_[i].repeated) continue;
    numbers[i] = std::min(frames_[i].latest, after - 1);
    after = numbers[i];
  }
  for (std::size_t i = 0; i < frames_.size(); ++i)
    if (frames_[i].repeated) numbers[i] = i == 0 ? 0 : numbers[i - 1];
  *this = {};
  return numbers;
}

std::vector<std::int64_t> first_numbers(const std::vector<double>& arrivals) {
  std::vector<std::int64_t> best;
  double least = std::numeric_limits<double>::infinity();
  for (const double due : arrivals) {
    std::vector<std::int64_t> numbers;
    for (const double at : arrivals)
      numbers.push_back(static_cast<std::int64_t>(std::floor(at - due + kGridTolerance)));
    for (std::size_t i = numbers.size(); i-- > 1;)
      numbers[i - 1] = std::min(numbers[i - 1], numbers[i] - 1);
    double late = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      late += arrivals[i] - due - static_cast<double>(numbers[i]);
    if (late >= least) continue;
    least = late;
    best = std::move(numbers);
  }
  const std::int64_t first = best.empty() ? 0 : best.front();
  for (std::int64_t& number : best) number -= first;
  return best;
}

}  // namespace framewatch::drivers
