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
#include "drivers/lcm/heard_node.h"
#include "drivers/lcm/intake_notice.h"
#include "drivers/lcm/intake_settings.h"
#include "drivers/lcm/multicast/lcm_sender.h"
#include "drivers/lcm/sequence_watch.h"

namespace framewatch::drivers {

/// What a message turned out to be; other_sender: left out, because two send under its node; held:
/// its numbers leap, the next message tells whether it counts.
enum class IntakeResult { samples, table, foreign, malformed, duplicate, other_sender, held };

struct IntakeCounters {
  std::int64_t messages = 0;
  std::int64_t foreign = 0;    ///< other people's channels, nodes that are not configured
  std::int64_t malformed = 0;  ///< wrong size, fingerprint or lengths on a channel of ours
  std::int64_t duplicate = 0;
  std::int64_t other_sender = 0;
  std::int64_t elsewhere = 0;  ///< axes that channel tables named at another address than theirs
  std::int64_t renamed = 0;    ///< addresses of axes that they gave another name
};

/// Turns LCM messages, live or from a log, into samples of the configured axes. Never throws on
/// any bytes; counts what it does not take.
class AccelIntake {
 public:
  using Sink = std::function<void(const estimator::AccelSample&)>;

  AccelIntake(std::vector<WantedAxis> wanted, Sink sink, IntakeSettings settings = {});

  /// Hears of trouble. To be set before the first message.
  void on_notice(IntakeNoticeSink sink) { notice_ = std::move(sink); }

  /// received_us: by the receiver's clock, or the time of the log's event; 0: not known, then a
  /// sample counts as received when it was taken.
  IntakeResult message(const std::string& channel, const void* data, std::size_t size,
                       const LcmSender& sender = {}, std::int64_t received_us = 0);
  /// A log begins: its tables may bind otherwise than those of the log before.
  void log_begins();
  /// The program was started anew: what was sent while it was away is counted as lost, but is no
  /// trouble of the network.
  void came_up();

  const AxisBinding& binding() const { return binding_; }
  const IntakeCounters& counters() const { return counters_; }
  /// By sensor axis: the node that carries it, null before its first message.
  const HeardNode* node_of(std::size_t axis) const { return node_of_axis_[axis]; }
  std::int64_t lost() const { return lost_; }            ///< messages, summed over the nodes
  std::int64_t backwards() const { return backwards_; }  ///< likewise

  /// What the last message that was `samples` held, and the number of its node among those heard.
  const SensorNodeSample& last_sample() const { return last_sample_; }
  std::size_t last_node() const { return last_node_; }

  /// State (estimator/state/archive.h): what the numbering of messages was and what tables bound.
  template <typename Archive>
  void archive(Archive& a) {
    for (std::int64_t* count :
         {&counters_.messages, &counters_.foreign, &counters_.malformed, &counters_.duplicate,
          &counters_.other_sender, &counters_.elsewhere, &counters_.renamed})
      a.within(*count, 0, a.kMaxCount);
    for (std::int64_t* number : {&lost_, &backwards_, &next_look_us_})
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
  /// A node on a stream of ours, as it was found: looked up once.
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
  void look(std::int64_t arrival_us);
  void look_at(const std::string& stream, std::int32_t number, HeardNode& node);
  bool is_silent(const std::string& stream, std::int32_t node, std::int64_t arrival_us) const;
  void notice(const IntakeNotice& notice) const;
  void look_at_table(std::size_t axis, std::int64_t arrival_us,
                     const AxisBinding::Contradiction* against, const std::string& stream);
  /// A node's number in the order of heard_, -1 for null, and back.
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
  std::int64_t arrival_us_ = 0, next_look_us_ = 0;
  std::string stream_;       ///< of the last message of ours; empty when there was none
  std::vector<Node> nodes_;  ///< of stream_, in the order they came
  std::size_t next_node_ = 0;
  SensorNodeSample last_sample_{};
  std::size_t last_node_ = 0;
  std::vector<const HeardNode*> node_of_axis_;
  std::vector<Trouble> contradicted_;  ///< by sensor axis: by a channel table
};

}  // namespace framewatch::drivers
