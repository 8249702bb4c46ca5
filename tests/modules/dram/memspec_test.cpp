// Memspecs and configuration: what is shipped is sound, what cannot be is refused by name.
#include "modules/dram/memspec.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "algorithm/files/input_error.h"
#include "modules/config/strict_json.h"
#include "modules/dram/address_mapping.h"
#include "modules/dram/dram_config.h"
#include "tests/support/scratch_folder.h"

namespace sgs {
namespace {

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return error.what();
  }
  return "accepted";
}

std::string config_refusal(const std::function<void(DramConfig&)>& change) {
  DramConfig config;
  change(config);
  return refusal([&] { config.validate(); });
}

std::string memspec_refusal(const std::function<void(Memspec&)>& change) {
  Memspec m = load_memspec("lpddr3_1600_4gb");
  change(m);
  return refusal([&] { check_memspec(m, "file"); });
}

TEST_CASE("memspecs: every shipped one loads, prints and reads back") {
  const std::vector<std::string> names = shipped_memspecs();
  CHECK(names == std::vector<std::string>{"ddr5_4800_16gb", "hbm2e_3200_16gb", "hbm3_6400_16gb",
                                          "lpddr3_1600_4gb", "lpddr3_1600_8gb", "lpddr3_1866_4gb",
                                          "lpddr3_2133_4gb", "lpddr4_3200_8gb", "lpddr4x_4266_8gb",
                                          "lpddr5_6400_8gb", "lpddr5x_8533_8gb"});
  for (const std::string& name : names) {
    const Memspec m = load_memspec(name);
    CHECK(m.name == name);
    CHECK(m.burst_bytes() == (name == "ddr5_4800_16gb" ? 64 : 32));
    ConfigDocument document;
    document.add_text(config_to_json(m), name);
    Memspec back;
    document.read_into(back);
    CHECK(config_to_json(back) == config_to_json(m));
    DramConfig config;
    config.memspec = name;
    config.validate();
  }
}

// JESD79-5, 4.13: same-bank refreshes of DDR5 come twice as often, with half of the rows each.
TEST_CASE("memspecs: per-bank refreshes reach all banks as often as all-bank ones") {
  for (const std::string& name : shipped_memspecs()) {
    INFO(name);
    const Memspec m = load_memspec(name);
    CHECK(m.refreshes_of_set() == (name == "ddr5_4800_16gb" ? 2 : 1));
    CHECK(m.timing_cycles.refi_bank * m.refresh_sets() * m.refreshes_of_set() ==
          Approx(m.timing_cycles.refi).epsilon(1e-3));
  }
  const std::vector<std::string> none = check_memspec(load_memspec("ddr5_4800_16gb"), "file");
  CHECK(none.empty());
}

TEST_CASE("memspecs: each has a rule for heat, which keeps to its own limits") {
  for (const std::string& name : shipped_memspecs()) {
    INFO(name);
    const Memspec cold = load_memspec(name), hot = load_memspec(name + kHotSuffix);
    const std::uint32_t divisor = name == "ddr5_4800_16gb" ? 2 : 4;
    CHECK(hot.name == name + kHotSuffix);
    CHECK(hot.timing_cycles.refi == cold.timing_cycles.refi / divisor);
    CHECK(hot.timing_cycles.refi_bank == cold.timing_cycles.refi_bank / divisor);
    const double more = (hot.timing_cycles.rcd - cold.timing_cycles.rcd) * cold.clock_period_ns;
    CHECK(more >= cold.hot.derating_ns);
    CHECK(more < cold.hot.derating_ns + cold.clock_period_ns);
    CHECK(hot.timing_cycles.wr == cold.timing_cycles.wr);
    CHECK(memspec_path(name + kHotSuffix) == memspec_path(name));
  }
  // Of LPDDR3-1600, 1.875 ns are 2 cycles.
  const Memspec::Timing t = load_memspec("lpddr3_1600_4gb:hot").timing_cycles;
  CHECK(t.rcd == 17);
  CHECK(t.rp_bank == 17);
  CHECK(t.rp_all == 19);
  CHECK(t.ras == 36);
  CHECK(t.rc == 50);
  CHECK(t.rrd == 10);
  CHECK(t.refi == 780);
  CHECK(t.rcd_write == 0);
  CHECK(load_memspec("lpddr4_3200_8gb").timing_cycles.pbr2pbr == 0);
  CHECK(load_memspec("lpddr4_3200_8gb:hot").timing_cycles.pbr2pbr == 144);
}

TEST_CASE("memspecs: published tables that disagree by a cycle are named") {
  const auto warnings = check_memspec(load_memspec("lpddr3_1600_4gb"), "file");
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0].find("rc is 48 but ras + rp_bank is 49") != std::string::npos);
  CHECK(warnings[1].find("WL is 6 (set A) or 9 (set B)") != std::string::npos);
}

using MemspecChange = std::function<void(Memspec&)>;

TEST_CASE("memspecs: the impossible is refused with the key's name") {
  using M = Memspec;
  for (const auto& [expected, change] : std::map<std::string, MemspecChange>{
           {"timing_cycles.ras_max: got 3120, expected more than refi 3120",
            [](M& m) { m.timing_cycles.ras_max = m.timing_cycles.refi; }},
           {"organisation.banks: got 0", [](M& m) { m.organisation.banks = 0; }},
           {"organisation.rows: got 49152, expected a power of two",
            [](M& m) { m.organisation.rows = 49152; }},
           {"organisation.columns: got 4, expected a multiple of burst_length 8",
            [](M& m) { m.organisation.columns = 4; }},
           {"timing_cycles.rcd: got 0", [](M& m) { m.timing_cycles.rcd = 0; }},
           {"timing_cycles.ccd: got 3, expected at least burst_length / beats_per_clock = 4",
            [](M& m) { m.timing_cycles.ccd = 3; }},
           {"timing_cycles.ras: got 10, expected at least rcd 15",
            [](M& m) { m.timing_cycles.ras = 10; }},
           {"io_pj_per_bit: got nothing", [](M& m) { m.io_pj_per_bit = M().io_pj_per_bit; }},
           {"io_pj_per_bit_low: got 3.5, expected at most io_pj_per_bit 3",
            [](M& m) { m.io_pj_per_bit_low = 3.5; }},
           {"io_pj_per_bit_high: got 2.5, expected at least io_pj_per_bit 3",
            [](M& m) { m.io_pj_per_bit_high = 2.5; }},
           {"current_spread: got 0.5, expected at least 1, or 0",
            [](M& m) { m.current_spread = 0.5; }},
           {"sources.fawn: unknown key", [](M& m) { m.sources["fawn"] = "x"; }},
           {"default_currents: got 'none'", [](M& m) { m.default_currents = "none"; }}}) {
    INFO(expected);
    CHECK(memspec_refusal(change).find("file: " + expected) == 0);
  }
}

TEST_CASE("memspecs: data rate, groups and sets of banks that cannot be are refused") {
  const auto of_lpddr5 = [](const MemspecChange& change) {
    Memspec m = load_memspec("lpddr5_6400_8gb");
    change(m);
    return refusal([&] { check_memspec(m, "file"); });
  };
  for (const auto& [expected, change] : std::map<std::string, MemspecChange>{
           {"organisation.beats_per_clock: got 3, expected a power of two, at most burst_length 16",
            [](Memspec& m) { m.organisation.beats_per_clock = 3; }},
           {"organisation.beats_per_clock: got 32",
            [](Memspec& m) { m.organisation.beats_per_clock = 32; }},
           {"organisation.pseudo_channels: got 4, expected a power of two, at most burst_length / "
            "beats_per_clock = 2",
            [](Memspec& m) { m.organisation.pseudo_channels = 4; }},
           {"organisation.bank_groups: got 32, expected a power of two, at most banks 16",
            [](Memspec& m) { m.organisation.bank_groups = 32; }},
           {"organisation.banks_per_refresh: got 3",
            [](Memspec& m) { m.organisation.banks_per_refresh = 3; }},
           {"timing_cycles.ccd_l: got 4, expected 0: organisation.bank_groups is 1",
            [](Memspec& m) { m.organisation.bank_groups = 1; }},
           {"timing_cycles.ccd_l: got 1, expected at least ccd 2",
            [](Memspec& m) { m.timing_cycles.ccd_l = 1; }},
           {"timing_cycles.rrd_l: got 0, expected at least rrd 4",
            [](Memspec& m) { m.timing_cycles.rrd_l = 0; }},
           {"timing_cycles.wtr_l: got 4, expected at least wtr 5",
            [](Memspec& m) { m.timing_cycles.wtr_l = 4; }},
           {"timing_cycles.ccd_l_write: got 1, expected at least ccd 2",
            [](Memspec& m) { m.timing_cycles.ccd_l_write = 1; }},
           {"timing_cycles.rcd_write: got 35, expected at most ras 34",
            [](Memspec& m) { m.timing_cycles.rcd_write = 35; }},
           {"timing_cycles.pbr2pbr: got 97, expected at most rfc_bank 96",
            [](Memspec& m) { m.timing_cycles.pbr2pbr = 97; }},
           {"command_bus.activate: got 4, expected 2: activate_gap parts two commands",
            [](Memspec& m) { m.command_bus.activate = 4; }},
           {"command_bus.column: got 3, expected at most ccd 2",
            [](Memspec& m) { m.command_bus.column = 3; }},
           {"timing_cycles.pbr2act: got 3, expected at least rrd 4",
            [](Memspec& m) { m.timing_cycles.pbr2act = 3; }},
           {"timing_cycles.refi_bank: got 72, expected more than pbr2pbr 72",
            [](Memspec& m) { m.timing_cycles.refi_bank = 72; }}}) {
    INFO(expected);
    CHECK(of_lpddr5(change).find("file: " + expected) == 0);
  }
}

TEST_CASE("memspecs: one default source is enough, and a number may have its own") {
  const auto with = [](const std::map<std::string, std::string>& sources) {
    return memspec_refusal([&](Memspec& m) { m.sources = sources; });
  };
  CHECK(with({{"default", "the data sheet"}}) == "accepted");
  CHECK(with({{"default", "the data sheet"}, {"faw", "measured"}}) == "accepted");
  CHECK(with({{"faw", "measured"}}) ==
        "file: sources.read_latency: got nothing, expected where 'read_latency' comes from, or "
        "sources.default");
  CHECK(with({{"default", ""}}).find("file: sources.read_latency: got nothing") == 0);
}

TEST_CASE("memspecs: the I/O energy is the device's unless the configuration has its own") {
  Memspec m = load_memspec("lpddr4_3200_8gb");
  m.io_pj_per_bit = 5;
  DramConfig config;
  CHECK(config.io_pj_per_bit_of(m).middle == 5);
  config.io_pj_per_bit = 0;
  CHECK(config.io_pj_per_bit_of(m).middle == 0);
  for (const std::string& name : shipped_memspecs()) {
    INFO(name);
    const Memspec shipped = load_memspec(name);
    CHECK((shipped.io_pj_per_bit > 0 && shipped.io_pj_per_bit <= 3));
    CHECK(shipped.sources.count("io_pj_per_bit") == 1);
  }
}

TEST_CASE("memspecs: the commented template reads back as the memspec, each number explained") {
  const Memspec m = load_memspec("lpddr3_1600_4gb");
  const std::string text = config_to_commented_json(m);
  ConfigDocument document;
  document.add_text(text, "template");
  Memspec back;
  document.read_into(back);
  CHECK(config_to_json(back) == config_to_json(m));
  CHECK(text.find("\"faw\": 40,  // 1..1000000: tFAW: window of at most four activates") !=
        std::string::npos);
  std::istringstream lines(text.substr(0, text.find("\"sources\"")));
  for (std::string line; std::getline(lines, line);) {
    INFO(line);
    const bool number = line.find_first_of("0123456789", line.find("\": ")) != std::string::npos;
    if (line.find("\": ") != std::string::npos && number) {
      CHECK(line.find("  // ") != std::string::npos);
    }
  }
}

TEST_CASE("memspecs: refresh that leaves requests no room is refused, a cycle less is not") {
  struct Row {
    std::uint32_t Memspec::Timing::*key;
    std::uint32_t refused, accepted;
    const char* message;
  };
  using T = Memspec::Timing;
  // rfc_all 104, rcd 15, refi_bank 390, rfc_bank 48, rrd 8, ras 34, rp_bank 15, 8 banks.
  for (const Row& row : std::vector<Row>{
           {&T::refi, 104, 120, "refi: got 104, expected more than rfc_all 104 + rcd 15"},
           {&T::refi, 119, 120, "refi: got 119, expected more than rfc_all 104 + rcd 15"},
           {&T::refi_bank, 48, 49, "refi_bank: got 48, expected more than rfc_bank 48"},
           {&T::rrd, 390, 389, "rrd: got 390, expected less than refi_bank 390"},
           {&T::faw, 1560, 1559, "faw: got 1560, expected less than 4 x refi_bank 390"},
           {&T::ras, 3049, 3048, "refi_bank: got 390, expected 8 banks x refi_bank above 3120"}}) {
    const auto with = [&](std::uint32_t value) {
      return memspec_refusal([&](Memspec& m) {
        T& t = m.timing_cycles;
        t.*row.key = value;
        t.faw = std::max(t.faw, t.rrd);
        t.rc = std::max(t.rc, t.ras);
      });
    };
    INFO(row.message);
    CHECK(with(row.refused).find("file: timing_cycles." + std::string(row.message)) == 0);
    CHECK(with(row.accepted) == "accepted");
  }
  CHECK(memspec_refusal([](Memspec& m) {
          m.command_bus = {4, 0, 4, 2, 1};
          m.timing_cycles.refi = 123;
        }) ==
        "file: timing_cycles.refi: got 123, expected more than rfc_all 104 + rcd 15 + 4 of "
        "the command bus: room for an activate between refreshes");
}

// As DRAMSys has them, with what is asked for here.
const char* const kDramsysLpddr4 = R"({"memspec": {"memoryId": "mine", "memoryType": "LPDDR4",
  "memarchitecturespec": {"burstLength": 16, "dataRate": 2, "nbrOfBanks": 8, "nbrOfColumns": 1024,
    "nbrOfRanks": 1, "nbrOfRows": 65536, "width": 16, "nbrOfDevices": 1, "nbrOfChannels": 1,
    "nbrOfBankGroups": 1, "maxBurstLength": 16},
  "mempowerspec": {"idd01": 3.5e-3, "idd02": 45.0e-3, "idd2n1": 2.0e-3, "idd2n2": 27.0e-3,
    "idd2p1": 1.2e-3, "idd2p2": 3.0e-3, "idd3n1": 2.25e-3, "idd3n2": 30.0e-3, "idd3p1": 1.2e-3,
    "idd3p2": 9.0e-3, "idd4r1": 2.25e-3, "idd4r2": 275.0e-3, "idd4rq": 150.0e-3, "idd4w1": 2.25e-3,
    "idd4w2": 210.0e-3, "idd51": 10.0e-3, "idd52": 90.0e-3, "idd61": 0.3e-3, "idd62": 0.5e-3,
    "vdd1": 1.8, "vdd2": 1.1, "vddq": 1.1},
  "memtimingspec": {"CCD": 8, "CCDMW": 32, "CKE": 12, "CMDCKE": 3, "DQS2DQ": 2, "DQSCK": 6,
    "DQSS": 1, "ESCKE": 3, "FAW": 64, "PPD": 4, "RCD": 29, "REFI": 6246, "REFIpb": 780,
    "RFCab": 448, "RFCpb": 224, "RL": 28, "RAS": 68, "RPab": 34, "RPpb": 29, "RCab": 102,
    "RCpb": 97, "RPST": 0, "RRD": 16, "RTP": 12, "SR": 24, "WL": 14, "WPRE": 2, "WR": 29,
    "WTR": 16, "XP": 12, "XSR": 460, "RTRS": 1, "tCK": 625e-12}}})";

TEST_CASE("memspecs: DRAMSys's LPDDR4-3200 is the shipped one, but for what it does not state") {
  const test::ScratchFolder scratch;
  const Memspec theirs = load_memspec(scratch.write("a.json", kDramsysLpddr4));
  Memspec ours = load_memspec("lpddr4_3200_8gb");
  CHECK(theirs.name == "mine");
  CHECK(theirs.refresh_order == RefreshOrder::kAny);
  CHECK(theirs.io_pj_per_bit == Approx(0.150 * 1.1 / (16 * 3.2e9) * 1e12));
  ours.timing_cycles.dqsck_min = 6;
  ours.timing_cycles.ras_max = 9 * 6246;
  Memspec numbers = theirs;  // all but what is said of them, and the energy
  numbers.name = ours.name;
  numbers.description = ours.description;
  numbers.sources = ours.sources;
  numbers.io_pj_per_bit = ours.io_pj_per_bit;
  numbers.currents = ours.currents;
  numbers.hot = ours.hot;
  numbers.default_currents = ours.default_currents;
  CHECK(config_to_json(numbers) == config_to_json(ours));
  const Memspec::Currents a = theirs.currents.at("dramsys"), b = ours.currents.at("dramsys_8gb");
  CHECK(a.vdd1_v == b.vdd1_v);
  CHECK(a.vdd2_v == b.vdd2_v);
  for (double Memspec::Rail::*idd :
       {&Memspec::Rail::idd0, &Memspec::Rail::idd2p, &Memspec::Rail::idd2n, &Memspec::Rail::idd3p,
        &Memspec::Rail::idd3n, &Memspec::Rail::idd4r, &Memspec::Rail::idd4w, &Memspec::Rail::idd5,
        &Memspec::Rail::idd6}) {
    CHECK(a.vdd1_ma.*idd == Approx(b.vdd1_ma.*idd));
    CHECK(a.vdd2_ma.*idd == Approx(b.vdd2_ma.*idd));
  }
  const std::vector<std::string> notes = check_memspec(theirs, "a.json");
  REQUIRE(notes.size() >= 3);
  CHECK(notes[0].find("io_pj_per_bit 3.22 is idd4rq x vddq") != std::string::npos);
  CHECK(notes[1].find("not stated: write_latency_b 14, dqsck_min 6, ras_max 56214") !=
        std::string::npos);
  CHECK(notes[2].find("not read: maxBurstLength, CCDMW, CMDCKE, DQS2DQ, ESCKE, PPD, RCab, WPRE") !=
        std::string::npos);
}

TEST_CASE("memspecs: DRAMSys's other forms, and what has none") {
  const test::ScratchFolder scratch;
  const auto with = [&](std::vector<std::pair<std::string, std::string>> changes) {
    std::string text = kDramsysLpddr4;
    for (const auto& [from, to] : changes) {
      REQUIRE(text.find(from) != std::string::npos);
      text.replace(text.find(from), from.size(), to);
    }
    return scratch.write("a.json", text);
  };
  // A DDR4 has bank groups, and refreshes all banks at once.
  const Memspec ddr4 = load_memspec(with({{"LPDDR4", "DDR4"},
                                          {"\"nbrOfBankGroups\": 1", "\"nbrOfBankGroups\": 4"},
                                          {"\"CCD\": 8", "\"CCD_S\": 8, \"CCD_L\": 10"},
                                          {"\"RRD\": 16", "\"RRD_S\": 16, \"RRD_L\": 20"},
                                          {"\"WTR\": 16", "\"WTR_S\": 6, \"WTR_L\": 16"},
                                          {"\"RFCpb\": 224, ", ""},
                                          {"\"REFIpb\": 780,", ""},
                                          {"\"nbrOfDevices\": 1", "\"nbrOfDevices\": 2"}}));
  CHECK(ddr4.organisation.bank_groups == 4);
  CHECK(ddr4.organisation.width_bits == 32);
  CHECK(ddr4.refresh_sets() == 1);
  CHECK(ddr4.timing_cycles.ccd_l == 10);
  CHECK(ddr4.timing_cycles.rrd_l == 20);
  CHECK(ddr4.timing_cycles.wtr == 6);
  CHECK(ddr4.timing_cycles.wtr_l == 16);
  CHECK(ddr4.timing_cycles.rfc_bank == 448);
  CHECK(ddr4.timing_cycles.refi_bank == 6246);
  // A current without a number is none, and that is said.
  const Memspec without =
      load_memspec(with({{"\"idd62\": 0.5e-3", "\"idd62\": 0"}, {"\"vdd2\": 1.1, ", ""}}));
  CHECK(std::any_of(without.notes.begin(), without.notes.end(), [](const std::string& note) {
    return note.find("vdd2_ma.idd6 0, vdd2_v 1") != std::string::npos;
  }));
  // HBM counts columns in bursts, has pseudo-channels, and may have no currents.
  const Memspec hbm =
      load_memspec(with({{"LPDDR4", "HBM2"},
                         {"\"nbrOfColumns\": 1024", "\"nbrOfColumns\": 32"},
                         {"\"width\": 16", "\"nbrOfPseudoChannels\": 2, \"width\": 64"},
                         {"\"RCD\": 29", "\"RCDRD\": 12, \"RCDWR\": 6"},
                         {"mempowerspec", "nothing"}}));
  CHECK(hbm.organisation.columns == 512);
  CHECK(hbm.organisation.pseudo_channels == 2);
  CHECK(hbm.timing_cycles.rcd == 12);
  CHECK(hbm.timing_cycles.rcd_write == 6);
  CHECK(hbm.command_bus.buses == 2);
  CHECK(hbm.command_bus.activate == 2);
  CHECK(ddr4.command_bus.activate == 1);
  CHECK(hbm.notes.front().find("no currents") != std::string::npos);
  CHECK(refusal([&] {
          load_memspec(with({{"LPDDR4", "WIDEIO_SDR"}}));
        }).find("a.json: memspec.memoryType: got \"WIDEIO_SDR\", expected one of DDR3, DDR4") !=
        std::string::npos);
  CHECK(refusal([&] {
          load_memspec(with({{"\"RCD\": 29", "\"RCD\": 2.5"}}));
        }).find("a.json: memspec.memtimingspec.RCD: got 2.5, expected a whole number") !=
        std::string::npos);
  CHECK(refusal([&] {
          load_memspec(with({{"\"RAS\": 68, ", ""}}));
        }).find("a.json: memspec.memtimingspec.RAS: got 0 or nothing") != std::string::npos);
  for (const auto& [from, to, says] : std::vector<std::array<const char*, 3>>{
           {"\"nbrOfRows\": 65536", "\"nbrOfRows\": 49152",
            "memarchitecturespec.nbrOfRows: got 49152, expected a power of two"},
           {"\"RPpb\": 29", "\"RP\": 290", "memtimingspec.RPab: got 34, expected at least rp_bank"},
           {"\"idd02\": 45.0e-3", "\"idd02\": 45", "mempowerspec.idd02: got 45000"}}) {
    INFO(says);
    const std::string file = with({{from, to}});
    const std::string said = refusal([&] { load_memspec(file); });
    CHECK(said.find(std::string("a.json: memspec.") + says) != std::string::npos);
  }
}

TEST_CASE("dram config: combinations that cannot be are refused with the key's name") {
  CHECK(config_refusal([](DramConfig&) {}) == "accepted");
  const auto mapping_refusal = [](const char* memspec, const char* mapping) {
    return config_refusal([&](DramConfig& c) {
      c.memspec = memspec;
      c.mapping = mapping;
    });
  };
  const std::string lpddr3 = DramConfig().memspec;
  CHECK(mapping_refusal(lpddr3.c_str(), "row:bank:column:channel") == "accepted");
  CHECK(mapping_refusal(lpddr3.c_str(), "") != "accepted");
  for (const auto& [mapping, says] : std::map<const char*, const char*>{
           {"row:rank:bank:column", "expected 2 bits of channel, got 0"},
           {"row:row:bank:column:channel", "expected 'row' without a number at most once"},
           {"row:lane:bank:column:channel", "'lane' is none"},
           {"row:rank:bank:column.3:channel", "expected 7 bits of column, got 3"},
           {"row:rank:bank:column.x:channel", "a number of bits after the dot"}}) {
    INFO(mapping);
    CHECK(mapping_refusal(lpddr3.c_str(), mapping).find(says) != std::string::npos);
  }
  CHECK(mapping_refusal("lpddr5_6400_8gb", "row:rank:bank:column:channel") ==
        "dram.mapping: got 'row:rank:bank:column:channel', expected 2 bits of group, got 0");
  using C = DramConfig;
  for (const auto& [expected, change] : std::map<std::string, std::function<void(C&)>>{
           {"channels: got 3, expected a power of two", [](C& c) { c.channels = 3; }},
           {"write_low_watermark: got 24, expected less than write_high_watermark 24",
            [](C& c) { c.write_low_watermark = 24; }},
           {"write_high_watermark: got 33, expected 1 to write_queue_entries 32",
            [](C& c) { c.write_high_watermark = 33; }},
           {"refresh_postpone_max: got 5, expected at most the memspec's refresh_postpone_limit 4",
            [](C& c) { c.memspec = "ddr5_4800_16gb", c.refresh_postpone_max = 5; }},
           {"current_set: got x, expected one of drampower4, micron_edf8132a1mc",
            [](C& c) { c.current_set = "x"; }},
           {"self_refresh_idle_cycles: got 100",
            [](C& c) { c.power_down_idle_cycles = c.self_refresh_idle_cycles = 100; }}}) {
    INFO(expected);
    CHECK(config_refusal(change).find("dram." + expected) == 0);
  }
}

void check_inverse(DramConfig config) {
  std::uint64_t address = 1;
  for (const BankHash hash : {BankHash::kNone, BankHash::kXor}) {
    config.bank_hash = hash;
    const AddressMapping mapping(config, load_memspec(config.memspec));
    for (int i = 0; i < 1000; ++i) {
      address = address * 6364136223846793005u + 1442695040888963407u;
      const std::uint64_t aligned = (address >> 20) % mapping.capacity_bytes() & ~std::uint64_t{31};
      CHECK(mapping.encode(mapping.decode(aligned)) == aligned);
    }
  }
}

TEST_CASE("address mapping: groups are low bits of a bank, pseudo-channels of a channel") {
  DramConfig config;
  config.memspec = "hbm3_6400_16gb";
  config.channels = 2;
  const Memspec m = load_memspec(config.memspec);
  CHECK(config.buses(m) == 4);
  const AddressMapping mapping(config, m);
  CHECK(mapping.capacity_bytes() == std::uint64_t{4} * 16 * 16384 * 1024);
  CHECK(mapping.decode(256 * 3).channel == 3);
  CHECK(mapping.decode(256 * 4).bank == 1);          // the next group
  CHECK(mapping.decode(256 * 4 * 4).burst == 8);     // the same row
  CHECK(mapping.decode(256 * 4 * 4 * 4).bank == 4);  // the next bank of a group
  CHECK(mapping.decode(256 * 4 * 4 * 4 * 4).row == 1);
  check_inverse(config);
}

TEST_CASE("address mapping: fields lie where the string says, and encode is the inverse") {
  DramConfig config;
  config.ranks = 2;
  config.mapping = "row:rank:bank:column:channel:column.3";
  const Memspec m = load_memspec(config.memspec);
  const AddressMapping mapping(config, m);
  CHECK(mapping.capacity_bytes() == std::uint64_t{4} << 30);
  CHECK(mapping.run_bytes() == 256);
  CHECK(mapping.decode(32).burst == 1);
  CHECK(mapping.decode(256).channel == 1);
  CHECK(mapping.decode(256 * 4).burst == 8);
  CHECK(mapping.decode(4096 * 4).bank == 1);
  CHECK(mapping.decode(4096 * 4 * 8).rank == 1);
  CHECK(mapping.decode(4096 * 4 * 8 * 2).row == 1);
  check_inverse(config);
  config.bank_hash = BankHash::kXor;
  const AddressMapping hashed(config, m);
  CHECK(hashed.decode(4096 * 4 * 8 * 2 * 5).row == 5);
  CHECK(hashed.decode(4096 * 4 * 8 * 2 * 5).bank == 5);
}

}  // namespace
}  // namespace sgs
