// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fleet/uplink/send_window.h"
#include "fleet/uplink/sent_store.h"

namespace framewatch::fleet {

/// Exports raw samples into a file in the background, one at a time.
class RawExporter {
 public:
  virtual ~RawExporter() = default;
  /// Starts an export. Returns an empty text, or the problem.
  virtual std::string begin(const RawRequest& request, const std::string& path) = 0;
  /// Returns nullopt while the export runs, then its problem or an empty text.
  virtual std::optional<std::string> ended() = 0;
};

/// Sends the raw samples that the hub requested, piece by piece, at no more than raw_kbit_s. Does
/// not send acknowledged pieces again, even after a restart. When there is nothing to send, a piece
/// 0 of 0 has the reason.
class RawSender {
 public:
  static constexpr std::int64_t kPiece_bytes = 128 * 1024, kRefused_us = 60'000'000;
  static constexpr std::size_t kUnderWay = 4;

  /// directory: for the files while they are sent. `store` must outlive this.
  RawSender(std::string directory, std::string building, double kbit_s, SentStore& store,
            std::unique_ptr<RawExporter> exporter);

  /// Returns the next piece, or nullopt if no piece may be sent now. steady_us: monotonic clock.
  std::optional<Outgoing> next(std::int64_t steady_us, const std::string& config_sha256,
                               const SendWindow& window);
  /// Notes that the hub has this piece.
  void acknowledged(const Outgoing& piece);
  /// Returns the pieces of the current request that are not acknowledged.
  std::int64_t waiting() const;
  /// Returns why the newest request failed; empty if it did not.
  const std::string& trouble() const { return trouble_; }

 private:
  enum class State { idle, exporting, sending, giving_up };
  void begin();
  void begin_sending();
  void give_up(const std::string& why);
  void finish(const std::string& outcome);
  std::optional<Outgoing> piece(std::int64_t number, const std::string& config_sha256);

  std::string directory_, building_;
  double bytes_us_;  ///< allowed bytes per microsecond
  SentStore& store_;
  std::unique_ptr<RawExporter> exporter_;
  State state_ = State::idle;
  RawRequest request_;
  std::string path_, trouble_;
  std::string why_none_;    ///< while giving up
  std::vector<bool> done_;  ///< by piece
  std::int64_t next_us_ = INT64_MIN, look_us_ = INT64_MIN;
};

/// Returns an exporter that runs `framewatch history`, the program in the same folder. config: the
/// configuration file.
std::unique_ptr<RawExporter> history_exporter(std::string config);

}  // namespace framewatch::fleet
