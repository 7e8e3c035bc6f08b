// SPDX-License-Identifier: MIT
#include "fleet/uplink/raw_sender.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/process.h"
#include "fleet/message/address.h"

namespace framewatch::fleet {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLookForRequests_us = 1'000'000;
constexpr const char* kEnding = ".mseed";

std::int64_t size_of(const std::string& path) {
  std::error_code none;
  const auto size = fs::file_size(path, none);
  return none ? -1 : static_cast<std::int64_t>(size);
}

Bytes piece_of(const std::string& path, std::int64_t number) {
  std::ifstream file(path, std::ios::binary);
  Bytes out(static_cast<std::size_t>(RawSender::kPiece_bytes));
  file.seekg(number * RawSender::kPiece_bytes);
  file.read(reinterpret_cast<char*>(out.data()), RawSender::kPiece_bytes);
  out.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return out;
}

class HistoryExporter : public RawExporter {
 public:
  explicit HistoryExporter(std::string config) : config_(std::move(config)) {}

  std::string begin(const RawRequest& request, const std::string& path) override {
    std::error_code none;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", none);
    const auto seconds = [](std::int64_t us) {
      return fmt::format("{:.6f}", 1e-6 * static_cast<double>(us));
    };
    std::vector<std::string> arguments{"history", config_,
                                       "--from",  seconds(request.time.from_us),
                                       "--to",    seconds(request.time.to_us),
                                       "--raw",   path};
    for (const std::string& channel : request.channels) {
      arguments.emplace_back("--channel");
      arguments.push_back(channel);
    }
    std::string error;
    process_ = daemon::ChildProcess::start(std::move(arguments), error,
                                           (self.parent_path() / "framewatch").string());
    return process_ ? "" : "cannot start framewatch history: " + error;
  }

  std::optional<std::string> ended() override {
    const std::optional<int> status = process_ ? process_->ended() : std::optional<int>(1);
    if (!status) return std::nullopt;
    process_.reset();
    if (*status == 0) return "";
    return fmt::format("framewatch history found no samples, or failed (status {})", *status);
  }

 private:
  std::string config_;
  std::optional<daemon::ChildProcess> process_;
};

}  // namespace

RawSender::RawSender(std::string directory, std::string building, double kbit_s, SentStore& store,
                     std::unique_ptr<RawExporter> exporter)
    : directory_(std::move(directory)),
      building_(std::move(building)),
      bytes_us_(kbit_s * 1e3 / 8 / 1e6),
      store_(store),
      exporter_(std::move(exporter)) {}

/// Continues with a complete file from before; sends a new file from its beginning.
void RawSender::begin() {
  const std::vector<RawRequest> all = store_.raw_requests();
  if (all.empty()) return;
  request_ = all.front();
  path_ = (fs::path(directory_) / (request_.request + kEnding)).string();
  if (size_of(path_) > 0) return begin_sending();
  std::error_code none;
  fs::create_directories(directory_, none);
  if (!store_.raw_is_done(request_.request) || !store_.add_raw(request_)) return;
  if (const std::string why = exporter_->begin(request_, path_); !why.empty()) return give_up(why);
  state_ = State::exporting;
}

void RawSender::begin_sending() {
  const std::int64_t size = size_of(path_);
  if (size <= 0) return give_up("the file of raw samples is gone");
  if (size > request_.most_bytes)
    return give_up(fmt::format("the samples have {} bytes, more than the {} allowed", size,
                               request_.most_bytes));
  done_.assign(static_cast<std::size_t>((size + kPiece_bytes - 1) / kPiece_bytes), false);
  for (const std::int64_t piece : store_.pieces_acknowledged(request_.request))
    if (piece >= 0 && piece < static_cast<std::int64_t>(done_.size()))
      done_[static_cast<std::size_t>(piece)] = true;
  state_ = State::sending;
  if (std::find(done_.begin(), done_.end(), false) == done_.end()) finish("");
}

void RawSender::give_up(const std::string& why) {
  why_none_ = why;
  done_.assign(1, false);
  state_ = State::giving_up;
}

/// Ends the request. outcome: the problem; empty if all pieces arrived.
void RawSender::finish(const std::string& outcome) {
  trouble_ = outcome;
  (void)store_.conclude(request_.request,
                        outcome.empty() ? fmt::format("done: {} pieces", done_.size()) : outcome);
  if (!store_.raw_is_done(request_.request)) return;
  std::error_code none;
  fs::remove(path_, none);
  done_.clear();
  state_ = State::idle;
}

std::optional<Outgoing> RawSender::piece(std::int64_t number, const std::string& config_sha256) {
  const bool gives_up = state_ == State::giving_up;
  Bytes bytes = gives_up ? Bytes(why_none_.begin(), why_none_.end()) : piece_of(path_, number);
  if (bytes.empty()) {
    give_up("cannot read the file of raw samples");
    return std::nullopt;
  }
  Outgoing out;
  out.message = packed(up_subject(building_, "raw." + request_.request),
                       raw_key(building_, request_.request, number), gives_up ? "text" : "mseed",
                       std::move(bytes), config_sha256);
  out.message.headers[header::kPiece] = fmt::format("{}", number);
  out.message.headers[header::kPieces] = fmt::format("{}", gives_up ? 0 : done_.size());
  out.message.headers[header::kFile] = fs::path(path_).filename().string();
  out.request = request_.request;
  out.piece = number;
  return out;
}

std::optional<Outgoing> RawSender::next(std::int64_t steady_us, const std::string& config_sha256,
                                        const SendWindow& window) {
  if (state_ == State::idle && steady_us >= look_us_) {
    look_us_ = steady_us + kLookForRequests_us;
    begin();
  }
  if (state_ == State::exporting) {
    const std::optional<std::string> outcome = exporter_->ended();
    if (outcome && outcome->empty())
      begin_sending();
    else if (outcome)
      give_up(*outcome);
  }
  const bool has_pieces = state_ == State::sending || state_ == State::giving_up;
  if (!has_pieces || window.pieces() >= kUnderWay || steady_us < next_us_) return std::nullopt;
  for (std::size_t i = 0; i < done_.size(); ++i) {
    const auto number = static_cast<std::int64_t>(i);
    if (done_[i] || window.has(raw_key(building_, request_.request, number))) continue;
    auto out = piece(number, config_sha256);
    if (out)
      next_us_ = steady_us + std::llround(static_cast<double>(out->message.size()) / bytes_us_);
    return out;
  }
  return std::nullopt;
}

void RawSender::acknowledged(const Outgoing& piece) {
  if (!store_.piece_acknowledged(piece.request, piece.piece)) return;
  if (piece.request != request_.request) return;
  if (state_ == State::giving_up) return finish(why_none_);
  if (state_ != State::sending) return;
  if (const auto at = static_cast<std::size_t>(piece.piece); at < done_.size()) done_[at] = true;
  if (std::find(done_.begin(), done_.end(), false) == done_.end()) finish("");
}

std::int64_t RawSender::waiting() const {
  return std::count(done_.begin(), done_.end(), false);
}

std::unique_ptr<RawExporter> history_exporter(std::string config) {
  return std::make_unique<HistoryExporter>(std::move(config));
}

}  // namespace framewatch::fleet
