// Pool, counters and router: reuse, sums, ranges.
#include <catch2/catch.hpp>
#include <stdexcept>

#include "tlm/counters.h"
#include "tlm/payload_pool.h"
#include "tlm/router.h"

namespace sgs {
namespace {

TEST_CASE("payload pool: a released payload comes back with every attribute anew") {
  PayloadPool pool;
  PooledPayload& first = pool.acquire();
  CHECK(first.get_ref_count() == 1);
  CHECK(first.has_mm());
  std::uint8_t enables[1] = {0xff};
  first.set_command(tlm::TLM_WRITE_COMMAND);
  first.set_address(77);
  first.set_data_ptr(first.buffer(100));
  first.set_data_length(100);
  first.set_byte_enable_ptr(enables);
  first.set_byte_enable_length(1);
  first.set_response_status(tlm::TLM_OK_RESPONSE);
  first.acquire();
  first.release();
  CHECK(pool.in_use() == 1);
  first.release();
  CHECK(pool.in_use() == 0);

  PooledPayload& again = pool.acquire();
  CHECK(&again == &first);
  CHECK(pool.made() == 1);
  CHECK(again.get_command() == tlm::TLM_IGNORE_COMMAND);
  CHECK(again.get_address() == 0);
  CHECK(again.get_data_ptr() == nullptr);
  CHECK(again.get_data_length() == 0);
  CHECK(again.get_byte_enable_ptr() == nullptr);
  CHECK(again.get_response_status() == tlm::TLM_INCOMPLETE_RESPONSE);
  CHECK(again.get_extension<MemoryExtension>() == &again.memory());
  again.release();
}

TEST_CASE("payload pool: warm, it makes nothing new") {
  PayloadPool pool;
  for (int round = 0; round < 100; ++round) {
    PooledPayload* held[16];
    for (PooledPayload*& p : held) p = &pool.acquire();
    for (PooledPayload* p : held) p->release();
  }
  CHECK(pool.made() == 16);
}

TEST_CASE("counters: sums by requester, region and direction agree") {
  TrafficCounters counters;
  counters.add(1, 3, Direction::kRead, 256);
  counters.add(1, 3, Direction::kRead, 44);
  counters.add(1, 4, Direction::kWrite, 8);
  counters.add(200, 3, Direction::kRead, 1);
  CHECK(counters.of(1, 3, Direction::kRead).bytes == 300);
  CHECK(counters.of(1, 3, Direction::kRead).transactions == 2);
  CHECK(counters.of(7, 3, Direction::kRead).bytes == 0);
  CHECK(counters.of(250, 0, Direction::kWrite).bytes == 0);
  CHECK(counters.of_requester(1, Direction::kWrite).bytes == 8);
  CHECK(counters.of_region(3, Direction::kRead).bytes == 301);
  CHECK(counters.of_direction(Direction::kRead).transactions == 3);
  CHECK(counters.total().bytes == 309);
  CHECK(counters.rows().size() == 3);
}

// Answers everything at once, and remembers from where it came.
class Target : public sc_core::sc_module {
 public:
  tlm_utils::multi_passthrough_target_socket<Target> socket;
  explicit Target(const sc_core::sc_module_name& name) : sc_module(name), socket("socket") {
    socket.register_b_transport(this, &Target::b_transport);
    socket.register_nb_transport_fw(this, &Target::nb_transport_fw);
    socket.register_transport_dbg(this, &Target::transport_dbg);
  }
  std::vector<std::pair<int, std::uint64_t>> seen;

 private:
  void b_transport(int from, tlm::tlm_generic_payload& payload, sc_core::sc_time&) {
    seen.emplace_back(from, payload.get_address());
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
  }
  tlm::tlm_sync_enum nb_transport_fw(int from, tlm::tlm_generic_payload& payload, tlm::tlm_phase&,
                                     sc_core::sc_time& delay) {
    b_transport(from, payload, delay);
    return tlm::TLM_COMPLETED;
  }
  unsigned int transport_dbg(int from, tlm::tlm_generic_payload& payload) {
    seen.emplace_back(from, payload.get_address());
    return payload.get_data_length();
  }
};

struct Source : sc_core::sc_module {
  tlm_utils::simple_initiator_socket<Source> socket{"socket"};
  explicit Source(const sc_core::sc_module_name& name) : sc_module(name) {}
};

TEST_CASE("router: transactions reach the target of their range, others are refused") {
  Router router("router", 2, 2);
  Target low("low");
  Target high("high");
  Source a("a");
  Source b("b");
  a.socket.bind(router.from_initiators[0]);
  b.socket.bind(router.from_initiators[1]);
  router.map(0x1000, 0x1000, low.socket);
  CHECK_THROWS_AS(router.map(0x1fff, 1, high.socket), std::invalid_argument);
  CHECK_THROWS_AS(router.map(0x9000, 0, high.socket), std::invalid_argument);
  CHECK_THROWS_AS(router.map(~std::uint64_t{0} - 7, 16, high.socket), std::invalid_argument);
  router.map(0x2000, 0x1000, high.socket);
  CHECK_THROWS_AS(router.map(0x5000, 0x1000, high.socket), std::invalid_argument);
  sc_core::sc_start(sc_core::SC_ZERO_TIME);

  PayloadPool pool;
  const auto send = [&](Source& source, std::uint64_t address, unsigned length) {
    PooledPayload& p = pool.acquire();
    p.set_command(tlm::TLM_READ_COMMAND);
    p.set_address(address);
    p.set_data_ptr(p.buffer(length));
    p.set_data_length(length);
    p.set_streaming_width(length);
    sc_core::sc_time delay;
    source.socket->b_transport(p, delay);
    const tlm::tlm_response_status blocking = p.get_response_status();
    p.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    CHECK(source.socket->nb_transport_fw(p, phase, delay) == tlm::TLM_COMPLETED);
    CHECK(p.get_response_status() == blocking);
    CHECK(source.socket->transport_dbg(p) == (blocking == tlm::TLM_OK_RESPONSE ? length : 0));
    p.release();
    return blocking;
  };
  CHECK(send(a, 0x1000, 4) == tlm::TLM_OK_RESPONSE);
  CHECK(send(b, 0x2ffc, 4) == tlm::TLM_OK_RESPONSE);
  CHECK(send(a, 0x1ffe, 4) == tlm::TLM_ADDRESS_ERROR_RESPONSE);  // over the border of two ranges
  CHECK(send(a, 0x3000, 4) == tlm::TLM_ADDRESS_ERROR_RESPONSE);
  CHECK(send(a, 0x0fff, 1) == tlm::TLM_ADDRESS_ERROR_RESPONSE);
  using Seen = std::vector<std::pair<int, std::uint64_t>>;
  CHECK(low.seen == Seen{{0, 0x1000}, {0, 0x1000}, {0, 0x1000}});
  CHECK(high.seen == Seen{{1, 0x2ffc}, {1, 0x2ffc}, {1, 0x2ffc}});
}

}  // namespace
}  // namespace sgs
