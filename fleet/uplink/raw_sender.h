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

/// Makes a file of raw samples beside the caller; one at a time.
class RawExporter {
 public:
  virtual ~RawExporter() = default;
  /// Begins; empty, or why not.
  virtual std::string begin(const RawRequest& request, const std::string& path) = 0;
  /// Empty while it goes on; then what went wrong, or an empty text.
  virtual std::optional<std::string> ended() = 0;
};

/// Sends raw samples that the hub asked for, piece by piece, at no more than raw_kbit_s. A piece
/// that was acknowledged is not sent again, after a restart neither. Where there is nothing to send
/// a piece 0 of 0 says why.
class RawSender {
 public:
  static constexpr std::int64_t kPiece_bytes = 128 * 1024, kRefused_us = 60'000'000;
  static constexpr std::size_t kUnderWay = 4;

  /// directory: where the files are kept while they are sent. `store` must outlive this.
  RawSender(std::string directory, std::string building, double kbit_s, SentStore& store,
            std::unique_ptr<RawExporter> exporter);

  /// The next piece that may go out now; empty when there is none. `steady_us` is of a clock that
  /// is never set.
  std::optional<Outgoing> next(std::int64_t steady_us, const std::string& config_sha256,
                               const SendWindow& window);
  /// The hub has this piece.
  void acknowledged(const Outgoing& piece);
  /// Pieces that wait, those under way included; of the request that is being sent.
  std::int64_t waiting() const;
  /// Why the newest request came to nothing; empty: it did not.
  const std::string& trouble() const { return trouble_; }

 private:
  enum class State { idle, exporting, sending, giving_up };
  void begin();
  void begin_sending();
  void give_up(const std::string& why);
  void finish(const std::string& outcome);
  std::optional<Outgoing> piece(std::int64_t number, const std::string& config_sha256);

  std::string directory_, building_;
  double bytes_us_;  ///< allowed in a microsecond
  SentStore& store_;
  std::unique_ptr<RawExporter> exporter_;
  State state_ = State::idle;
  RawRequest request_;
  std::string path_, trouble_;
  std::string why_none_;    ///< while giving up
  std::vector<bool> done_;  ///< by piece
  std::int64_t next_us_ = INT64_MIN, look_us_ = INT64_MIN;
};

/// `framewatch history`, the program beside this one, as a process of its own. config: the
/// configuration file.
std::unique_ptr<RawExporter> history_exporter(std::string config);

}  // namespace framewatch::fleet
