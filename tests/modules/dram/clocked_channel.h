// One channel's controller and its rank cycle by cycle: queues of reads and writes, and in each
// cycle the first command that is legal, a refresh that is wanted before all, urgent requests
// before others, columns before row commands, older requests before younger. Open rows, no aging.
// Rules of time by pairs of commands, as JESD209-3 names them; they count from a command's last
// cycle on the command bus.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "modules/dram/channel_request.h"
#include "modules/dram/command.h"
#include "modules/dram/memspec.h"
#include "tests/modules/dram/clocked_refresh.h"

namespace sgs::test {

struct ChannelHardware {
  std::uint32_t front_end = 8;  // cycles from arrival to the first command
  std::size_t read_entries = 32, write_entries = 32, high_watermark = 24, low_watermark = 8;
  std::size_t urgent_entries = 4;  // beside the others'
  bool hits_first = true;          // of a bank's requests those of its open row go first
  RefreshHardware refresh;
};

class ClockedChannel {
 public:
  struct Sent {
    std::uint64_t cycle;
    Command command;
    std::uint32_t bank, row, burst;
  };

  // Write latency of set A, the later read strobe.
  ClockedChannel(const ChannelHardware& hardware, const Memspec& memspec)
      : hw_(hardware),
        t_(memspec.timing_cycles),
        bus_(memspec.command_bus),
        burst_(memspec.burst_cycles()),
        banks_(memspec.organisation.banks),
        groups_(memspec.organisation.bank_groups),
        refresh_(hardware.refresh, memspec) {}

  bool full(const ChannelRequest& request) const {
    if (request.direction == Direction::kWrite) return writes_.size() == hw_.write_entries;
    return request.urgent ? urgent_reads() == hw_.urgent_entries
                          : reads_.size() - urgent_reads() == hw_.read_entries;
  }
  bool empty() const { return reads_.empty() && writes_.empty(); }
  void push(const ChannelRequest& request) {
    queue(request.direction).push_back({request, now_ + hw_.front_end, order_++});
  }
  // A cycle: at most one command begins on each command bus.
  void step() {
    refresh_.begin_cycle(now_);
    refresh_.look_for_bank(waiting());
    const std::uint32_t first_bank = refresh_.first_bank();
    while (begin_command(first_bank)) refresh_.look_for_bank(waiting());
    ++now_;
  }
  // In the order of their cycles.
  std::vector<Sent> sent() const {
    std::vector<Sent> sent = sent_;
    const auto earlier = [](const Sent& a, const Sent& b) { return a.cycle < b.cycle; };
    std::stable_sort(sent.begin(), sent.end(), earlier);
    return sent;
  }

 private:
  struct Entry {
    ChannelRequest request;
    std::uint64_t ready, order;
  };
  using Queue = std::vector<Entry>;  // by age
  struct Bank {
    std::uint32_t row = kNoRow;
    std::optional<std::uint64_t> activated, precharged, read, written, refreshed;  // last
  };
  struct Group {
    std::optional<std::uint64_t> activated, read, written;  // last
  };
  struct Choice {
    bool urgent, column;
    std::uint64_t order;
    std::size_t at;  // in its queue
    Command command;
  };

  // first_bank: of those whose turn it was as the cycle began; others' comes with the next.
  bool begin_command(std::uint32_t first_bank) {
    const bool turn = refresh_.first_bank() == first_bank;
    return (turn && refresh_.wanted(!waiting().empty()) && send_refresh()) || send_request();
  }

  // Banks of requests that are through the front end.
  std::set<std::uint32_t> waiting() const {
    std::set<std::uint32_t> banks;
    for (const Queue* requests : {&reads_, &writes_}) {
      for (const Entry& entry : *requests) {
        if (now_ >= entry.ready) banks.insert(entry.request.bank);
      }
    }
    return banks;
  }

  bool send_request() {
    std::optional<Choice> best;
    const Direction wanted = wanted_direction();
    for (std::uint32_t bank = 0; bank < banks_.size(); ++bank) consider(wanted, bank, best);
    if (best) send(wanted, *best);
    return best.has_value();
  }

  // Cycles of its command bus that a command takes which begins now.
  std::vector<std::uint64_t> cycles_of(Command command) const {
    if (command == Command::kActivate && bus_.activate_gap > 0)
      return {now_, now_ + 1 + bus_.activate_gap};
    std::vector<std::uint64_t> cycles;
    const std::uint32_t count = command == Command::kActivate ? bus_.activate
                                : is_column(command)          ? bus_.column
                                                              : bus_.row;
    for (std::uint32_t i = 0; i < count; ++i) cycles.push_back(now_ + i);
    return cycles;
  }
  static bool is_column(Command command) { return is_read(command) || is_write(command); }
  std::set<std::uint64_t>& bus_of(Command command) {
    return taken_[is_column(command) ? bus_.buses - 1 : 0];
  }
  bool bus_is_free(Command command) {
    const std::set<std::uint64_t>& taken = bus_of(command);
    for (const std::uint64_t cycle : cycles_of(command)) {
      if (taken.count(cycle) > 0) return false;
    }
    return true;
  }
  // Begins now. Returns its last cycle.
  std::uint64_t put_on_bus(Command command) {
    for (const std::uint64_t cycle : cycles_of(command)) bus_of(command).insert(cycle);
    return cycles_of(command).back();
  }

  std::size_t urgent_reads() const {
    const auto is_urgent = [](const Entry& entry) { return entry.request.urgent; };
    return static_cast<std::size_t>(std::count_if(reads_.begin(), reads_.end(), is_urgent));
  }

  Queue& queue(Direction d) { return d == Direction::kRead ? reads_ : writes_; }

  Direction wanted_direction() const {
    if (writes_.empty()) return Direction::kRead;
    if (reads_.empty()) return Direction::kWrite;
    if (urgent_reads() > 0) return Direction::kRead;
    const std::size_t enough =
        direction_ == Direction::kWrite ? hw_.low_watermark + 1 : hw_.high_watermark;
    return writes_.size() >= enough ? Direction::kWrite : Direction::kRead;
  }

  // The bank's next command, if it is legal in this cycle.
  void consider(Direction wanted, std::uint32_t bank, std::optional<Choice>& best) {
    const Queue& requests = queue(wanted);
    const Bank& b = banks_[bank];
    std::optional<std::size_t> oldest, hit, urgent;
    for (std::size_t i = requests.size(); i-- > 0;) {
      if (requests[i].request.bank != bank) continue;
      oldest = i;
      if (requests[i].request.row == b.row) hit = i;
      if (requests[i].request.urgent) urgent = i;
    }
    if (!oldest || (!hw_.hits_first && *oldest != 0 && !urgent)) return;
    const std::size_t at = urgent ? *urgent : hw_.hits_first && hit ? *hit : *oldest;
    const Entry& entry = requests[at];
    Choice choice{entry.request.urgent, entry.request.row == b.row, entry.order, at,
                  Command::kActivate};
    if (choice.column) {
      choice.command = wanted == Direction::kRead ? Command::kRead : Command::kWrite;
    } else if (b.row != kNoRow) {
      choice.command = Command::kPrecharge;
    }
    const std::uint64_t last = cycles_of(choice.command).back();
    if (now_ < entry.ready || !bus_is_free(choice.command) || refresh_.holds(bank)) return;
    if (!legal(choice.command, bank, last)) return;
    // A row that a refresh closes again before its first column.
    const std::uint32_t to_column = static_cast<std::uint32_t>(last - now_) +
                                    (wanted == Direction::kWrite ? rcd_write() : t_.rcd);
    if (choice.command == Command::kActivate && refresh_.will_hold(bank, to_column)) return;
    const auto rank = [](const Choice& c) { return std::tuple(!c.urgent, !c.column, c.order); };
    if (!best || rank(choice) < rank(*best)) best = choice;
  }

  std::uint32_t rcd_write() const { return t_.rcd_write > 0 ? t_.rcd_write : t_.rcd; }
  // With `at` as its last cycle.
  bool legal(Command command, std::uint32_t bank, std::uint64_t at) const {
    const auto since = [at](const std::optional<std::uint64_t>& last, std::uint64_t cycles) {
      return !last || at >= *last + cycles;
    };
    const Bank& b = banks_[bank];
    const Group& group = groups_[bank % groups_.size()];
    const std::uint64_t write_end = t_.write_latency_a + t_.dqss + burst_;
    const std::uint64_t turn = t_.read_latency + t_.dqsck_max + burst_ + 1 - t_.write_latency_a;
    switch (command) {
      case Command::kActivate:
        return closed_for_long(b, at) && since(b.refreshed, t_.rfc_bank) &&
               since(refreshed_all_, t_.rfc_all) && since(activates_[3], t_.rrd) &&
               since(activates_[0], t_.faw) && since(group.activated, t_.rrd_l) &&
               since(refreshed_bank_, t_.pbr2act);
      case Command::kRefreshBank:  // an activation, to the rank
        return legal(Command::kActivate, bank, at) &&
               since(refreshed_bank_, t_.pbr2pbr > 0 ? t_.pbr2pbr : t_.rfc_bank);
      case Command::kRead:
        return since(b.activated, t_.rcd) && since(read_, t_.ccd) &&
               since(written_, write_end + t_.wtr) && since(group.read, t_.ccd_l) &&
               since(group.written, write_end + t_.wtr_l);
      case Command::kWrite:
        return since(b.activated, rcd_write()) && since(written_, t_.ccd) &&
               since(read_, t_.rtw > 0 ? t_.rtw : turn) &&
               since(group.written, t_.ccd_l_write > 0 ? t_.ccd_l_write : t_.ccd_l);
      default:
        return since(b.activated, t_.ras) && since(b.read, t_.rtp) &&
               since(b.written, write_end + t_.wr);
    }
  }

  bool closed_for_long(const Bank& b, std::uint64_t at) const {
    const auto since = [at](const std::optional<std::uint64_t>& last, std::uint64_t cycles) {
      return !last || at >= *last + cycles;
    };
    return since(b.precharged, t_.rp_bank) && since(precharged_all_, t_.rp_all) &&
           since(b.activated, t_.rc);
  }

  // The next command on the way to the refresh, if it is legal in this cycle, its first.
  bool send_refresh() { return refresh_.all_banks() ? refresh_all() : refresh_bank(); }
  bool refresh_all() {
    const auto is_open = [](const Bank& b) { return b.row != kNoRow; };
    if (std::any_of(banks_.begin(), banks_.end(), is_open)) {
      for (std::uint32_t bank = 0; bank < banks_.size(); ++bank) {
        if (is_open(banks_[bank]) && !legal(Command::kPrecharge, bank, now_)) return false;
      }
      if (!bus_is_free(Command::kPrechargeAll)) return false;
      for (Bank& b : banks_) b.row = kNoRow;
      precharged_all_ = put_on_bus(Command::kPrechargeAll);
      sent_.push_back({*precharged_all_, Command::kPrechargeAll, 0, 0, 0});
      return true;
    }
    if (!bus_is_free(Command::kRefreshAll)) return false;
    for (const Bank& b : banks_) {
      if (!closed_for_long(b, now_)) return false;
    }
    if (refreshed_all_ && now_ < *refreshed_all_ + t_.rfc_all) return false;
    refreshed_all_ = put_on_bus(Command::kRefreshAll);
    sent_.push_back({*refreshed_all_, Command::kRefreshAll, 0, 0, 0});
    refresh_.refreshed();
    return true;
  }
  bool refresh_bank() {
    bool open = false;
    for (std::uint32_t bank = refresh_.first_bank(); bank < refresh_.end_bank(); ++bank) {
      Bank& b = banks_[bank];
      if (b.row == kNoRow) continue;
      open = true;
      if (!legal(Command::kPrecharge, bank, now_) || !bus_is_free(Command::kPrecharge)) continue;
      b.row = kNoRow;
      b.precharged = put_on_bus(Command::kPrecharge);
      sent_.push_back({*b.precharged, Command::kPrecharge, bank, 0, 0});
      return true;
    }
    if (open || !bus_is_free(Command::kRefreshBank)) return false;
    for (std::uint32_t bank = refresh_.first_bank(); bank < refresh_.end_bank(); ++bank) {
      if (!legal(Command::kRefreshBank, bank, now_)) return false;
    }
    for (std::uint32_t bank = refresh_.first_bank(); bank < refresh_.end_bank(); ++bank) {
      banks_[bank].refreshed = now_ + bus_.row - 1;
    }
    refreshed_bank_ = put_on_bus(Command::kRefreshBank);
    sent_.push_back({*refreshed_bank_, Command::kRefreshBank, refresh_.first_bank(), 0, 0});
    count_activate(*refreshed_bank_);
    refresh_.refreshed();
    return true;
  }

  void count_activate(std::uint64_t at) {
    std::rotate(activates_.begin(), activates_.begin() + 1, activates_.end());
    activates_.back() = at;
  }

  void send(Direction wanted, const Choice& choice) {
    direction_ = wanted;
    Queue& requests = queue(wanted);
    ChannelRequest& request = requests[choice.at].request;
    Bank& b = banks_[request.bank];
    Group& group = groups_[request.bank % groups_.size()];
    const std::uint64_t at = put_on_bus(choice.command);
    sent_.push_back({at, choice.command, request.bank,
                     choice.command == Command::kActivate ? request.row : 0,
                     choice.column ? request.burst : 0});
    if (choice.command == Command::kActivate) {
      b.row = request.row;
      b.activated = group.activated = at;
      count_activate(at);
    } else if (choice.command == Command::kPrecharge) {
      b.row = kNoRow;
      b.precharged = at;
    } else {
      (wanted == Direction::kRead ? b.read : b.written) = at;
      (wanted == Direction::kRead ? read_ : written_) = at;
      (wanted == Direction::kRead ? group.read : group.written) = at;
      ++request.burst;
      if (--request.bursts == 0) {
        requests.erase(requests.begin() + static_cast<std::ptrdiff_t>(choice.at));
      }
    }
  }

  const ChannelHardware hw_;
  const Memspec::Timing t_;
  const Memspec::CommandBus bus_;
  const std::uint32_t burst_;
  std::vector<Bank> banks_;
  std::vector<Group> groups_;
  ClockedRefresh refresh_;
  // The last of the rank.
  std::optional<std::uint64_t> read_, written_, precharged_all_, refreshed_all_, refreshed_bank_;
  std::array<std::optional<std::uint64_t>, 4> activates_;  // the last four
  std::array<std::set<std::uint64_t>, 2> taken_;           // cycles of each command bus
  Queue reads_, writes_;
  Direction direction_ = Direction::kRead;  // of the last command
  std::uint64_t now_ = 0, order_ = 0;
  std::vector<Sent> sent_;
};

}  // namespace sgs::test
