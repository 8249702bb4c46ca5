// Energy of DRAM by the currents of its data sheet: what commands add to what states draw.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "modules/dram/command.h"
#include "modules/dram/dram_config.h"
#include "modules/dram/memspec.h"

namespace sgs {

// Picojoules of one rail or of several together.
struct EnergyParts {
  double activate_pj = 0;  // activate and precharge, above standby
  double read_pj = 0;      // above active standby
  double write_pj = 0;
  double refresh_pj = 0;  // above active standby
  double active_standby_pj = 0;
  double precharged_standby_pj = 0;
  double power_down_pj = 0;
  double self_refresh_pj = 0;
  double io_pj = 0;  // stated adder, not of the currents

  double total_pj() const {
    return activate_pj + read_pj + write_pj + refresh_pj + active_standby_pj +
           precharged_standby_pj + power_down_pj + self_refresh_pj + io_pj;
  }
  EnergyParts& operator+=(const EnergyParts& other);
};

struct DramEnergy {
  EnergyParts vdd1;
  EnergyParts vdd2;                        // io_pj, which no rail is published for, is counted here
  std::array<double, 256> by_region_pj{};  // activate, read, write and I/O of its requests
  double shared_pj = 0;                    // standby, low-power states and refresh
  double total_pj() const { return vdd1.total_pj() + vdd2.total_pj(); }
};

// Activity of a rank: counts of commands, and cycles in each state.
struct RankActivity {
  std::uint64_t activates = 0;
  std::uint64_t reads = 0;   // bursts
  std::uint64_t writes = 0;  // bursts
  std::uint64_t refreshes_all = 0;
  std::uint64_t refreshes_bank = 0;
  std::uint64_t active_cycles = 0;  // a bank open or refreshing
  std::uint64_t precharged_cycles = 0;
  std::uint64_t active_power_down_cycles = 0;
  std::uint64_t precharged_power_down_cycles = 0;
  std::uint64_t self_refresh_cycles = 0;
};

struct RegionActivity {
  std::uint64_t activates = 0;
  std::uint64_t reads = 0;
  std::uint64_t writes = 0;
};

// Follows the commands of all channels.
class ActivityMeter {
 public:
  ActivityMeter(const Memspec& memspec, const DramConfig& config);

  // Commands of a channel in the order of their cycles.
  void on_command(const CommandRecord& record);

  // Activity up to `cycle`, not before any command; by channel * ranks + rank.
  std::vector<RankActivity> ranks(std::uint64_t cycle) const;
  const std::array<RegionActivity, 256>& regions() const { return regions_; }

 private:
  enum class Low { kNone, kActivePowerDown, kPrechargedPowerDown, kSelfRefresh };
  struct State {
    RankActivity done;
    std::uint64_t open_banks = 0;  // bit b: bank b is open
    bool active = false;           // an active interval has begun and may still last
    std::uint64_t active_since = 0;
    std::uint64_t active_until = 0;  // with no bank open: when the last closes or refreshes
    Low low = Low::kNone;
    std::uint64_t low_since = 0;
  };

  void begin_active(State& s, std::uint64_t cycle) const;
  static void end_active(State& s, std::uint64_t cycle);
  void close(State& s, std::uint32_t bank, std::uint64_t cycle) const;
  static void end_low(State& s, std::uint64_t cycle);

  const Memspec::Timing t_;
  const std::uint32_t write_to_precharge_;
  const std::uint32_t ranks_per_channel_;
  std::vector<State> state_;
  std::vector<std::uint64_t> activated_;  // by rank and bank: when
  std::uint32_t banks_;
  std::array<RegionActivity, 256> regions_{};
};

// The Micron method on two rails: activate-precharge (IDD0 tRC - IDD3N tRAS - IDD2N (tRC - tRAS)),
// read and write (IDD4 - IDD3N) BL/2, refresh (IDD5 - IDD3N) tRFCab (a per-bank one: by the
// share of its rows, its own current is not published), standby IDD3N and IDD2N, power-down IDD3P
// and IDD2P, self-refresh IDD6; times voltage and time.
DramEnergy dram_energy(const Memspec& memspec, const Memspec::Currents& currents,
                       const std::vector<RankActivity>& ranks,
                       const std::array<RegionActivity, 256>& regions, double io_pj_per_bit);

// The energy by the configured set of currents, and what is known of it.
struct DramEnergyBand : DramEnergy {
  std::map<std::string, double> by_current_set_pj;  // all that are published
  // Of all sets, with the ends of their spread and of the I/O's band.
  double least_pj = 0, most_pj = 0;
  // Numbers that the memspec lacks and that the activity needs: "currents and I/O energy", "idd6".
  // Empty: the energy is known.
  std::string not_stated;
};
DramEnergyBand dram_energy_band(const Memspec& memspec, const DramConfig& config,
                                const std::vector<RankActivity>& ranks,
                                const std::array<RegionActivity, 256>& regions);

}  // namespace sgs
