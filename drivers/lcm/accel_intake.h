// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/axis_binding.h"
#include "drivers/lcm/lcm_settings.h"
#include "drivers/lcm/multicast/lcm_packet.h"
#include "drivers/lcm/sequence_counter.h"

namespace framewatch::drivers {

/// Binds a node to the address that its messages come from: the first sender, until it is silent
/// for kSilent_us. A node that restarts has another port.
class BoundSender {
 public:
  static constexpr std::int64_t kSilent_us = 2'000'000;
  static constexpr std::int64_t kHold_us = 5'000'000;

  /// Returns true if the message is from the bound address, or the provider does not know senders.
  bool takes(const LcmSender& sender, std::int64_t arrival_us);
  /// Returns true if two addresses sent at the same time within the last kHold_us.
  bool contested(std::int64_t arrival_us) const { return arrival_us < contested_until_us_; }
  const LcmSender& bound() const { return bound_; }
  /// Returns the newest other address.
  const LcmSender& other() const { return other_; }

  std::int64_t others = 0;    ///< messages from other addresses
  std::int64_t contests = 0;  ///< times that the bound address sent after another one

  template <typename Archive>
  void archive(Archive& a) {
    a(bound_.address, bound_.port, other_.address, other_.port, other_was_last_);
    for (std::int64_t* time : {&arrival_us_, &contested_until_us_})
      a.within(*time, -2 * a.kMaxCount, 2 * a.kMaxCount);
    for (std::int64_t* count : {&others, &contests}) a.within(*count, 0, a.kMaxCount);
  }

 private:
  LcmSender bound_, other_;
  std::int64_t arrival_us_ = 0;  ///< newest message from the bound address
  std::int64_t contested_until_us_ = 0;
  bool other_was_last_ = false;
};

/// The state of one sensor node on one LCM channel.
struct HeardNode {
  static constexpr double kMaxNodes = 1e6;  ///< nodes ever heard
  explicit HeardNode(double rate_hz) : counter(rate_hz) {}

  SequenceCounter counter;
  BoundSender sender;
  SequenceWatch watch;
  SensorNodeSample held;      ///< the first sample after a leap of the numbers
  std::size_t order = 0;      ///< index among the nodes heard
  std::size_t axis = 0;       ///< the first sensor axis that it carried
  std::uint8_t in_input = 0;  ///< heard in the current log
  std::int64_t withheld = 0;  ///< messages of the first of two senders, with TwoSenders::none
  std::int64_t unheard = 0;   ///< lost messages sent while the program was not running
  bool away = false;          ///< the program was not running before its next message

  /// Returns the messages that came under the node's number and were left out.
  std::int64_t left_out() const {
    return counter.duplicates + counter.others + sender.others + withheld;
  }
  bool contested(std::int64_t arrival_us) const {
    return counter.contested(arrival_us) || sender.contested(arrival_us);
  }
  SequenceWatch::Counts counts() const {
    return {counter.received, counter.lost - unheard, counter.duplicates, counter.leaps,
            counter.conflicts + counter.others + sender.contests};
  }

  template <typename Archive>
  void archive(Archive& a) {
    a(held.time, held.sequence, held.node, held.accel_abs_mps2);
    a(counter, sender, watch, axis, in_input);
    a.within(order, 0, kMaxNodes);
    a.within(withheld, 0, a.kMaxCount);
    a.within(unheard, 0, a.kMaxCount);
  }
};

/// Reports trouble with a node's messages or with a channel table, when it begins and when it is
/// over.
struct IntakeNotice {
  bool of_table = false;  ///< a table contradicts the binding of `axis`; else see `trouble`
  SequenceTrouble trouble = SequenceTrouble::two_senders;
  std::size_t axis = 0;  ///< sensor axis; for a node the first one it carries
  bool over = false;
  std::int64_t arrival_us = 0;
  std::string stream;              ///< LCM channel of the samples
  std::int32_t node = 0;           ///< node that sends them
  std::int64_t count = 0, of = 0;  ///< for a node: messages concerned, and all, in the last 10 s
  LcmSender bound, other;          ///< two_senders: their addresses, if known
  std::int64_t from = 0, to = 0;   ///< leaps: numbers of the newest leap
  ChannelTable::Entry told;        ///< for a table: its entry
};

using IntakeNoticeSink = std::function<void(const IntakeNotice&)>;

/// The kind of a message. `other_sender`: ignored, because two send under its node. `held`: its
/// numbers leap, and the next message decides whether it counts.
enum class IntakeResult { samples, table, foreign, malformed, duplicate, other_sender, held };

struct IntakeCounters {
  std::int64_t messages = 0;
  std::int64_t foreign = 0;    ///< other channels, and nodes that are not configured
  std::int64_t malformed = 0;  ///< wrong size, fingerprint or lengths on a configured channel
  std::int64_t duplicate = 0;
  std::int64_t other_sender = 0;
  std::int64_t elsewhere = 0;  ///< axes that channel tables named at other addresses
  std::int64_t renamed = 0;    ///< addresses of axes that channel tables named differently
};

/// Turns LCM messages, live or from a log, into samples of the configured axes. Never throws,
/// whatever the bytes, and counts the messages that it rejects.
class AccelIntake {
 public:
  using Sink = std::function<void(const estimator::AccelSample&)>;

  /// `wanted` are the sensor axes; `sink` gets their samples.
  AccelIntake(std::vector<WantedAxis> wanted, Sink sink, IntakeSettings settings = {});

  /// Sets the receiver of notices of trouble. Call it before the first message.
  void on_notice(IntakeNoticeSink sink) { notice_ = std::move(sink); }

  /// Takes a message. `received_us` is the receiver's clock or the time of the event in the log;
  /// with 0 (unknown) a sample counts as received at its own time.
  IntakeResult message(const std::string& channel, const void* data, std::size_t size,
                       const LcmSender& sender = {}, std::int64_t received_us = 0);
  /// Begins a log, whose tables may bind axes differently from those of the log before.
  void log_begins();
  /// Notes a restart of the program. Messages sent while it was not running count as lost, but not
  /// as trouble of the network.
  void came_up();

  const AxisBinding& binding() const { return binding_; }
  const IntakeCounters& counters() const { return counters_; }
  /// Returns the node that carries a sensor axis; null before its first message.
  const HeardNode* node_of(std::size_t axis) const { return node_of_axis_[axis]; }
  std::int64_t lost() const { return lost_; }            ///< messages, summed over the nodes
  std::int64_t backwards() const { return backwards_; }  ///< times that sensor time ran backwards

  /// Returns the sample of the last message that was `samples`; last_node() returns
  /// HeardNode::order of its node.
  const SensorNodeSample& last_sample() const { return last_sample_; }
  std::size_t last_node() const { return last_node_; }

  /// Writes or reads the state (estimator/state/archive.h): numbers of messages and bindings by
  /// tables.
  template <typename Archive>
  void archive(Archive& a) {
    for (std::int64_t* count :
         {&counters_.messages, &counters_.foreign, &counters_.malformed, &counters_.duplicate,
          &counters_.other_sender, &counters_.elsewhere, &counters_.renamed})
      a.within(*count, 0, a.kMaxCount);
    for (std::int64_t* number : {&lost_, &backwards_, &next_check_us_})
      a.within(*number, -2 * a.kMaxCount, 2 * a.kMaxCount);
    a.within(nodes_heard_, 0, HeardNode::kMaxNodes);
    a(binding_, contradicted_);
    std::vector<std::pair<std::string, std::int32_t>> places;
    for (const auto& [place, node] : heard_) places.push_back(place);
    places.resize(a.count(places.size()));
    for (auto& [stream, number] : places) {
      a(stream, number);
      HeardNode& node = heard_.try_emplace({stream, number}, settings_.rate_hz).first->second;
      a(node);
      if (node.axis >= node_of_axis_.size()) a.refuse();
    }
    std::vector<std::int64_t> of_axis;  // numbers among them
    for (const HeardNode* node : node_of_axis_) of_axis.push_back(number_of(node));
    a.any_size(of_axis);
    if constexpr (!Archive::kReading) return;
    for (std::size_t i = 0; i < node_of_axis_.size() && i < of_axis.size(); ++i)
      node_of_axis_[i] = node_numbered(of_axis[i]);
    stream_.clear();  // found again at the next message
    nodes_.clear();
  }

 private:
  /// Caches a node on a configured stream.
  struct Node {
    std::int32_t number;
    AxisBinding::NodeAxes axes;
    HeardNode* heard;
  };
  IntakeResult table(const std::string& stream, const void* data, std::size_t size,
                     std::int64_t received_us);
  IntakeResult accel(const std::string& channel, const void* data, std::size_t size,
                     const LcmSender& sender, std::int64_t received_us);
  bool carried(const std::string& channel);
  const Node* find_node(const std::string& channel, std::int32_t number);
  IntakeResult judge(HeardNode& node, const SensorNodeSample& sample, const LcmSender& sender);
  void give(const Node& node, const SensorNodeSample& sample);
  void forget_unbound();
  void check_nodes(std::int64_t arrival_us);
  void check_node(const std::string& stream, std::int32_t number, HeardNode& node);
  bool is_silent(const std::string& stream, std::int32_t node, std::int64_t arrival_us) const;
  void notice(const IntakeNotice& notice) const;
  void check_table(std::size_t axis, std::int64_t arrival_us,
                   const AxisBinding::Contradiction* against, const std::string& stream);
  /// Returns the index of a node in heard_, -1 for null; node_numbered() is the inverse.
  std::int64_t number_of(const HeardNode* node) const;
  const HeardNode* node_numbered(std::int64_t number) const;

  AxisBinding binding_;
  Sink sink_;
  IntakeSettings settings_;
  IntakeNoticeSink notice_;
  IntakeCounters counters_;
  std::map<std::pair<std::string, std::int32_t>, HeardNode> heard_;
  std::size_t nodes_heard_ = 0;
  std::int64_t lost_ = 0, backwards_ = 0;
  std::int64_t arrival_us_ = 0, next_check_us_ = 0;
  std::string stream_;       ///< stream of the last configured message, or empty
  std::vector<Node> nodes_;  ///< nodes of stream_, in the order they came
  std::size_t next_node_ = 0;
  SensorNodeSample last_sample_{};
  std::size_t last_node_ = 0;
  std::vector<const HeardNode*> node_of_axis_;
  std::vector<Trouble> contradicted_;  ///< by sensor axis: contradicted by a channel table
};

}  // namespace framewatch::drivers
