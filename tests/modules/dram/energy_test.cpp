// Energy: state residencies and joules against hand calculation from the currents.
#include <catch2/catch.hpp>
#include <functional>
#include <initializer_list>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "modules/dram/dram_energy.h"
#include "modules/dram/queued_channel.h"
#include "modules/dram/rest.h"

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

// A rank that reads 100 bursts in 10,000 cycles of active standby.
DramEnergyBand band_of(const Memspec& memspec, const DramConfig& config) {
  RankActivity rank;
  rank.reads = 100;
  rank.active_cycles = 10000;
  return dram_energy_band(memspec, config, {rank}, {});
}

TEST_CASE("energy: its band spans the published sets, and what is known of I/O") {
  DramConfig config;
  const Memspec m = load_memspec(config.memspec);
  constexpr double kBits = 100 * 8 * 32;
  const double micron = 100 * kReadPj + 10000 * kActivePj;
  const double drampower =
      100 * 4 * (2.25 * (5 - 2) + 1.5 * (260 - 45)) + 10000 * (2.25 * 2 + 1.5 * 45);
  const DramEnergyBand band = band_of(m, config);
  CHECK(band.total_pj() == Approx(micron + 3 * kBits));
  CHECK(band.by_current_set_pj.at("drampower4") == Approx(drampower + 3 * kBits));
  CHECK(band.least_pj == Approx(micron + 2 * kBits));
  CHECK(band.most_pj == Approx(drampower + 4 * kBits));
  config.current_set = "drampower4";
  CHECK(band_of(m, config).total_pj() == Approx(drampower + 3 * kBits));
  CHECK(band_of(m, config).least_pj == Approx(band.least_pj));
  config.io_pj_per_bit = 5;
  CHECK(band_of(m, config).least_pj == Approx(micron + 5 * kBits));
  CHECK(band_of(m, config).most_pj == Approx(drampower + 5 * kBits));
}

TEST_CASE("energy: one set of currents has a spread, and I/O without a band LPDDR3's") {
  Memspec m = load_memspec("lpddr4_3200_8gb");
  REQUIRE(m.currents.size() == 1);
  DramConfig config;
  config.memspec = m.name;
  const double io = 3 * 100 * 8 * 32;
  const DramEnergyBand band = band_of(m, config);
  const double by_currents = band.total_pj() - io;
  CHECK(band.least_pj == Approx(by_currents / 1.4 + io * 2 / 3));
  CHECK(band.most_pj == Approx(by_currents * 1.4 + io * 4 / 3));
  m.current_spread = 1;
  m.io_pj_per_bit_low = m.io_pj_per_bit_high = m.io_pj_per_bit;
  CHECK(band_of(m, config).least_pj == Approx(band.total_pj()));
  CHECK(band_of(m, config).most_pj == Approx(band.total_pj()));
}

TEST_CASE("energy: it is not known without a number for what took place, by table") {
  struct Row {
    const char* not_stated;
    std::function<void(Memspec&, DramConfig&)> change;
  };
  const auto without = [](Memspec& m, std::initializer_list<double Memspec::Rail::*> currents) {
    for (auto& [name, set] : m.currents)
      for (double Memspec::Rail::*ma : currents) set.vdd1_ma.*ma = set.vdd2_ma.*ma = 0;
  };
  const auto without_any = [](Memspec& m) {
    for (auto& [name, set] : m.currents) set.vdd1_ma = set.vdd2_ma = {};
  };
  constexpr const char* kIo = "I/O energy (dram.io_pj_per_bit)";
  for (const Row& row : std::vector<Row>{
           {"", [](Memspec&, DramConfig&) {}},
           {"idd4r", [&](Memspec&m, DramConfig&) { without(m, {&Memspec::Rail::idd4r}); }},
           {"", [&](Memspec&m, DramConfig&) { without(m, {&Memspec::Rail::idd4w}); }},  // no write
           {"currents", [&](Memspec&m, DramConfig&) { without_any(m); }},
           {kIo, [](Memspec&m, DramConfig&) { m.io_pj_per_bit = 0; }},
           {"", [](Memspec&, DramConfig&c) { c.io_pj_per_bit = 0; }}}) {
    DramConfig config;
    Memspec m = load_memspec(config.memspec);
    row.change(m, config);
    CHECK(band_of(m, config).not_stated == row.not_stated);
  }
  DramConfig config;
  Memspec neither = load_memspec(config.memspec);
  without_any(neither);
  neither.io_pj_per_bit = 0;
  CHECK(band_of(neither, config).not_stated == std::string("currents and ") + kIo);
}

Rest one_channel_rest(BetweenFrames state, std::uint64_t cycles) {
  DramConfig config = one_channel();
  config.between_frames = state;
  return rest_of(config, load_memspec(config.memspec), cycles);
}

TEST_CASE("rest: self-refresh from tRPab on until it and a refresh just fit before the end") {
  constexpr std::uint64_t kCycles = 1000000;
  const Rest rest = one_channel_rest(BetweenFrames::kSelfRefresh, kCycles);
  const RankActivity& a = rest.ranks.at(0);
  CHECK(a.precharged_cycles == 17 + 112);
  CHECK(a.active_cycles == 104);
  CHECK(a.refreshes_all == 1);
  CHECK(a.self_refresh_cycles == kCycles - 17 - 112 - 104);
  CHECK(rest.self_refresh() == Approx((kCycles - 233.0) / kCycles));
  const double by_hand =
      (kCycles - 233) * kSelfRefreshPj + 129 * kPrechargedPj + 104 * kActivePj + kRefreshPj;
  CHECK(rest.energy.total_pj() == Approx(by_hand));
  CHECK(rest.energy.least_pj == Approx(by_hand));
  CHECK(rest.energy.most_pj > by_hand);
}

TEST_CASE("rest: power-down is left for every refresh, and tXP before the end") {
  constexpr std::uint64_t kCycles = 10 * 3120 + 1000;
  const Rest rest = one_channel_rest(BetweenFrames::kPowerDown, kCycles);
  const RankActivity& a = rest.ranks.at(0);
  CHECK(a.refreshes_all == 10);
  CHECK(a.precharged_cycles == 1 + 10 * 6 + 6);
  CHECK(a.active_cycles == 10 * 104);
  CHECK(a.precharged_power_down_cycles == kCycles - 67 - 1040);
  CHECK(rest.power_down() == Approx((kCycles - 1107.0) / kCycles));
  CHECK(rest.energy.total_pj() == Approx((kCycles - 1107) * kPrechargedDownPj + 67 * kPrechargedPj +
                                         1040 * kActivePj + 10 * kRefreshPj));
}

TEST_CASE("rest: standby by the idle keys, or where there is no room for sleep") {
  constexpr std::uint64_t kCycles = 10 * 3120 + 1000;
  const RankActivity up = one_channel_rest(BetweenFrames::kByIdleCycles, kCycles).ranks.at(0);
  CHECK(up.refreshes_all == 10);
  CHECK(up.precharged_cycles == kCycles - 10 * 104);
  for (const auto& [cycles, sleeps] : std::map<std::uint64_t, bool>{
           {0, false}, {1, false}, {100, false}, {17 + 1 + 12 + 216, false}, {247, true}}) {
    INFO(cycles);
    const Rest rest = one_channel_rest(BetweenFrames::kSelfRefresh, cycles);
    CHECK((rest.ranks.at(0).self_refresh_cycles > 0) == sleeps);
    if (!sleeps) CHECK(rest.ranks.at(0).precharged_cycles == cycles);
  }
}

TEST_CASE("rest: all ranks of all memories sleep, and are up at the end") {
  for (const std::string& name : shipped_memspecs()) {
    INFO(name);
    DramConfig config;
    config.memspec = name;
    config.channels = 2;
    config.ranks = 2;
    const Memspec m = load_memspec(name);
    constexpr std::uint64_t kCycles = 5000000;
    const Rest rest = rest_of(config, m, kCycles);
    REQUIRE(rest.ranks.size() == std::size_t{config.buses(m)} * 2);
    const Memspec::Timing& t = m.timing_cycles;
    const std::uint32_t apart = t.pbr2pbr > 0 ? t.pbr2pbr : t.rfc_bank;
    const std::uint64_t waking = t.xsr + (m.refresh_sets() - 1) * apart + t.rfc_bank;
    for (const RankActivity& rank : rest.ranks) {
      CHECK(rank.refreshes_bank == m.refresh_sets());
      CHECK(rank.self_refresh_cycles <= kCycles - waking);
      CHECK(rank.self_refresh_cycles + waking + t.rp_all + 8 > kCycles);
    }
  }
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
      while (channel.full(r)) channel.advance(cycle = channel.next_decision() + 1);
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
