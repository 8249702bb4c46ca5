// Checks a stream of DRAM commands against the list of constraints, rule by rule.
//
// Written from the list, not from the scheduler: it keeps when each command last came and compares
// distances; the only thing shared is the numbers of the memspec. It is therefore also the place to
// read what the constraints are: see rules() in the .cpp file.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "modules/dram/command.h"
#include "modules/dram/command_trace.h"
#include "modules/dram/memspec.h"

namespace sgs {

struct TraceViolation {
  CommandRecord record;
  std::string constraint;
  std::uint64_t earliest = 0;  // legal cycle; 0: never in this state
  std::string text() const;    // one line
};

class TraceChecker : public CommandSink {
 public:
  TraceChecker(const Memspec& memspec, const CommandTraceHeader& header);

  // The violation of this command, if any; the command counts as sent either way.
  std::optional<TraceViolation> check(const CommandRecord& record);

  // Checks a command, as a sink; remembers the first violation.
  void on_command(const CommandRecord& record) override;
  const std::optional<TraceViolation>& first() const { return first_; }
  std::uint64_t checked() const { return checked_; }

 private:
  enum class Scope { kSameBank, kSameGroup, kSameRank, kOtherRank };
  struct Rule {
    const char* name;
    std::uint32_t before;  // set of commands, a bit each
    std::uint32_t after;
    Scope scope;
    std::uint64_t cycles;
  };
  using Times = std::array<std::uint64_t, kCommands>;  // cycle + 1 of the last; 0: never
  struct Bank {
    Times last{};
    bool open = false;
    std::uint64_t opened = 0;
    std::uint64_t auto_closed = 0;  // when an auto-precharge has started; 0: none
  };
  struct Rank {
    Times last{};
    std::vector<Bank> banks;
    std::vector<Times> groups;
    std::deque<std::uint64_t> activations;  // the last four
    bool powered_down = false;
    bool self_refresh = false;
    std::uint64_t refreshes_due_from = 0;
    std::uint64_t refreshes = 0;
    std::uint32_t owed_after_exit = 0;  // refreshes, before self-refresh is entered again
    std::uint32_t next_bank = 0;        // whose turn it is, where the device counts
    std::uint64_t had_their_turn = 0;   // banks, a bit each
  };
  struct Channel {
    std::vector<Rank> ranks;
    std::uint64_t last_cycle = 0;
    std::array<std::set<std::uint64_t>, 2> bus;  // cycles taken of late
  };
  struct Verdict {
    std::uint64_t earliest = 0;
    std::string constraint;
    bool forbidden = false;
    void at_least(std::uint64_t cycle, const char* name);
    void forbid(const std::string& name);
  };

  static std::vector<Rule> rules(const Memspec& memspec, WriteLatencySet set);
  bool in_range(const CommandRecord& record) const;
  // Of the command: its own, and with a per-bank refresh those that it takes too.
  std::uint32_t banks_of(const CommandRecord& record) const;
  std::size_t bus_of(Command command) const;
  // Cycles of its bus that a command takes whose last one is `last`.
  std::vector<std::uint64_t> bus_cycles(Command command, std::uint64_t last) const;
  void check_state(const CommandRecord& record, const Rank& rank, Verdict& verdict) const;
  void check_distances(const CommandRecord& record, const Channel& channel, Verdict& verdict) const;
  void check_windows(const CommandRecord& record, const Rank& rank, Verdict& verdict) const;
  void apply(const CommandRecord& record);

  const Memspec memspec_;
  const CommandTraceHeader header_;
  const std::uint32_t write_end_;  // command to last datum
  std::array<std::vector<Rule>, kCommands> rules_by_command_;
  std::vector<Channel> channels_;
  std::optional<TraceViolation> first_;
  std::uint64_t checked_ = 0;
};

}  // namespace sgs
