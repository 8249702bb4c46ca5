// The memory through its TLM socket: bytes, errors, latencies, back-pressure, both transports.
#include "modules/dram/dram_controller.h"

#include <catch2/catch.hpp>
#include <functional>
#include <utility>
#include <vector>

#include "tests/modules/dram/test_initiator.h"
#include "tlm/memory_port.h"
#include "tlm/time_resolution.h"

namespace sgs {
namespace {

using sc_core::SC_NS;
using sc_core::sc_time;
using test::Initiator;

DramConfig quiet() {
  DramConfig c;
  c.front_end_ns = c.back_end_ns = 0;
  c.refresh = RefreshMode::kOff;
  return c;
}

void run(const DramConfig& config, const std::function<void(Initiator&, DramController&)>& body) {
  use_femtosecond_resolution();
  DramController dram("dram", config);
  Initiator initiator("initiator", [&](Initiator& i) { body(i, dram); });
  initiator.socket.bind(dram.socket);
  sc_core::sc_start();
  CHECK(initiator.finished);
  CHECK(dram.idle());
}

constexpr double kHitNs = (12 + 5 + 4) * 1.25;

TEST_CASE("dram controller: unloaded latencies through the socket") {
  run(quiet(), [](Initiator& i, DramController&) {
    i.begin(i.make(tlm::TLM_READ_COMMAND, 0, 32));
    sc_core::wait(1000, SC_NS);
    i.begin(i.make(tlm::TLM_READ_COMMAND, 32, 32));
    sc_core::wait(1000, SC_NS);
    i.begin(i.make(tlm::TLM_READ_COMMAND, std::uint64_t{4096} * 4 * 8, 32));  // row 1, bank 0
    sc_core::wait(1000, SC_NS);
    REQUIRE(i.answers.size() == 3);
    CHECK(i.answers[0] == sc_time(kHitNs + 18.75, SC_NS));
    CHECK(i.answers[1] == sc_time(1000 + kHitNs, SC_NS));
    CHECK(i.answers[2] == sc_time(2000 + kHitNs + 37.5, SC_NS));
  });
}

TEST_CASE("dram controller: the same latencies annotated, through blocking transport") {
  run(quiet(), [](Initiator& i, DramController&) {
    const std::uint64_t addresses[] = {0, 32, std::uint64_t{4096} * 4 * 8};
    const double expected_ns[] = {kHitNs + 18.75, kHitNs, kHitNs + 37.5};
    for (int k = 0; k < 3; ++k) {
      PooledPayload& p = i.make(tlm::TLM_READ_COMMAND, addresses[k], 32);
      sc_time delay = sc_core::SC_ZERO_TIME;
      CHECK(i.blocking(p, delay) == tlm::TLM_OK_RESPONSE);
      CHECK(delay == sc_time(expected_ns[k], SC_NS));
      p.release();
      sc_core::wait(1000, SC_NS);
    }
  });
}

TEST_CASE("dram controller: 2133's clock is exact at a femtosecond") {
  DramConfig config = quiet();
  config.memspec = "lpddr3_2133_4gb";
  run(config, [](Initiator& i, DramController&) {
    i.begin(i.make(tlm::TLM_READ_COMMAND, 0, 32));
    sc_core::wait(1000, SC_NS);
    REQUIRE(i.answers.size() == 1);
    CHECK(i.answers[0] == sc_time((20 + 16 + 6 + 4) * 937500.0, sc_core::SC_FS));
  });
}

TEST_CASE("dram controller: an annotated request delay counts from when it ends") {
  run(quiet(), [](Initiator& i, DramController&) {
    CHECK(i.begin(i.make(tlm::TLM_READ_COMMAND, 0, 32), sc_time(100, SC_NS)) == tlm::TLM_ACCEPTED);
    sc_core::wait(1000, SC_NS);
    REQUIRE(i.end_requests.size() == 1);
    CHECK(i.end_requests[0] == sc_time(100, SC_NS));
    REQUIRE(i.answers.size() == 1);
    CHECK(i.answers[0] == sc_time(100 + kHitNs + 18.75, SC_NS));
  });
}

TEST_CASE("dram controller: bad requests get the TLM error and move no byte") {
  run(quiet(), [](Initiator& i, DramController& dram) {
    const std::uint64_t end = dram.capacity_bytes();
    const auto status = [&](PooledPayload& p) {
      CHECK(i.begin(p) == tlm::TLM_COMPLETED);
      const tlm::tlm_response_status s = p.get_response_status();
      p.release();
      return s;
    };
    CHECK(status(i.make(tlm::TLM_READ_COMMAND, end, 32)) == tlm::TLM_ADDRESS_ERROR_RESPONSE);
    CHECK(status(i.make(tlm::TLM_READ_COMMAND, end - 16, 32)) == tlm::TLM_ADDRESS_ERROR_RESPONSE);
    CHECK(status(i.make(tlm::TLM_WRITE_COMMAND, ~std::uint64_t{0} - 8, 32)) ==
          tlm::TLM_ADDRESS_ERROR_RESPONSE);
    CHECK(status(i.make(tlm::TLM_IGNORE_COMMAND, 0, 32)) == tlm::TLM_COMMAND_ERROR_RESPONSE);
    PooledPayload& streaming = i.make(tlm::TLM_READ_COMMAND, 0, 32);
    streaming.set_streaming_width(8);
    CHECK(status(streaming) == tlm::TLM_BURST_ERROR_RESPONSE);
    CHECK(dram.stats().traffic.total().transactions == 0);
  });
}

TEST_CASE("dram controller: byte enables write and read only what they name") {
  run(quiet(), [](Initiator& i, DramController& dram) {
    std::uint8_t enables[] = {TLM_BYTE_ENABLED, TLM_BYTE_DISABLED, TLM_BYTE_DISABLED};
    PooledPayload& p = i.make(tlm::TLM_WRITE_COMMAND, 100, 7);
    for (std::uint8_t k = 0; k < 7; ++k) p.get_data_ptr()[k] = static_cast<std::uint8_t>(k + 1);
    p.set_byte_enable_ptr(enables);
    p.set_byte_enable_length(3);
    CHECK(i.begin(p) == tlm::TLM_COMPLETED);  // posted
    CHECK(p.is_response_ok());
    p.release();
    std::uint8_t stored[7];
    dram.read_back(100, stored, 7);
    const std::uint8_t expected[7] = {1, 0, 0, 4, 0, 0, 7};
    CHECK(std::equal(stored, stored + 7, expected));
  });
}

TEST_CASE("dram controller: a long unaligned request is split over channels and counted") {
  run(quiet(), [](Initiator& i, DramController& dram) {
    i.begin(i.make(tlm::TLM_READ_COMMAND, 250, 600));  // bytes 250..849: bursts 7..26
    sc_core::wait(1000, SC_NS);
    REQUIRE(i.answers.size() == 1);
    const DramStats s = dram.stats();
    CHECK(s.bytes() == 600);
    CHECK(s.bus_bytes() == 20 * 32);
    CHECK(s.channels[0].bursts() == 1);
    CHECK(s.channels[1].bursts() == 8);
    CHECK(s.channels[2].bursts() == 8);
    CHECK(s.channels[3].bursts() == 3);
    CHECK(s.bursts_by_region[0][0] == 20);
  });
}

// The bytes that a write leaves as they are stand in the device alone.
TEST_CASE("dram controller: a waiting write answers a read of bursts that it holds whole") {
  struct Write {
    std::uint64_t from;  // of the bytes that are read
    std::uint32_t bytes;
    bool enables;
    bool answers;
  };
  const Write writes[] = {{0, 64, false, true},   {0, 96, false, true},   {0, 48, false, false},
                          {16, 48, false, false}, {16, 80, false, false}, {0, 64, true, false}};
  run(quiet(), [&](Initiator& i, DramController& dram) {
    std::uint64_t address = 0, answered = 0;
    for (const Write& write : writes) {
      address += 1U << 20U;
      CAPTURE(write.from, write.bytes, write.enables);
      std::uint8_t enables[] = {TLM_BYTE_ENABLED, TLM_BYTE_DISABLED};
      PooledPayload& p = i.make(tlm::TLM_WRITE_COMMAND, address + write.from, write.bytes);
      if (write.enables) p.set_byte_enable_ptr(enables);
      if (write.enables) p.set_byte_enable_length(2);
      CHECK(i.begin(p) == tlm::TLM_COMPLETED);  // posted
      p.release();
      i.begin(i.make(tlm::TLM_READ_COMMAND, address, 64));
      sc_core::wait(1000, SC_NS);
      answered += write.answers ? 1 : 0;
      CHECK(dram.stats().forwarded_reads == answered);
    }
  });
}

TEST_CASE("dram controller: END_REQ is held back while the queue is full") {
  DramConfig config = quiet();
  config.channels = 1;
  config.mapping = "row:rank:bank:column:channel";
  config.read_queue_entries = 2;
  run(config, [](Initiator& i, DramController&) {
    // Same bank, other rows: each takes a row cycle.
    const std::uint64_t step = 4096 * 8;
    CHECK(i.begin(i.make(tlm::TLM_READ_COMMAND, 0, 32)) == tlm::TLM_UPDATED);
    CHECK(i.begin(i.make(tlm::TLM_READ_COMMAND, step, 32)) == tlm::TLM_UPDATED);
    CHECK(i.begin(i.make(tlm::TLM_READ_COMMAND, 2 * step, 32)) == tlm::TLM_ACCEPTED);
    sc_core::wait(1000, SC_NS);
    REQUIRE(i.end_requests.size() == 1);
    // The first read leaves the queue at cycle 15; the place is seen free a cycle later.
    CHECK(i.end_requests[0] == sc_time(16 * 1.25, SC_NS));
    CHECK(i.answers.size() == 3);
    // ACT 0, PRE 34, ACT 49, PRE 83, ACT 98, RD 113.
    CHECK(i.answers.back() == sc_time((113 + 21) * 1.25, SC_NS));
  });
}

TEST_CASE("dram controller: a write that is not posted is answered after its last datum") {
  DramConfig config = quiet();
  config.posted_writes = false;
  run(config, [](Initiator& i, DramController& dram) {
    CHECK(i.begin(i.make(tlm::TLM_WRITE_COMMAND, 0, 32)) == tlm::TLM_UPDATED);
    CHECK_FALSE(dram.idle());
    sc_core::wait(1000, SC_NS);
    REQUIRE(i.answers.size() == 1);
    CHECK(i.answers[0] == sc_time((15 + 6 + 1 + 4) * 1.25, SC_NS));
  });
}

TEST_CASE("dram controller: debug transport loads and reads without time") {
  run(quiet(), [](Initiator& i, DramController& dram) {
    PooledPayload& p = i.make(tlm::TLM_WRITE_COMMAND, dram.capacity_bytes() - 4, 8);
    std::fill_n(p.get_data_ptr(), 8, std::uint8_t{9});
    CHECK(i.socket->transport_dbg(p) == 4);
    p.set_command(tlm::TLM_READ_COMMAND);
    std::fill_n(p.get_data_ptr(), 8, std::uint8_t{0});
    CHECK(i.socket->transport_dbg(p) == 4);
    CHECK(p.get_data_ptr()[3] == 9);
    p.set_address(dram.capacity_bytes());
    CHECK(i.socket->transport_dbg(p) == 0);
    p.release();
    CHECK(sc_core::sc_time_stamp() == sc_core::SC_ZERO_TIME);
    CHECK_THROWS_AS(dram.load(dram.capacity_bytes(), "x", 1), std::out_of_range);
  });
}

TEST_CASE("dram controller: blocking and non-blocking requests do not mix") {
  use_femtosecond_resolution();
  DramController dram("dram", quiet());
  Initiator initiator("initiator", [](Initiator& i) {
    i.begin(i.make(tlm::TLM_READ_COMMAND, 0, 32));
    sc_time delay = sc_core::SC_ZERO_TIME;
    i.blocking(i.make(tlm::TLM_READ_COMMAND, 0, 32), delay);
  });
  initiator.socket.bind(dram.socket);
  CHECK_THROWS_WITH(sc_core::sc_start(),
                    Catch::Contains("blocking and non-blocking requests in one run"));
}

TEST_CASE("dram controller: time, bandwidth and refreshes of idle time are accounted") {
  DramConfig config;
  config.front_end_ns = config.back_end_ns = 0;
  config.refresh = RefreshMode::kAllBank;
  run(config, [](Initiator& i, DramController& dram) {
    i.begin(i.make(tlm::TLM_READ_COMMAND, 0, 256));
    sc_core::wait(39000, SC_NS);  // ten refresh intervals
    const DramStats s = dram.stats();
    CHECK(s.elapsed_cycles == 31200);
    CHECK(s.busy_cycles == 15 + 7 * 4 + 21);
    CHECK(s.bandwidth_gb_per_s() == Approx(256 / 39000.0));
    CHECK(s.busy_bandwidth_gb_per_s() == Approx(256 / (64 * 1.25)));
    CHECK(s.peak_gb_per_s == Approx(25.6));
    for (const DramChannelStats& c : s.channels) CHECK(c.refreshes() == 9);
    CHECK(s.read_latency_cycles.mean() == 64);
    CHECK(s.energy.total_pj() > 0);
    CHECK(s.energy.by_current_set_pj.size() == 2);
  });
}

// Until it is told that no frame is under way it stays up, however long nobody asks.
struct RestCase {
  BetweenFrames where;
  bool power_down, self_refresh;
};

void check_rest(const RestCase& row) {
  DramConfig config = quiet();
  config.between_frames = row.where;
  config.channels = 1;
  run(config, [&](Initiator& i, DramController& dram) {
    const auto rested = [&] {
      const RankActivity rank = dram.stats().ranks.at(0);
      return std::pair(rank.active_power_down_cycles + rank.precharged_power_down_cycles,
                       rank.self_refresh_cycles);
    };
    i.begin(i.make(tlm::TLM_READ_COMMAND, 0, 32));
    sc_core::wait(10, sc_core::SC_US);
    CHECK(rested() == std::pair<std::uint64_t, std::uint64_t>(0, 0));
    dram.rest(true);
    sc_core::wait(10, sc_core::SC_US);
    const auto [power_down, self_refresh] = rested();
    constexpr std::uint64_t kNearly = 7900;  // of 8000 cycles
    CHECK((power_down > kNearly) == row.power_down);
    CHECK((self_refresh > kNearly) == row.self_refresh);
    CHECK(power_down + self_refresh == (row.power_down ? power_down : self_refresh));
    const sc_time asked = sc_core::sc_time_stamp();
    i.begin(i.make(tlm::TLM_READ_COMMAND, 32, 32));
    sc_core::wait(2, sc_core::SC_US);
    REQUIRE(i.answers.size() == 2);
    const sc_time took = i.answers[1] - asked;
    CHECK((took > sc_time(kHitNs, SC_NS)) == (row.power_down || row.self_refresh));
    dram.rest(false);
    const auto before = rested();
    i.begin(i.make(tlm::TLM_READ_COMMAND, 64, 32));
    sc_core::wait(1, sc_core::SC_US);
    const auto woken = rested();
    sc_core::wait(10, sc_core::SC_US);
    CHECK(rested() == woken);
    CHECK(woken.first + woken.second <= before.first + before.second + 400);
  });
}

TEST_CASE("dram controller: ranks refresh themselves while no frame is under way") {
  check_rest({BetweenFrames::kSelfRefresh, false, true});
}

TEST_CASE("dram controller: ranks power down while no frame is under way") {
  check_rest({BetweenFrames::kPowerDown, true, false});
}

TEST_CASE("dram controller: ranks stay up while no frame is under way, by their idle cycles") {
  check_rest({BetweenFrames::kByIdleCycles, false, false});
}

}  // namespace
}  // namespace sgs
