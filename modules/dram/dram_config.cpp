// Keys, ranges and combinations of the memory system's configuration.
#include "modules/dram/dram_config.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "modules/dram/address_mapping.h"
#include "modules/dram/memspec.h"

namespace sgs {

void visit(ConfigVisitor& v, DramConfig& c) {
  v("memspec", c.memspec, "device: name of a shipped memspec or path of a JSON file");
  v("channels", c.channels, in_range(1, 16), "independent channels, a power of two");
  v("ranks", c.ranks, in_range(1, 4), "ranks a channel, a power of two");
  v("mapping", c.mapping, "address fields from most to least significant");
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
  v("read_queue_entries", c.read_queue_entries, in_range(1, 1024), "read queue of a channel");
  v("write_queue_entries", c.write_queue_entries, in_range(1, 1024), "write queue of a channel");
  v("write_high_watermark", c.write_high_watermark, in_range(1, 1024),
    "queued writes at which writing begins");
  v("write_low_watermark", c.write_low_watermark, in_range(0, 1023),
    "queued writes at which reading resumes");
  v("posted_writes", c.posted_writes, "answer a write when it is queued, not when it is written");
  v("front_end_ns", c.front_end_ns, in_range(0.0, 1000.0),
    "from a request's arrival to its first command, at least");
  v("back_end_ns", c.back_end_ns, in_range(0.0, 1000.0),
    "from the last datum on the bus to the answer");
  v("refresh", c.refresh,
    names<RefreshMode>({{"off", RefreshMode::kOff},
                        {"all_bank", RefreshMode::kAllBank},
                        {"per_bank", RefreshMode::kPerBank}}),
    "kind of refresh");
  v("refresh_postpone_max", c.refresh_postpone_max, in_range(0, 8),
    "refresh commands that may be owed while requests wait");
  v("power_down_idle_cycles", c.power_down_idle_cycles, in_range(0, 100000000),
    "idle time of a rank before power-down; 0: never");
  v("self_refresh_idle_cycles", c.self_refresh_idle_cycles, in_range(0, 100000000),
    "idle time of a rank before self-refresh; 0: never");
  v("current_set", c.current_set, "set of currents of the memspec; empty: its default");
  v("io_pj_per_bit", c.io_pj_per_bit, in_range(0.0, 100.0),
    "I/O energy added to each transferred bit");
}

void DramConfig::validate() const {
  const auto refuse = [](const char* key, const std::string& got, const std::string& expected) {
    throw InputError(fmt::format("dram.{}: got {}, expected {}", key, got, expected));
  };
  const auto power_of_two = [&](const char* key, std::uint32_t value) {
    if (value == 0 || (value & (value - 1)) != 0)
      refuse(key, std::to_string(value), "a power of two");
  };
  power_of_two("channels", channels);
  power_of_two("ranks", ranks);
  if (read_queue_entries == 0) refuse("read_queue_entries", "0", "at least 1");
  if (write_high_watermark == 0 || write_high_watermark > write_queue_entries)
    refuse("write_high_watermark", std::to_string(write_high_watermark),
           fmt::format("1 to write_queue_entries {}", write_queue_entries));
  if (write_low_watermark >= write_high_watermark)
    refuse("write_low_watermark", std::to_string(write_low_watermark),
           fmt::format("less than write_high_watermark {}", write_high_watermark));
  if (self_refresh_idle_cycles != 0 && self_refresh_idle_cycles <= power_down_idle_cycles)
    refuse("self_refresh_idle_cycles", std::to_string(self_refresh_idle_cycles),
           fmt::format("0 or more than power_down_idle_cycles {}", power_down_idle_cycles));
  const Memspec device = load_memspec(memspec);
  if (ranks * device.organisation.banks > 64)
    refuse("ranks", std::to_string(ranks),
           fmt::format("at most 64 banks a channel; each rank has {}", device.organisation.banks));
  if (!current_set.empty() && device.currents.count(current_set) == 0) {
    std::string known;
    for (const auto& set : device.currents) known += (known.empty() ? "" : ", ") + set.first;
    refuse("current_set", current_set, "one of " + known);
  }
  AddressMapping(*this, device);
}

}  // namespace sgs
