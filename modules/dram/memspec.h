// A DRAM device: organisation, timing, currents, and where each number comes from.
// One JSON file each under modules/dram/memspecs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "modules/config/config_visitor.h"

namespace sgs {

// Which bank a per-bank refresh goes to: the one that the device's counter names, or one that the
// controller names. Each has its turn before any has a second one.
enum class RefreshOrder { kInTurn, kAny };

constexpr const char* kDefaultSource = "default";

struct Memspec {
  struct Organisation {
    std::uint32_t width_bits = 0;         // data bus of a channel, or of a pseudo-channel
    std::uint32_t burst_length = 0;       // beats
    std::uint32_t beats_per_clock = 2;    // of the data bus
    std::uint32_t pseudo_channels = 1;    // of a channel, each with a data bus and banks of its own
    std::uint32_t banks = 0;              // banks of a rank
    std::uint32_t bank_groups = 1;        // bank b is of group b % bank_groups
    std::uint32_t banks_per_refresh = 1;  // neighbours that a per-bank refresh takes together
    std::uint32_t rows = 0;               // rows of a bank
    std::uint32_t columns = 0;            // columns of a row, each width_bits wide
  };

  // Cycles of the command bus that a command takes. Timings count from the last of them.
  struct CommandBus {
    std::uint32_t activate = 1;
    std::uint32_t activate_gap = 0;  // between the two of an activate; others may come in them
    std::uint32_t column = 1;        // read, write
    std::uint32_t row = 1;           // precharge, refresh, self-refresh
    std::uint32_t buses = 1;         // 2: columns have one of their own
  };

  // Clock cycles. Names follow JESD209-3 (tRCD is rcd).
  struct Timing {
    std::uint32_t read_latency = 0;     // RL
    std::uint32_t write_latency_a = 0;  // WL of mode-register set A
    std::uint32_t write_latency_b = 0;  // WL of set B
    std::uint32_t dqss = 1;             // tDQSS
    std::uint32_t rcd = 0;
    std::uint32_t rcd_write = 0;  // where it is another than a read's
    std::uint32_t rp_bank = 0;    // tRPpb
    std::uint32_t rp_all = 0;     // tRPab
    std::uint32_t ras = 0;
    std::uint32_t rc = 0;
    std::uint32_t ccd = 0;  // to another bank group, where there are groups; rrd and wtr likewise
    std::uint32_t rrd = 0;
    std::uint32_t faw = 0;
    std::uint32_t rtp = 0;
    std::uint32_t wr = 0;
    std::uint32_t wtr = 0;
    std::uint32_t ccd_l = 0;        // within a bank group
    std::uint32_t ccd_l_write = 0;  // of writes, where it is another than a read's
    std::uint32_t rrd_l = 0;
    std::uint32_t wtr_l = 0;
    std::uint32_t rtw = 0;  // read to write command, where it is no sum of the others
    std::uint32_t dqsck_min = 0;
    std::uint32_t dqsck_max = 0;
    std::uint32_t rfc_all = 0;    // tRFCab
    std::uint32_t rfc_bank = 0;   // tRFCpb
    std::uint32_t refi = 0;       // one all-bank refresh each
    std::uint32_t refi_bank = 0;  // one per-bank refresh each
    std::uint32_t pbr2pbr = 0;    // per-bank refreshes of different banks, where not rfc_bank
    std::uint32_t pbr2act = 0;    // per-bank refresh to activate of another bank, where not rrd
    std::uint32_t xp = 0;
    std::uint32_t cke = 0;
    std::uint32_t cke_self_refresh = 0;  // tCKESR
    std::uint32_t xsr = 0;
    std::uint32_t rtrs = 0;     // bus hand-over between ranks
    std::uint32_t ras_max = 0;  // longest time a row may stay open
  };

  // Above 85 degrees Celsius.
  struct Hot {
    std::uint32_t refresh_divisor = 4;  // of refi and refi_bank
    double derating_ns = 1.875;         // added to tRCD, tRP, tRAS, tRC, tRRD
    double pbr2pbr_ns = 0;              // where it is another than the cold one
  };

  struct Rail {  // mA
    double idd0 = 0, idd2p = 0, idd2n = 0, idd3p = 0, idd3n = 0;
    double idd4r = 0, idd4w = 0, idd5 = 0, idd6 = 0;
  };
  // VDD1 and VDD2 of one rank. No source separates VDDCA and VDDQ: I/O power is not in it.
  struct Currents {
    double vdd1_v = 0;
    double vdd2_v = 0;
    Rail vdd1_ma;
    Rail vdd2_ma;
  };

  std::string name;
  std::string description;
  Organisation organisation;
  CommandBus command_bus;
  double clock_period_ns = 0;
  Timing timing_cycles;
  RefreshOrder refresh_order = RefreshOrder::kInTurn;
  std::uint32_t refresh_postpone_limit = 8;  // refreshes that the standard lets wait
  Hot hot;
  double io_pj_per_bit = -1;      // of each transferred bit; negative: not stated
  double io_pj_per_bit_low = 0;   // least that the sources allow; 0: LPDDR3's 2 to the 3 taken
  double io_pj_per_bit_high = 0;  // most; 0: LPDDR3's 4 to the 3 taken
  double current_spread = 0;      // factor on the currents, both ways; 0: see spread_of_currents()
  std::string default_currents;   // which set is used when none is asked for
  std::map<std::string, Currents> currents;  // by the name of the published set
  std::vector<std::string> notes;            // what reading it left open, a line each
  // [key] source of a number; [kDefaultSource]: of all that have none of their own.
  std::map<std::string, std::string> sources;

  std::uint32_t burst_bytes() const {
    return organisation.width_bits / 8 * organisation.burst_length;
  }
  std::uint32_t burst_cycles() const {
    return organisation.burst_length / organisation.beats_per_clock;
  }
  std::uint32_t refresh_sets() const { return organisation.banks / organisation.banks_per_refresh; }
  // Per-bank refreshes of a set in the interval of an all-bank one, whose rows they share.
  std::uint32_t refreshes_of_set() const {
    const std::uint32_t all_sets = timing_cycles.refi_bank * refresh_sets();
    return std::max(1U, (timing_cycles.refi + all_sets / 2) / all_sets);
  }
  double least_io_pj_per_bit() const {
    return io_pj_per_bit_low > 0 ? io_pj_per_bit_low : io_pj_per_bit * 2 / 3;
  }
  double most_io_pj_per_bit() const {
    return io_pj_per_bit_high > 0 ? io_pj_per_bit_high : io_pj_per_bit * 4 / 3;
  }
  // Several sets tell by themselves how far currents are known. LPDDR3's two differ by this factor
  // at most, at random (testbench/dram).
  double spread_of_currents() const {
    constexpr double kOfOneSet = 1.4;
    if (current_spread > 0) return current_spread;
    return currents.size() > 1 ? 1 : kOfOneSet;
  }
  std::uint32_t row_bytes() const { return organisation.columns * organisation.width_bits / 8; }
  std::uint32_t bursts_per_row() const { return row_bytes() / burst_bytes(); }
  std::uint64_t rank_bytes() const {
    return std::uint64_t{row_bytes()} * organisation.rows * organisation.banks;
  }
  // Of one data bus.
  double peak_gb_per_s() const { return burst_bytes() / (burst_cycles() * clock_period_ns); }
};

void visit(ConfigVisitor& v, Memspec& memspec);

// Behind a name or path: the memspec as it is when hot.
constexpr const char* kHotSuffix = ":hot";

// The file that the name of a shipped memspec, or else a path, stands for; it may not be there.
std::string memspec_path(const std::string& name_or_path);

// Reads a memspec: the name of a shipped one ("lpddr3_1600_4gb") or the path of a JSON file, ours
// or DRAMSys's, either with kHotSuffix. InputError: not there, not readable as strict JSON, a
// number that is missing or has no source, or impossible (see check_memspec).
Memspec load_memspec(const std::string& name_or_path);

// Names of the shipped memspecs, sorted.
std::vector<std::string> shipped_memspecs();

// Refuses what no device can be (InputError naming the key). Returns its notes and one warning a
// place where published tables disagree by a rounded cycle.
std::vector<std::string> check_memspec(const Memspec& memspec, const std::string& origin);

}  // namespace sgs
