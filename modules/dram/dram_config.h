// What can be chosen about the memory system: device, channels, mapping, policies, queues.
#pragma once

#include <cstdint>
#include <string>

#include "modules/config/config_visitor.h"

namespace sgs {

enum class BankHash { kNone, kXor };
enum class WriteLatencySet { kA, kB };
enum class ReadStrobe { kMin, kMax };
enum class SchedulerKind { kFrFcfs, kFcfs };
enum class PagePolicyKind { kOpen, kClosed, kAdaptive };
enum class RefreshMode { kOff, kAllBank, kPerBank };

struct DramConfig {
  std::string memspec = "lpddr3_1600_4gb";  // a shipped name or a path
  std::uint32_t channels = 4;
  std::uint32_t ranks = 1;
  // Fields from the most significant to the least; a burst's bytes lie below the last. "column.3"
  // takes three of the column's bits at that place, a bare "column" those that are left. The
  // default puts 256 contiguous bytes on a channel.
  std::string mapping = "row:rank:bank:column:channel:column.3";
  BankHash bank_hash = BankHash::kNone;
  WriteLatencySet write_latency_set = WriteLatencySet::kA;
  ReadStrobe read_strobe = ReadStrobe::kMax;  // which tDQSCK a read's data arrive with

  SchedulerKind scheduler = SchedulerKind::kFrFcfs;
  std::uint32_t age_cap_cycles = 2000;  // older requests are no longer overtaken
  PagePolicyKind page_policy = PagePolicyKind::kOpen;
  // An entry is a run of bursts of one transaction in one row; queues are of one channel.
  std::uint32_t read_queue_entries = 32;
  std::uint32_t write_queue_entries = 32;
  std::uint32_t write_high_watermark = 24;  // entries: writing begins
  std::uint32_t write_low_watermark = 8;    // entries: reading resumes
  bool posted_writes = true;                // a write is answered when it is queued
  // The way through the controller and the PHY: of a request to its first command, and of a datum
  // (or of the answer to a write that is not posted) back. gem5's defaults are 10 and 10
  // (src/mem/MemCtrl.py: static_frontend_latency, static_backend_latency).
  double front_end_ns = 10;
  double back_end_ns = 10;

  RefreshMode refresh = RefreshMode::kPerBank;  // LPDDR has it; the other banks go on
  std::uint32_t refresh_postpone_max = 0;      // refresh commands that may be owed
  std::uint32_t power_down_idle_cycles = 0;    // of a rank, until power-down; 0: never
  std::uint32_t self_refresh_idle_cycles = 0;  // of a rank, until self-refresh; 0: never

  std::string current_set;     // of the memspec; empty: its default
  double io_pj_per_bit = 3.0;  // stated adder; no published set separates VDDQ

  // InputError naming the key, what it is and what is allowed. Loads the memspec.
  void validate() const;
};

void visit(ConfigVisitor& v, DramConfig& config);

}  // namespace sgs
