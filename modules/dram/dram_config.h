// Parameters of the memory system: device, channels, mapping, policies, queues.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "modules/config/config_visitor.h"

namespace sgs {

struct Memspec;

enum class BankHash { kNone, kXor };
enum class WriteLatencySet { kA, kB };
enum class ReadStrobe { kMin, kMax };
enum class SchedulerKind { kFrFcfs, kFcfs };
enum class PagePolicyKind { kOpen, kClosed, kAdaptive };
enum class RefreshMode { kOff, kAllBank, kPerBank };
enum class BetweenFrames { kByIdleCycles, kPowerDown, kSelfRefresh };

// Picojoules of a transferred bit: what is taken, and the ends of what its sources allow.
struct IoEnergy {
  double low = 0, middle = 0, high = 0;
};

struct DramConfig {
  std::string memspec = "lpddr3_1600_4gb";
  std::uint32_t channels = 4;
  std::uint32_t ranks = 1;
  // Eight contiguous bursts, as a rule 256 bytes, lie on a channel.
  std::string mapping = "row:rank:bank:column:group:channel:column.3";
  BankHash bank_hash = BankHash::kNone;
  WriteLatencySet write_latency_set = WriteLatencySet::kA;
  ReadStrobe read_strobe = ReadStrobe::kMax;

  SchedulerKind scheduler = SchedulerKind::kFrFcfs;
  std::uint32_t age_cap_cycles = 2000;
  PagePolicyKind page_policy = PagePolicyKind::kOpen;
  std::uint32_t read_queue_entries = 32;
  std::uint32_t write_queue_entries = 32;
  std::uint32_t write_high_watermark = 24;
  std::uint32_t write_low_watermark = 8;
  bool posted_writes = true;
  // gem5's defaults (src/mem/MemCtrl.py: static_frontend_latency, static_backend_latency).
  double front_end_ns = 10;
  double back_end_ns = 10;

  RefreshMode refresh = RefreshMode::kPerBank;  // LPDDR has it; the other banks go on
  std::int32_t refresh_postpone_max = -1;       // negative: by the memspec
  std::uint32_t power_down_idle_cycles = 0;
  std::uint32_t self_refresh_idle_cycles = 0;
  // The accelerator knows when a frame is done, and when the next one begins.
  BetweenFrames between_frames = BetweenFrames::kSelfRefresh;

  std::string current_set;
  std::optional<double> io_pj_per_bit;  // none: the memspec's

  // Data buses: pseudo-channels of all channels.
  std::uint32_t buses(const Memspec& device) const;
  // A number that is given has no band.
  IoEnergy io_pj_per_bit_of(const Memspec& device) const;
  // As within a frame, with the idle times that between_frames stands for.
  DramConfig at_rest() const;
  // Without a value of its own none where the device names the bank of a refresh, else the
  // memspec's limit.
  std::uint32_t refreshes_postponed(const Memspec& device) const;

  // InputError naming the key, what it is and what is allowed. Loads the memspec.
  void validate() const;
};

inline void visit(ConfigVisitor& v, DramConfig& c) {
  v("memspec", c.memspec, "device: name of a shipped memspec or path of a JSON file");
  v("channels", c.channels, in_range(1, 16),
    "independent channels, a power of two; the memspec may divide each into pseudo-channels");
  v("ranks", c.ranks, in_range(1, 4), "ranks a channel, a power of two");
  v("mapping", c.mapping,
    "address fields from most to least significant, a burst's bytes below the last; column.3: "
    "three of the column's bits, column: those that are left; group: the bank group");
  v("bank_hash", c.bank_hash, names<BankHash>({{"none", BankHash::kNone}, {"xor", BankHash::kXor}}),
    "xor: bank bits are XORed with the lowest row bits");
  v("write_latency_set", c.write_latency_set,
    names<WriteLatencySet>({{"a", WriteLatencySet::kA}, {"b", WriteLatencySet::kB}}),
    "mode-register set of the write latency");
  v("read_strobe", c.read_strobe,
    names<ReadStrobe>({{"min", ReadStrobe::kMin}, {"max", ReadStrobe::kMax}}),
    "which tDQSCK read data arrive with; turn-arounds always keep to the longest");
  v("scheduler", c.scheduler,
    names<SchedulerKind>({{"fr_fcfs", SchedulerKind::kFrFcfs}, {"fcfs", SchedulerKind::kFcfs}}),
    "which request goes next");
  v("age_cap_cycles", c.age_cap_cycles, in_range(1, 1000000),
    "age beyond which a request is no longer overtaken in its bank");
  v("page_policy", c.page_policy,
    names<PagePolicyKind>({{"open", PagePolicyKind::kOpen},
                           {"closed", PagePolicyKind::kClosed},
                           {"adaptive", PagePolicyKind::kAdaptive}}),
    "when a row is closed");
  v("read_queue_entries", c.read_queue_entries, in_range(1, 1024),
    "read queue of a channel; an entry is a run of bursts of one transaction in one row");
  v("write_queue_entries", c.write_queue_entries, in_range(1, 1024), "write queue of a channel");
  v("write_high_watermark", c.write_high_watermark, in_range(1, 1024),
    "queued writes at which writing begins");
  v("write_low_watermark", c.write_low_watermark, in_range(0, 1023),
    "queued writes at which reading resumes");
  v("posted_writes", c.posted_writes, "answer a write when it is queued, not when it is written");
  v("front_end_ns", c.front_end_ns, in_range(0.0, 1000.0),
    "from a request's arrival to its first command, at least: through controller and PHY");
  v("back_end_ns", c.back_end_ns, in_range(0.0, 1000.0),
    "from the last datum on the bus to the answer, likewise; also of a write that is not posted");
  v("refresh", c.refresh,
    names<RefreshMode>({{"off", RefreshMode::kOff},
                        {"all_bank", RefreshMode::kAllBank},
                        {"per_bank", RefreshMode::kPerBank}}),
    "kind of refresh");
  v("refresh_postpone_max", c.refresh_postpone_max, in_range(-1, 8),
    "refresh commands that may be owed while requests wait; negative: 0 where the device names the "
    "bank, else the memspec's limit");
  v("power_down_idle_cycles", c.power_down_idle_cycles, in_range(0, 100000000),
    "idle time of a rank before power-down; 0: never");
  v("self_refresh_idle_cycles", c.self_refresh_idle_cycles, in_range(0, 100000000),
    "idle time of a rank before self-refresh; 0: never");
  v("between_frames", c.between_frames,
    names<BetweenFrames>({{"by_idle_cycles", BetweenFrames::kByIdleCycles},
                          {"power_down", BetweenFrames::kPowerDown},
                          {"self_refresh", BetweenFrames::kSelfRefresh}}),
    "where ranks go from a frame's end until the next one begins at a fixed rate; by_idle_cycles: "
    "as within a frame");
  v("current_set", c.current_set, "set of currents of the memspec; empty: its default");
  v("io_pj_per_bit", c.io_pj_per_bit, in_range(0.0, 100.0),
    "I/O energy added to each transferred bit; null: the memspec's");
}

}  // namespace sgs
