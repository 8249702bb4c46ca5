// The benchmark rows: within their bounds, near the closed forms and the public simulators.
#include <catch2/catch.hpp>
#include <cmath>

#include "testbench/dram/bench_table.h"

namespace sgs {
namespace {

const std::string kRows = std::string(SGS_SOURCE_DIR) + "/testbench/dram/published.json";

void check_rows(const std::vector<MeasuredRow>& rows) {
  for (const MeasuredRow& row : rows) {
    INFO(row.published.interleave << " " << row.published.name << ": " << row.ours.gb_per_s);
    if (row.published.bound_gb_per_s) CHECK(row.ours.gb_per_s <= *row.published.bound_gb_per_s);
    CHECK(row.ours.gb_per_s <= row.ours.peak_gb_per_s);
    if (beyond_both(row)) CHECK_FALSE(row.published.why.empty());
  }
}

TEST_CASE("published rows: one channel") {
  const auto rows = measure(published_rows(kRows, "one_channel", 300000));
  REQUIRE(rows.size() == 11);
  check_rows(rows);
  CHECK(rows[0].ours.gb_per_s >= 0.985 * 6.187);  // sequential
  CHECK(rows[1].ours.gb_per_s >= 0.985 * 6.187);
  CHECK(rows[2].ours.gb_per_s == Approx(2.475).epsilon(0.03));  // random 32 B: tFAW
  CHECK(rows[8].ours.gb_per_s == Approx(0.505).epsilon(0.01));  // one bank: tRAS + tRP
  // Mean power on VDD2 against DRAMsim3's with the same currents, mW.
  const double dramsim3_mw[] = {274, 274, 294, 383, 251, 352, 283, 294, 94};
  for (std::size_t i = 0; i < 9; ++i) {
    INFO(rows[i].published.name);
    CHECK(rows[i].ours.vdd2_power_mw == Approx(dramsim3_mw[i]).epsilon(0.03));
  }
}

TEST_CASE("published rows: four channels by interleave") {
  const auto rows = measure(published_rows(kRows, "four_channels", 100000));
  REQUIRE(rows.size() == 13);
  check_rows(rows);
}

TEST_CASE("published rows: as many requests as a row wants, and no more than asked for") {
  for (const char* section : {"one_channel", "four_channels"}) {
    const auto whole = published_rows(kRows, section, 1'000'000'000);
    const auto few = published_rows(kRows, section, 300);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      INFO(section << " " << whole[i].name);
      CHECK((whole[i].bench.requests > 300 && whole[i].bench.requests <= 1'000'000));
      CHECK(few[i].bench.requests == 300);
    }
  }
}

TEST_CASE("part streams: every shipped memory is within its bounds, in sequence not the slower") {
  for (const std::string& memspec : shipped_memspecs()) {
    const PartStreams part = measure_part(memspec, 20000);
    for (std::size_t i = 0; i < kPartStreams; ++i) {
      INFO(memspec << " " << kPartStreamNames[i] << ": " << part.gb_per_s[i] << " of "
                   << part.bound_gb_per_s[i]);
      CHECK(part.gb_per_s[i] <= part.bound_gb_per_s[i]);
      CHECK(part.bound_gb_per_s[i] <= part.peak_gb_per_s);
    }
    INFO(memspec);
    CHECK(part.gb_per_s[0] >= part.gb_per_s[2]);
    CHECK(part.gb_per_s[1] >= part.gb_per_s[3]);
    CHECK(part.gb_per_s[4] >= part.gb_per_s[5]);
  }
}

TEST_CASE("part streams: bounds by hand") {
  const Memspec lpddr3 = load_memspec("lpddr3_1600_4gb"), hbm = load_memspec("hbm2e_3200_16gb");
  const auto bound = [](const Memspec& memspec, Pattern pattern, std::uint32_t bytes) {
    StreamSpec stream;
    stream.pattern = pattern;
    stream.request_bytes = bytes;
    return part_bound_gb_per_s(memspec, stream);
  };
  CHECK(bound(lpddr3, Pattern::kSequential, 64) == Approx(6.4));
  CHECK(bound(lpddr3, Pattern::kRandom, 32) == Approx(4 * 32 / (40 * 1.25)));  // tFAW
  CHECK(bound(hbm, Pattern::kSequential, 32) == Approx(2 * 25.6));             // pseudo-channels
  CHECK(bound(hbm, Pattern::kRandom, 64) == Approx(2 * 64 / (7 * 0.625)));     // tRRD
  // ACT-1, ACT-2, two reads and a precharge on one command bus.
  CHECK(bound(load_memspec("lpddr5_6400_8gb"), Pattern::kRandom, 64) == Approx(64 / (5 * 1.25)));
  // A burst of 64 bytes for each 32.
  CHECK(bound(load_memspec("ddr5_4800_16gb"), Pattern::kSequential, 32) ==
        Approx(19.2 / 2).epsilon(1e-4));
}

TEST_CASE("published rows: an unexplained difference is seen") {
  MeasuredRow row;
  row.published.dramsim3_gb_per_s = 10.0;
  row.published.ramulator_gb_per_s = 9.0;
  row.ours.gb_per_s = 9.4;
  CHECK_FALSE(beyond_both(row));
  row.ours.gb_per_s = 10.6;
  CHECK(beyond_both(row));
  row.ours.gb_per_s = 8.5;
  CHECK(beyond_both(row));
}

TEST_CASE("published rows: grouped writes cost the two turn-arounds a batch pair") {
  // Closed form: R n 4 / (n 4 + 25) with n bursts a pair of batches; the write batch is
  // (high - low) requests of two bursts, and 30 % of all bursts are writes.
  StreamBench bench;
  bench.dram.channels = 1;
  bench.dram.front_end_ns = bench.dram.back_end_ns = 0;
  bench.dram.refresh = RefreshMode::kAllBank;
  bench.dram.mapping = "row:rank:bank:column:channel";
  bench.stream.pattern = Pattern::kSequential;
  bench.stream.request_bytes = 64;
  bench.stream.write_percent = 30;
  bench.requests = 200000;
  for (const std::uint32_t batch : {8u, 16u, 28u}) {
    bench.dram.write_high_watermark = batch + 2;
    bench.dram.write_low_watermark = 2;
    const double n = batch * 2 / 0.3;
    const double closed_form = 6.4 * (1 - 104.0 / 3120) * n * 4 / (n * 4 + 25);
    const double reached = run_stream_in_child(bench).gb_per_s;
    INFO("batch " << batch << ": " << reached << " against " << closed_form);
    CHECK(reached <= closed_form * 1.005);
    CHECK(reached >= closed_form * 0.95);
  }
}

}  // namespace
}  // namespace sgs
