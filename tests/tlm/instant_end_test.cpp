// When an instant is over, and that a simulation has one place that knows.
#include "tlm/instant_end.h"

#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "tests/tlm/threads.h"

namespace sgs {
namespace {

using test::Threads;

class Recorder : public InstantEnd::Arbiter {
 public:
  explicit Recorder(const std::vector<std::string>& events) : events_(events) {}
  void decide() override {
    seen.push_back(events_.size());
    at.push_back(sc_core::sc_time_stamp());
    if (then) then();
  }
  std::vector<std::size_t> seen;  // how much had happened at each call
  std::vector<sc_core::sc_time> at;
  std::function<void()> then;

 private:
  const std::vector<std::string>& events_;
};

TEST_CASE("instant end: called once, when everything of the instant has run") {
  InstantEnd instant_end("instant_end");
  std::vector<std::string> events;
  Recorder first(events), second(events), never(events);
  const auto deltas = [](int count) {
    for (int k = 0; k < count; ++k) sc_core::wait(sc_core::SC_ZERO_TIME);
  };
  Threads threads({[&] {
                     instant_end.ask_for(first);
                     events.emplace_back("at once");
                     instant_end.ask_for(first);
                   },
                   [&] {
                     deltas(7);
                     events.emplace_back("seven deltas later");
                     instant_end.ask_for(second);
                     sc_core::wait(3, sc_core::SC_NS);
                     events.emplace_back("at 3 ns");
                     deltas(2);
                     instant_end.ask_for(first);
                     deltas(2);
                     events.emplace_back("at 3 ns, four deltas later");
                   },
                   [&] {
                     deltas(3);
                     events.emplace_back("three deltas later");
                     instant_end.ask_for(first);
                   }});
  CHECK(threads.run_all());
  CHECK(first.seen == std::vector<std::size_t>{3, 5});
  CHECK(first.at ==
        std::vector<sc_core::sc_time>{sc_core::SC_ZERO_TIME, sc_core::sc_time(3, sc_core::SC_NS)});
  CHECK(second.seen == std::vector<std::size_t>{3});
  CHECK(never.seen.empty());
}

TEST_CASE("instant end: what follows from a decision at the same time gets an end of its own") {
  InstantEnd instant_end("instant_end");
  std::vector<std::string> events;
  Recorder first(events), second(events);
  sc_core::sc_event decided;
  first.then = [&] {
    if (first.seen.size() == 1) decided.notify(sc_core::SC_ZERO_TIME);
    if (first.seen.size() == 2) instant_end.ask_for(second);  // while it decides
  };
  Threads threads({[&] {
    sc_core::wait(1, sc_core::SC_NS);
    instant_end.ask_for(first);
    sc_core::wait(decided);
    events.emplace_back("consequence");
    instant_end.ask_for(first);
    sc_core::wait(sc_core::SC_ZERO_TIME);
    events.emplace_back("its consequence");
  }});
  CHECK(threads.run_all());
  CHECK(first.seen == std::vector<std::size_t>{0, 2});
  CHECK(second.seen == std::vector<std::size_t>{2});
  CHECK(second.at == std::vector<sc_core::sc_time>{sc_core::sc_time(1, sc_core::SC_NS)});
}

TEST_CASE("instant end: a second one is an error, a next one is not") {
  auto first = std::make_unique<InstantEnd>("first");
  CHECK_THROWS_WITH(InstantEnd("second"), Catch::Contains("a simulation can have only one"));
  first.reset();
  CHECK_NOTHROW(InstantEnd("third"));
}

}  // namespace
}  // namespace sgs
