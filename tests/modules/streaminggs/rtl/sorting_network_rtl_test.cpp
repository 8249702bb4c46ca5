// The sorting network in Verilog beside the order that sorting units make: keys and their places,
// in the cycles that units are charged.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <deque>
#include <memory>
#include <random>
#include <vector>

#include "Vsorting_network.h"
#include "modules/streaminggs/nearer_key.h"
#include "modules/streaminggs/sorting/sorting_config.h"

namespace sgs::test {
namespace {

constexpr std::size_t kWidth = kNetworkEntries, kHalf = kWidth / 2;
constexpr std::size_t kReadAndWritten = 2;  // cycles of the memories around the network
const std::size_t kSortCycles = SortingNetworkConfig{}.sort_latency_cycles - kReadAndWritten;
constexpr std::size_t kMergeCycles = 4;
constexpr std::uint32_t kMissing = 0x80000000;  // where a depth has its sign

struct Item {
  std::uint32_t depth = kMissing, slot = 0;  // bits
  std::uint8_t place = 0;
  bool operator==(const Item& other) const {
    return depth == other.depth &&
           (depth == kMissing || (slot == other.slot && place == other.place));
  }
};
using Row = std::array<Item, kWidth>;

class Network {
 public:
  void enter(const Row& row) { set(row, module_->keys, module_->places); }
  void merge(const Row& runs) {
    set(runs, module_->runs, module_->run_places);
    module_->merges = 1;
  }
  void step() {
    module_->clock = 0;
    module_->eval();
    module_->clock = 1;
    module_->eval();
    module_->merges = 0;
  }
  Row sorted() const {
    Row row;
    for (std::size_t i = 0; i < kWidth; ++i) {
      row[i] = {module_->sorted[2 * i + 1], module_->sorted[2 * i],
                static_cast<std::uint8_t>(module_->sorted_places[i / 4] >> 8 * (i % 4))};
    }
    return row;
  }

 private:
  template <class Keys, class Places>
  static void set(const Row& row, Keys& keys, Places& places) {
    for (std::size_t i = 0; i < kWidth / 4; ++i) places[i] = 0;
    for (std::size_t i = 0; i < kWidth; ++i) {
      keys[2 * i] = row[i].slot;
      keys[2 * i + 1] = row[i].depth;
      places[i / 4] |= std::uint32_t{row[i].place} << 8 * (i % 4);
    }
  }
  std::unique_ptr<Vsorting_network> module_ = std::make_unique<Vsorting_network>();
};

// As the units sort; missing keys are behind.
template <class Items>
Items in_order(const Items& items) {
  std::vector<FineCandidate> keys(items.size());
  std::vector<std::uint8_t> order;
  order.reserve(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].depth == kMissing) continue;
    keys[i].depth = __builtin_bit_cast(float, items[i].depth);
    keys[i].slot = items[i].slot;
    order.push_back(static_cast<std::uint8_t>(i));
  }
  std::sort(order.begin(), order.end(),
            [&](std::uint8_t a, std::uint8_t b) { return NearerKey{}(keys[a], keys[b]); });
  Items sorted = items;
  std::fill(sorted.begin(), sorted.end(), Item{});
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = items[order[i]];
  return sorted;
}

class RandomItems {
 public:
  explicit RandomItems(std::uint64_t seed) : random_(seed) {}

  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  // Zero to infinity, subnormal ones among them; or few of them, or neighbours.
  std::uint32_t depth() {
    constexpr std::uint32_t kInfinity = 0x7F800000;
    switch (kind_) {
      case 0:
        return static_cast<std::uint32_t>(below(kInfinity + 1));
      case 1:
        return static_cast<std::uint32_t>(below(3)) * 0x3FC00000;
      default:
        return 0x40A00000 + static_cast<std::uint32_t>(below(16));
    }
  }
  Row row() {
    kind_ = below(3);
    Row row;
    const std::size_t count = below(4) == 0 ? 1 + below(kWidth) : kWidth;
    const auto first = static_cast<std::uint32_t>(random_());
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = (i + first) % kWidth;
      row[at] = {depth(), first ^ static_cast<std::uint32_t>(i),
                 static_cast<std::uint8_t>(random_())};
    }
    return row;
  }
  // In order, missing keys behind all others.
  std::vector<Item> run(std::size_t halves, std::uint32_t first_slot) {
    std::vector<Item> items(halves * kHalf);
    const std::size_t count = items.size() - below(kHalf);
    for (std::size_t i = 0; i < count; ++i) {
      items[i] = {depth(), first_slot + static_cast<std::uint32_t>(i),
                  static_cast<std::uint8_t>(random_())};
    }
    return in_order(items);
  }

 private:
  std::mt19937_64 random_;
  std::uint64_t kind_ = 0;
};

// A row enters every cycle. Each must leave in order, kSortCycles later.
class Stream {
 public:
  void enter(const Row& row) {
    network_.enter(row);
    expected_.push_back(in_order(row));
    step();
  }
  void finish() {
    while (!expected_.empty()) step();
  }
  std::size_t rows() const { return rows_; }

 private:
  void step() {
    network_.step();
    if (++cycles_ < kSortCycles) return;
    if (!(network_.sorted() == expected_.front())) FAIL("row " << rows_);
    expected_.pop_front();
    ++rows_;
  }
  Network network_;
  std::deque<Row> expected_;
  std::size_t cycles_ = 0, rows_ = 0;
};

void check_random_rows(std::size_t count, std::uint64_t seed) {
  RandomItems random(seed);
  Stream stream;
  for (std::size_t r = 0; r < count; ++r) stream.enter(random.row());
  stream.finish();
  CHECK(stream.rows() == count);
}

// Two runs that become one, half a row at a time.
struct Pair {
  std::array<std::vector<Item>, 2> runs;
  std::array<std::size_t, 2> at{};
  std::vector<Item> merged, expected;
  Row entering;  // the farther half of what has left, the next half of a run

  explicit Pair(RandomItems& random) {
    for (std::size_t r = 0; r < 2; ++r) {
      runs[r] = random.run(1 + random.below(4), static_cast<std::uint32_t>(r) << 20U);
      expected.insert(expected.end(), runs[r].begin(), runs[r].end());
      take(r, r);
    }
    expected = in_order(expected);
  }
  void take(std::size_t run, std::size_t half) {
    for (std::size_t i = 0; i < kHalf; ++i) entering[half * kHalf + i] = runs[run][at[run]++];
  }
  // Whether there is another merge.
  bool next(const Row& left) {
    merged.insert(merged.end(), left.begin(), left.begin() + kHalf);
    std::copy(left.begin() + kHalf, left.end(), entering.begin());
    const bool is_end[] = {at[0] == runs[0].size(), at[1] == runs[1].size()};
    if (is_end[0] && is_end[1]) {
      merged.insert(merged.end(), left.begin() + kHalf, left.end());
      return false;
    }
    const auto head = [&](std::size_t r) {
      const Item& item = runs[r][at[r]];
      return std::uint64_t{item.depth} << 32U | item.slot;
    };
    take(is_end[0] || (!is_end[1] && head(1) < head(0)) ? 1 : 0, 1);
    return true;
  }
};

// Merges of two pairs of runs in turn, every two cycles, and a block in each cycle between.
std::size_t check_merges(std::size_t pairs, std::uint64_t seed) {
  constexpr std::size_t kTogether = 2, kTurn = kMergeCycles / kTogether;
  RandomItems random(seed);
  Network network;
  std::vector<Pair> at_hand;
  for (std::size_t p = 0; p < kTogether; ++p) at_hand.emplace_back(random);
  std::deque<Row> blocks;
  std::size_t merged = 0;
  for (std::size_t cycle = 0; merged < pairs; ++cycle) {
    if (cycle % kTurn == 0) {
      Pair& pair = at_hand[cycle / kTurn % kTogether];
      if (cycle >= kMergeCycles && !pair.next(network.sorted())) {
        if (!(pair.merged == pair.expected)) FAIL("pair " << merged);
        pair = Pair(random);
        ++merged;
      }
      network.merge(pair.entering);
    } else {
      blocks.push_back(random.row());
      network.enter(blocks.back());
    }
    network.step();
    if (cycle % kTurn == 0 && cycle + 1 >= kSortCycles) {
      if (!(network.sorted() == in_order(blocks.front()))) FAIL("block ahead of cycle " << cycle);
      blocks.pop_front();
    }
  }
  return merged;
}

}  // namespace

TEST_CASE("sorting network in Verilog: rows in order, in reverse, of ties, of a key, of none") {
  Stream stream;
  Row row;
  stream.enter(row);
  for (std::size_t at = 0; at < kWidth; ++at) {
    row = {};
    row[at] = {0, 7, static_cast<std::uint8_t>(at)};
    stream.enter(row);
  }
  for (const std::uint32_t tied : {0U, 1U}) {
    for (const std::uint32_t reversed : {0U, 15U}) {
      for (std::uint32_t i = 0; i < kWidth; ++i) {
        row[i] = {tied == 0 ? i ^ reversed : 0x7F800000, i ^ reversed,
                  static_cast<std::uint8_t>(i)};
      }
      stream.enter(row);
    }
  }
  stream.finish();
  CHECK(stream.rows() == 21);
}
// A network of exchanges that sorts all of these sorts everything.
TEST_CASE("sorting network in Verilog: every row of nearer and farther keys") {
  Stream stream;
  Row row;
  for (std::uint32_t bits = 0; bits < 1U << kWidth; ++bits) {
    for (std::uint32_t i = 0; i < kWidth; ++i)
      row[i] = {bits >> i & 1U, i, static_cast<std::uint8_t>(i)};
    stream.enter(row);
  }
  stream.finish();
  CHECK(stream.rows() == 1U << kWidth);
}
TEST_CASE("sorting network in Verilog: random rows") { check_random_rows(1'000'000, 1); }
TEST_CASE("sorting network in Verilog: many rows", "[nightly]") {
  check_random_rows(30'000'000, 2);
}

TEST_CASE("sorting network in Verilog: merges, and blocks between") {
  CHECK(check_merges(20'000, 1) == 20'000);
}
TEST_CASE("sorting network in Verilog: many merges", "[nightly]") {
  CHECK(check_merges(1'000'000, 2) == 1'000'000);
}

}  // namespace sgs::test
