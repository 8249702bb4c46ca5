// Energy: state residencies and joules against hand calculation from the currents.
#include <catch2/catch.hpp>
#include <map>
#include <numeric>
#include <string>

#include "modules/dram/dram_energy.h"
#include "modules/dram/queued_channel.h"

namespace sgs {
namespace {

using C = Command;

// One rank of LPDDR3-1600 with the currents of Micron's EDF8132A1MC; per cycle of 1.25 ns a mA is
// 2.25 pJ on VDD1 (1.8 V) and 1.5 pJ on VDD2 (1.2 V).
constexpr double kActivatePj =
    2.25 * (8 * 48 - 2 * 34 - 0.8 * 14) + 1.5 * (60 * 48 - 34 * 34 - 26 * 14);
constexpr double kReadPj = 1.5 * (230 - 34) * 4;
constexpr double kWritePj = 1.5 * (190 - 34) * 4;
constexpr double kRefreshPj = 2.25 * (28 - 2) * 104 + 1.5 * (150 - 34) * 104;
constexpr double kActivePj = 2.25 * 2 + 1.5 * 34;        // a cycle of active standby
constexpr double kPrechargedPj = 2.25 * 0.8 + 1.5 * 26;  // of precharged standby
constexpr double kActiveDownPj = 2.25 * 1.4 + 1.5 * 11;  // of active power-down
constexpr double kPrechargedDownPj = 2.25 * 0.8 + 1.5 * 1.8;
constexpr double kSelfRefreshPj = 2.25 * 0.5 + 1.5 * 1.8;

DramConfig one_channel() {
  DramConfig c;
  c.channels = 1;
  c.refresh = RefreshMode::kAllBank;
  return c;
}

struct Meter : CommandSink {
  explicit Meter(const DramConfig& config = one_channel())
      : memspec(load_memspec(config.memspec)), activity(memspec, config) {}
  void on_command(const CommandRecord& record) override { activity.on_command(record); }
  void send(std::uint64_t cycle, C command, std::uint8_t bank = 0, std::uint8_t region = 0) {
    activity.on_command({cycle, command, 0, 0, bank, region, 0, 0});
  }
  DramEnergy energy(std::uint64_t cycle, double io = 0) const {
    return dram_energy(memspec, memspec.currents.at("micron_edf8132a1mc"), activity.ranks(cycle),
                       activity.regions(), io);
  }
  Memspec memspec;
  ActivityMeter activity;
};

double regions_and_shared(const DramEnergy& e) {
  return std::accumulate(e.by_region_pj.begin(), e.by_region_pj.end(), e.shared_pj);
}

TEST_CASE("energy: residencies of a hand-written command sequence") {
  Meter m;
  m.send(100, C::kActivate, 0);
  m.send(140, C::kActivate, 1);
  m.send(200, C::kPrecharge, 0);
  m.send(260, C::kPrecharge, 1);    // active 100..260
  m.send(300, C::kRefreshAll);      // active 300..404
  m.send(500, C::kPowerDownEnter);  // precharged power-down 500..700
  m.send(700, C::kPowerDownExit);
  m.send(710, C::kActivate, 2);
  m.send(800, C::kPowerDownEnter);  // active 710..800, active power-down 800..900
  m.send(900, C::kPowerDownExit);
  m.send(1000, C::kPrechargeAll);  // active 900..1000
  m.send(1100, C::kSelfRefreshEnter);
  m.send(2000, C::kSelfRefreshExit);
  const RankActivity a = m.activity.ranks(3000).at(0);
  CHECK(a.active_cycles == 160 + 104 + 90 + 100);
  CHECK(a.precharged_power_down_cycles == 200);
  CHECK(a.active_power_down_cycles == 100);
  CHECK(a.self_refresh_cycles == 900);
  CHECK(a.precharged_cycles == 3000 - 454 - 200 - 100 - 900);
  CHECK(m.energy(3000).total_pj() ==
        Approx(3 * kActivatePj + kRefreshPj + 454 * kActivePj + 1346 * kPrechargedPj +
               100 * kActiveDownPj + 200 * kPrechargedDownPj + 900 * kSelfRefreshPj));
}

TEST_CASE("energy: an auto-precharge closes its bank when the precharge starts") {
  Meter m;
  m.send(100, C::kActivate);
  m.send(115, C::kReadAuto);  // precharge at max(115 + tRTP, 100 + tRAS) = 134
  CHECK(m.activity.ranks(1000).at(0).active_cycles == 34);
  m.send(1000, C::kActivate);
  m.send(1020, C::kWriteAuto);  // at 1020 + WL + 1 + BL/2 + tWR = 1043
  CHECK(m.activity.ranks(2000).at(0).active_cycles == 34 + 43);
}

TEST_CASE("energy: counts go to the regions that caused them, and all adds up") {
  Meter m;
  m.send(0, C::kActivate, 0, 3);
  m.send(15, C::kRead, 0, 3);
  m.send(19, C::kRead, 0, 4);
  m.send(60, C::kWrite, 0, 5);
  const DramEnergy e = m.energy(1000, 2.0);
  const double io = 2.0 * 8 * 32;
  CHECK(e.by_region_pj[3] == Approx(kActivatePj + kReadPj + io));
  CHECK(e.by_region_pj[4] == Approx(kReadPj + io));
  CHECK(e.by_region_pj[5] == Approx(kWritePj + io));
  CHECK(regions_and_shared(e) == Approx(e.total_pj()));
  CHECK(e.vdd2.io_pj == Approx(3 * io));
}

TEST_CASE("energy: the published events of the source agree") {
  // lpddr3 sources: 2731.7 pJ with times in ns (tRC 60, tRAS 42); ours rounds tRAS to 42.5 ns.
  CHECK(kActivatePj == Approx(2731.7).epsilon(0.003));
  CHECK(kReadPj == Approx(1176.0));
  CHECK(kWritePj == Approx(936.0));
  CHECK(kRefreshPj == Approx(24180.0));
  CHECK(kActivePj / 1.25 == Approx(44.4));
}

TEST_CASE("energy: per-bank refreshes of all rows take what an all-bank refresh takes") {
  for (const std::string& name : shipped_memspecs()) {
    INFO(name);
    const Memspec m = load_memspec(name);
    const auto of = [&](std::uint64_t all, std::uint64_t bank) {
      RankActivity rank;
      rank.refreshes_all = all;
      rank.refreshes_bank = bank;
      return dram_energy(m, m.currents.at(m.default_currents), {rank}, {}, 0).total_pj();
    };
    const Memspec::Timing& t = m.timing_cycles;
    const std::uint32_t refreshes = (t.refi + t.refi_bank / 2) / t.refi_bank;
    CHECK(of(0, refreshes) == Approx(of(1, 0)));
  }
}

TEST_CASE("energy: a bit of whole rows read in sequence takes what is published") {
  for (const auto& [name, pj] :
       std::map<std::string, double>{{"hbm2e_3200_16gb", 3.9}, {"hbm3_6400_16gb", 3.9}}) {
    INFO(name);
    const Memspec m = load_memspec(name);
    RankActivity rank;
    rank.activates = 1;
    rank.reads = m.bursts_per_row();
    rank.active_cycles = rank.reads * m.burst_cycles();
    const DramEnergy energy =
        dram_energy(m, m.currents.at(m.default_currents), {rank}, {}, m.io_pj_per_bit);
    CHECK(energy.total_pj() / (8.0 * m.row_bytes()) == Approx(pj).epsilon(0.04));
  }
}

TEST_CASE("energy: a sequential and a random stream equal the hand calculation to 0.1 %") {
  for (const bool sequential : {true, false}) {
    const DramConfig config = one_channel();
    Meter m(config);
    QueuedChannel channel(config, m.memspec, 0, m);
    constexpr std::uint64_t kRequests = 200000;
    std::uint64_t cycle = 0;
    std::uint64_t state = 1;
    for (std::uint64_t i = 0; i < kRequests; ++i) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      ChannelRequest r;
      r.region = static_cast<std::uint8_t>(i % 3);
      r.bank = static_cast<std::uint32_t>(sequential ? i / 128 % 8 : state >> 61);
      r.row = static_cast<std::uint32_t>(sequential ? i / 1024 : state >> 40 & 16383);
      r.burst = static_cast<std::uint32_t>(sequential ? i % 128 : 0);
      while (channel.full(Direction::kRead)) channel.advance(cycle = channel.next_decision() + 1);
      channel.push(r, cycle);
    }
    while (!channel.empty()) channel.advance(cycle = channel.next_decision() + 1);
    const RankActivity a = m.activity.ranks(cycle).at(0);
    const double n = kRequests;
    // By hand: an activate a row and after each refresh (sequential) or for each request; one
    // refresh each tREFI; active all the time but for tRPab before each refresh.
    const double refreshes = static_cast<double>(cycle / 3120);
    const double activates = sequential ? n / 128 + refreshes : n;
    const double precharged = 17 * refreshes;
    const double by_hand = activates * kActivatePj + n * kReadPj + refreshes * kRefreshPj +
                           (static_cast<double>(cycle) - precharged) * kActivePj +
                           precharged * kPrechargedPj;
    INFO((sequential ? "sequential" : "random") << ", " << a.activates << " activates");
    const DramEnergy e = m.energy(cycle);
    CHECK(e.total_pj() == Approx(by_hand).epsilon(0.001));
    CHECK(regions_and_shared(e) == Approx(e.total_pj()).epsilon(1e-12));
  }
}

}  // namespace
}  // namespace sgs
