// Jitter lets processes of one instant overtake each other, and no time pass: without it, tests of
// what their order must not change could not fail.
#include "tlm/delta_jitter.h"

#include <fmt/format.h>
#include <tlm_utils/passthrough_target_socket.h>

#include <catch2/catch.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/tlm/threads.h"
#include "tests/tlm/unit_with_port.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {
namespace {

using test::Threads;

// Who came when, first come first served: an arbiter as it must not be.
struct Arrivals {
  std::string order;
  std::vector<std::uint64_t> cycles;
  void come(char who, const ClockDomain& clock) {
    order += who;
    cycles.push_back(clock.now_cycles());
  }
  bool both_orders() const {
    bool ab = false, ba = false;
    for (std::size_t i = 0; i + 1 < order.size(); i += 2) {
      ab = ab || order.substr(i, 2) == "ab";
      ba = ba || order.substr(i, 2) == "ba";
    }
    return ab && ba;
  }
};

// Two that come in the same cycles, by each way of waiting.
struct Pair {
  explicit Pair(const std::string& name, std::uint64_t jitter_seed)
      : clock(800, jitter_seed),
        a((name + "_a").c_str(), clock),
        b((name + "_b").c_str(), clock),
        writer((name + "_writer").c_str(), clock),
        to_a((name + "_to_a").c_str(), clock, 1, 0),
        to_b((name + "_to_b").c_str(), clock, 1, 0) {}

  static constexpr int kTimes = 50;

  std::vector<std::function<void()>> bodies() {
    return {[this] { come_from('a'); }, [this] { come_from('b'); },
            [this] {
              for (int i = 0; i < kTimes; ++i) {
                clock.wait_cycles(5);
                for (TimedFifo<int>* fifo : {&to_a, &to_b}) fifo->push(i, writer);
              }
            },
            [this] { read(to_a, a, 'a'); }, [this] { read(to_b, b, 'b'); }};
  }

  ClockDomain clock;
  Arrivals waited, aligned, from_fifo;

 private:
  void come_from(char who) {
    for (int i = 0; i < kTimes; ++i) {
      clock.wait_cycles(3);
      waited.come(who, clock);
      sc_core::wait(300, sc_core::SC_PS);
      clock.align();
      aligned.come(who, clock);
    }
  }

  void read(TimedFifo<int>& fifo, Activity& reader, char who) {
    for (int i = 0; i < kTimes; ++i) {
      CHECK(fifo.pop(reader) == i);
      from_fifo.come(who, clock);
    }
  }

  Activity a, b, writer;
  TimedFifo<int> to_a, to_b;
};

TEST_CASE("delta jitter: processes of one instant overtake each other, and no time passes") {
  Pair plain("plain", 0), one("one", 1), two("two", 2);
  std::vector<std::function<void()>> bodies;
  for (Pair* pair : {&plain, &one, &two}) {
    for (auto& body : pair->bodies()) bodies.push_back(std::move(body));
  }
  Threads threads(std::move(bodies));
  REQUIRE(threads.run_all());
  using Which = Arrivals Pair::*;
  for (const Which which : {&Pair::waited, &Pair::aligned, &Pair::from_fifo}) {
    REQUIRE((plain.*which).order.size() == 2 * Pair::kTimes);
    CHECK((one.*which).order != (plain.*which).order);
    CHECK((one.*which).both_orders());
    CHECK((one.*which).order != (two.*which).order);
    CHECK((one.*which).cycles == (plain.*which).cycles);
    CHECK((two.*which).cycles == (plain.*which).cycles);
  }
}

// Takes every request at once, and notes whose it is.
class NotingTarget : public sc_core::sc_module {
 public:
  tlm_utils::passthrough_target_socket<NotingTarget> socket{"socket"};

  NotingTarget(const sc_core::sc_module_name& name, char who, std::string& order)
      : sc_module(name), who_(who), order_(order) {
    socket.register_nb_transport_fw(this, &NotingTarget::take);
  }

 private:
  tlm::tlm_sync_enum take(tlm::tlm_generic_payload& payload, tlm::tlm_phase&, sc_core::sc_time&) {
    order_ += who_;
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
    return tlm::TLM_COMPLETED;
  }
  const char who_;
  std::string& order_;
};

// A unit that asks for memory and comes to a FIFO at time 0.
class Starter {
 public:
  // asked, pushed: who did, in their order.
  Starter(const std::string& name, char who, const ClockDomain& clock, std::string& asked,
          std::string& pushed)
      : ask_((name + "_ask").c_str(), clock),
        push_((name + "_push").c_str(), clock),
        fifo_((name + "_fifo").c_str(), clock, 1),
        target_((name + "_target").c_str(), who, asked),
        unit_((name + "_unit").c_str(), MemoryPortConfig{},
              {[this](MemoryPort& port) { start_read(port, ask_, 0, &byte_, 1, 0); },
               [this, who, &pushed](MemoryPort&) {
                 fifo_.push(0, push_);
                 pushed += who;
               }}) {
    unit_.port.socket.bind(target_.socket);
  }

 private:
  std::uint8_t byte_ = 0;
  Activity ask_, push_;
  TimedFifo<int> fifo_;
  NotingTarget target_;
  test::Unit unit_;
};

// Two of them in one clock.
struct Start {
  Start(const std::string& name, std::uint64_t jitter_seed)
      : clock(800, jitter_seed),
        a(name + "_a", 'a', clock, asked, pushed),
        b(name + "_b", 'b', clock, asked, pushed) {}
  ClockDomain clock;
  std::string asked, pushed;
  Starter a, b;
};

TEST_CASE("delta jitter: at time 0, when nobody has waited yet, either comes first") {
  constexpr std::uint64_t kSeeds = 20;
  Start plain("plain", 0);
  std::vector<std::unique_ptr<Start>> seeded;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    seeded.push_back(std::make_unique<Start>(fmt::format("seeded{}", seed), seed));
  }
  sc_core::sc_start();
  CHECK(sc_core::sc_time_stamp() == sc_core::SC_ZERO_TIME);
  for (const auto which : {&Start::asked, &Start::pushed}) {
    CHECK(plain.*which == "ab");
    std::size_t turned = 0;
    for (const auto& start : seeded) {
      CHECK((*start.*which).size() == 2);
      turned += *start.*which == "ba" ? 1 : 0;
    }
    CHECK(turned > 0);
    CHECK(turned < kSeeds);
  }
}

}  // namespace
}  // namespace sgs
