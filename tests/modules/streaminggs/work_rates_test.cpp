// Turns at lanes that work by a fixed schedule.
#include "modules/streaminggs/work_rates.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>

namespace sgs::test {

TEST_CASE("turns: what one lane-set begins, begins whole intervals apart") {
  std::mt19937 random(1);
  for (const std::uint64_t interval : {1U, 2U, 7U, 39U}) {
    for (const std::uint64_t copies : {1U, 2U, 4U, 7U}) {
      if (copies > interval) continue;
      INFO(copies << " copies, a turn every " << interval << " cycles");
      std::map<std::uint64_t, std::uint64_t> last;  // [place in the interval]
      std::uint64_t now = 0;
      for (int item = 0; item < 1000; ++item) {
        const std::uint64_t begins = next_turn_of_one(now, interval, copies);
        CHECK(begins >= now);
        CHECK(begins < now + interval);
        const std::uint64_t copy = begins % interval;
        CHECK(copy < copies);
        if (last.count(copy) > 0) {
          CHECK(begins > last[copy]);
          CHECK((begins - last[copy]) % interval == 0);
        }
        last[copy] = begins;
        if (copies == 1) CHECK(begins == next_turn(now, interval));
        now = begins + 1 + random() % 3 * (random() % 20);
      }
    }
  }
}

}  // namespace sgs::test
