// An interval heap as levels of memories with a read and a write port a bank, cycle by cycle: each
// level works on an operation of its own, and knows of the others only what it has read.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

namespace sgs::test {

// How operations pass the levels.
struct HeapPace {
  std::uint32_t banks;             // of a level: by the last bits of a node's place in it
  std::uint32_t cycles_per_level;  // 1: reads below both candidates; 2: below the one that rose
  bool bypass = true;              // a node read as it is written is what is written
};

class SteppedHeap {
 public:
  enum class What { kInsert, kDeleteMin, kDeleteMax };

  SteppedHeap(std::size_t capacity, const HeapPace& pace)
      : pace_(pace), capacity_(capacity), memory_((capacity + 1) / 2) {}

  // Begins in the cycle that is next. A delete's key is given a cycle later: result().
  void begin(What what, std::uint32_t key) { operations_.emplace_back(what, key); }
  // As a mark does: the root's count is set to 0.
  void clear() { size_ = 0; }
  const std::vector<std::uint32_t>& results() const { return results_; }
  // An operation went where there is no node: what it had read was not so any more.
  bool lost() const { return lost_; }
  bool busy() const { return !operations_.empty(); }

  void step() {
    std::map<std::size_t, Node> written;
    std::vector<std::pair<Operation*, std::size_t>> reads;
    for (Operation& operation : operations_) act(operation, written, reads);
    count_accesses(written, reads);
    if (pace_.bypass) write(written);
    for (const auto& [operation, at] : reads) {
      if (at < memory_.size()) operation->read[at] = memory_[at];
    }
    write(written);
    operations_.erase(std::remove_if(operations_.begin(), operations_.end(),
                                     [](const Operation& o) { return o.done; }),
                      operations_.end());
  }

  std::uint64_t nodes_read() const { return nodes_read_; }
  std::uint64_t nodes_written() const { return nodes_written_; }
  std::uint32_t most_at_a_port() const { return most_at_a_port_; }

 private:
  struct Node {
    std::uint32_t low = 0, high = 0;
    std::array<std::size_t, 2> below{};
  };
  struct Operation {
    Operation(What what_, std::uint32_t key_) : what(what_), key(key_) {}
    What what;
    std::uint32_t key;
    int cycle = -1;                    // 0: at the root
    std::size_t at = 0, held = 0;      // the node it is at, keys there and below
    Node node;                         // what is known of it
    std::map<std::size_t, Node> read;  // of the levels below
    bool done = false;
    bool inserts() const { return what == What::kInsert; }
    bool at_high_end() const { return what == What::kDeleteMax; }
  };
  using Writes = std::map<std::size_t, Node>;
  using Reads = std::vector<std::pair<Operation*, std::size_t>>;

  static std::size_t level_of(std::size_t at) {
    std::size_t level = 0;
    for (; at > 0; at = (at - 1) / 2) ++level;
    return level;
  }
  static std::uint32_t& end_of(Node& node, std::size_t held, bool high) {
    return high && held > 1 ? node.high : node.low;
  }

  // Keys for which there is room at and below a node.
  std::size_t room(std::size_t at) const {
    if (at >= memory_.size()) return 0;
    const std::size_t here = at + 1 == memory_.size() && capacity_ % 2 == 1 ? 1 : 2;
    return here + room(2 * at + 1) + room(2 * at + 2);
  }

  void act(Operation& o, Writes& written, Reads& reads) {
    const auto pace = static_cast<int>(pace_.cycles_per_level);
    const int cycle = o.cycle++;
    if (cycle == -1) {
      if (!o.inserts() && size_ > 2) read_children(o, root_, 0, reads);
      return;
    }
    if (cycle % pace == 0) {
      if (cycle == 0) come_to_root(o);
      decide(o, written, reads);
    }
    if (!o.done && cycle % pace == pace - 1 && (o.inserts() || pace > 1)) {
      if (!o.inserts() && o.held > 2) {
        read_children(o, o.node, o.at, reads);
      } else if (o.inserts() && o.held > 0) {
        reads.emplace_back(&o, o.at);
      }
    }
  }

  void come_to_root(Operation& o) {
    o.held = size_;
    size_ = o.inserts() ? size_ + 1 : size_ - 1;
    o.node = root_;
    if (!o.inserts()) results_.push_back(end_of(o.node, o.held, o.at_high_end()));
  }

  void decide(Operation& o, Writes& written, Reads& reads) {
    if (o.at >= memory_.size()) {
      lost_ = o.done = true;
      return;
    }
    if (o.at > 0 && o.inserts()) o.node = o.read[o.at];
    const std::size_t at = o.at;
    bool changed = true;
    Node node = o.node;
    if (o.inserts()) {
      insert(o, node);
    } else {
      changed = fill(o, node, reads);
    }
    if (!changed) return;
    if (at == 0) {
      root_ = node;
    } else {
      written[at] = node;
    }
  }

  // The operation's node becomes the one below that takes what is displaced.
  void insert(Operation& o, Node& node) {
    if (o.held == 0) {
      node = {o.key, 0, {}};
      o.done = true;
      return;
    }
    if (o.key < node.low) std::swap(o.key, node.low);
    if (o.held == 1) {
      node.high = o.key;
      o.done = true;
      return;
    }
    if (node.high < o.key) std::swap(o.key, node.high);
    const std::size_t left = 2 * o.at + 1;
    const bool left_has = node.below[0] < room(left), right_has = node.below[1] < room(left + 1);
    const std::size_t side = right_has && (!left_has || node.below[1] < node.below[0]) ? 1 : 0;
    o.held = node.below[side]++;
    o.at = left + side;
  }

  // The hole at one end; whether the node changes.
  bool fill(Operation& o, Node& node, Reads& reads) {
    const bool high = o.at_high_end();
    if (o.held <= 2) {
      o.done = true;
      if (o.held == 2 && !high) node.low = node.high;
      return o.held == 2 && !high;
    }
    const std::size_t left = 2 * o.at + 1;
    std::size_t side = node.below[0] > 0 ? 0 : 1;
    if (node.below[0] > 0 && node.below[1] > 0) {
      const std::uint32_t a = end_of(o.read[left], node.below[0], high);
      const std::uint32_t b = end_of(o.read[left + 1], node.below[1], high);
      side = (high ? a < b : b < a) ? 1 : 0;
    }
    if (pace_.cycles_per_level == 1) {  // whichever rises
      for (const std::size_t c : {0U, 1U}) {
        if (node.below[c] > 2) read_children(o, o.read[left + c], left + c, reads);
      }
    }
    o.held = node.below[side]--;
    o.at = left + side;
    o.node = o.read[o.at];
    (high ? node.high : node.low) = end_of(o.node, o.held, high);
    return true;
  }

  static void read_children(Operation& o, const Node& node, std::size_t at, Reads& reads) {
    for (const std::size_t c : {0U, 1U}) {
      if (node.below[c] > 0) reads.emplace_back(&o, 2 * at + 1 + c);
    }
  }

  void write(const Writes& written) {
    for (const auto& [at, node] : written) memory_[at] = node;
  }

  void count_accesses(const Writes& written, const Reads& reads) {
    using Bank = std::pair<std::size_t, std::size_t>;  // level, and which of it
    const auto bank_of = [&](std::size_t at) {
      const std::size_t level = level_of(at);
      return Bank{level, (at + 1 - (std::size_t{1} << level)) % pace_.banks};
    };
    std::map<Bank, std::uint32_t> read, write;
    for (const auto& [operation, at] : reads) {
      most_at_a_port_ = std::max(most_at_a_port_, ++read[bank_of(at)]);
    }
    for (const auto& [at, node] : written) {
      most_at_a_port_ = std::max(most_at_a_port_, ++write[bank_of(at)]);
    }
    nodes_read_ += reads.size();
    nodes_written_ += written.size();
  }

  const HeapPace pace_;
  const std::size_t capacity_;
  std::size_t size_ = 0;
  bool lost_ = false;
  Node root_;
  std::vector<Node> memory_;  // breadth first; the root's is not used
  std::deque<Operation> operations_;
  std::vector<std::uint32_t> results_;  // of the deletes so far
  std::uint64_t nodes_read_ = 0, nodes_written_ = 0;
  std::uint32_t most_at_a_port_ = 0;
};

}  // namespace sgs::test
