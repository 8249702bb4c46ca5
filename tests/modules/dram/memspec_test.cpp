// Memspecs and configuration: what is shipped is sound, what cannot be is refused by name.
#include "modules/dram/memspec.h"

#include <algorithm>
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
  CHECK(names == std::vector<std::string>{"lpddr3_1600_4gb", "lpddr3_1600_8gb", "lpddr3_1866_4gb",
                                          "lpddr3_2133_4gb", "lpddr4_3200_8gb"});
  for (const std::string& name : names) {
    const Memspec m = load_memspec(name);
    CHECK(m.name == name);
    CHECK(m.burst_bytes() == 32);
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

TEST_CASE("memspecs: sizes and peaks") {
  const Memspec m = load_memspec("lpddr3_1600_4gb");
  CHECK(m.row_bytes() == 4096);
  CHECK(m.rank_bytes() == std::uint64_t{512} << 20);
  CHECK(m.peak_gb_per_s() == Approx(6.4));
  CHECK(load_memspec("lpddr3_2133_4gb").peak_gb_per_s() == Approx(8.533).epsilon(1e-4));
  CHECK(load_memspec("lpddr4_3200_8gb").peak_gb_per_s() == Approx(6.4));
}

TEST_CASE("memspecs: published tables that disagree by a cycle are named") {
  const auto warnings = check_memspec(load_memspec("lpddr3_1600_4gb"), "file");
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0].find("rc is 48 but ras + rp_bank is 49") != std::string::npos);
  CHECK(warnings[1].find("WL is 6 (set A) or 9 (set B)") != std::string::npos);
}

TEST_CASE("memspecs: the impossible is refused with the key's name") {
  CHECK(memspec_refusal([](Memspec& m) {
          m.timing_cycles.ras_max = m.timing_cycles.refi;
        }).find("file: timing_cycles.ras_max: got 3120, expected more than refi 3120") == 0);
  CHECK(memspec_refusal([](Memspec& m) {
          m.organisation.banks = 0;
        }).find("file: organisation.banks: got 0") == 0);
  CHECK(memspec_refusal([](Memspec& m) {
          m.organisation.rows = 49152;
        }).find("file: organisation.rows: got 49152, expected a power of two") == 0);
  CHECK(memspec_refusal([](Memspec& m) {
          m.organisation.columns = 4;
        }).find("file: organisation.columns: got 4, expected a multiple of burst_length 8") == 0);
  CHECK(memspec_refusal([](Memspec& m) {
          m.timing_cycles.rcd = 0;
        }).find("file: timing_cycles.rcd: got 0") == 0);
  CHECK(memspec_refusal([](Memspec& m) {
          m.timing_cycles.ccd = 3;
        }).find("file: timing_cycles.ccd: got 3, expected at least burst_length / 2 = 4") == 0);
  CHECK(memspec_refusal([](Memspec& m) {
          m.timing_cycles.ras = 10;
        }).find("file: timing_cycles.ras: got 10, expected at least rcd 15") == 0);
  CHECK(memspec_refusal([](Memspec& m) {
          m.io_pj_per_bit = Memspec().io_pj_per_bit;
        }).find("file: io_pj_per_bit: got nothing") == 0);
  CHECK(memspec_refusal([](Memspec& m) {
          m.sources["fawn"] = "x";
        }).find("file: sources.fawn: unknown key") == 0);
  CHECK(memspec_refusal([](Memspec& m) {
          m.default_currents = "none";
        }).find("file: default_currents: got 'none'") == 0);
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
  CHECK(config.io_pj_per_bit_of(m) == 5);
  config.io_pj_per_bit = 0;
  CHECK(config.io_pj_per_bit_of(m) == 0);
  for (const std::string& name : shipped_memspecs()) CHECK(load_memspec(name).io_pj_per_bit == 3);
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
}

TEST_CASE("memspecs: negative and fractional cycles are refused by the reader") {
  for (const char* bad : {"timing_cycles.rcd=-1", "timing_cycles.rcd=1.5", "organisation.banks=0",
                          "timing_cycles.rcd=\"15\"", "timing_cycles.trcd=15"}) {
    ConfigDocument document;
    document.add_text(config_to_json(load_memspec("lpddr3_1600_4gb")), "spec.json");
    document.add_override(bad);
    Memspec m;
    CHECK_THROWS_AS(document.read_into(m), InputError);
  }
  CHECK(refusal([] {
          load_memspec("ddr9");
        }).find("dram.memspec: got 'ddr9', expected a JSON file or one of lpddr3_1600_4gb") == 0);
}

TEST_CASE("dram config: combinations that cannot be are refused with the key's name") {
  CHECK(config_refusal([](DramConfig&) {}) == "accepted");
  CHECK(config_refusal([](DramConfig& c) { c.channels = 3; }) ==
        "dram.channels: got 3, expected a power of two");
  CHECK(config_refusal([](DramConfig& c) { c.mapping = "row:bank:column:channel"; }) == "accepted");
  CHECK(config_refusal([](DramConfig& c) { c.mapping = "row:rank:bank:column"; }) ==
        "dram.mapping: got 'row:rank:bank:column', expected 2 bits of channel, got 0");
  CHECK(config_refusal([](DramConfig& c) {
          c.mapping = "row:row:bank:column:channel";
        }).find("expected 'row' without a number at most once") != std::string::npos);
  CHECK(config_refusal([](DramConfig& c) {
          c.mapping = "row:lane:bank:column:channel";
        }).find("'lane' is none") != std::string::npos);
  CHECK(config_refusal([](DramConfig& c) {
          c.mapping = "row:rank:bank:column.3:channel";
        }).find("expected 7 bits of column, got 3") != std::string::npos);
  CHECK(config_refusal([](DramConfig& c) {
          c.mapping = "row:rank:bank:column.x:channel";
        }).find("a number of bits after the dot") != std::string::npos);
  CHECK(config_refusal([](DramConfig& c) { c.mapping = ""; }) != "accepted");
  CHECK(config_refusal([](DramConfig& c) { c.write_low_watermark = 24; }) ==
        "dram.write_low_watermark: got 24, expected less than write_high_watermark 24");
  CHECK(config_refusal([](DramConfig& c) { c.write_high_watermark = 33; }) ==
        "dram.write_high_watermark: got 33, expected 1 to write_queue_entries 32");
  CHECK(config_refusal([](DramConfig& c) { c.current_set = "x"; }) ==
        "dram.current_set: got x, expected one of drampower4, micron_edf8132a1mc");
  CHECK(config_refusal([](DramConfig& c) {
          c.power_down_idle_cycles = 100;
          c.self_refresh_idle_cycles = 100;
        }).find("dram.self_refresh_idle_cycles: got 100") == 0);
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
  for (const BankHash hash : {BankHash::kNone, BankHash::kXor}) {
    config.bank_hash = hash;
    const AddressMapping both(config, m);
    std::uint64_t address = 1;
    for (int i = 0; i < 1000; ++i) {
      address = (address * 6364136223846793005u + 1442695040888963407u);
      const std::uint64_t aligned = (address >> 20) % both.capacity_bytes() & ~std::uint64_t{31};
      CHECK(both.encode(both.decode(aligned)) == aligned);
    }
  }
  config.bank_hash = BankHash::kXor;
  const AddressMapping hashed(config, m);
  CHECK(hashed.decode(4096 * 4 * 8 * 2 * 5).row == 5);
  CHECK(hashed.decode(4096 * 4 * 8 * 2 * 5).bank == 5);
}

}  // namespace
}  // namespace sgs
