// Pool and counters: reuse, sums.
#include <catch2/catch.hpp>

#include "tlm/payload_pool.h"
#include "tlm/traffic_counters.h"

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

TEST_CASE("counters: what was added is counted by requester, region and direction") {
  TrafficCounters counters;
  counters.add(1, 3, Direction::kRead, 256);
  counters.add(1, 3, Direction::kRead, 44);
  counters.add(1, 4, Direction::kWrite, 8);
  counters.add(200, 3, Direction::kRead, 1);
  CHECK(counters.of(1, 3, Direction::kRead).bytes == 300);
  CHECK(counters.of(1, 3, Direction::kRead).transactions == 2);
  CHECK(counters.of(7, 3, Direction::kRead).bytes == 0);
  CHECK(counters.of(250, 0, Direction::kWrite).bytes == 0);
  CHECK(counters.total().bytes == 309);
  CHECK(counters.rows().size() == 3);
}

}  // namespace
}  // namespace sgs
