// The router: ranges, the order of requests of one instant, and every way of the base protocol.
#include "tlm/router.h"

#include <fmt/format.h>
#include <tlm_utils/multi_passthrough_target_socket.h>

#include <catch2/catch.hpp>
#include <memory>
#include <stdexcept>

#include "tests/tlm/scripted_ends.h"
#include "tests/tlm/threads.h"
#include "tlm/memory_extension.h"
#include "tlm/payload_pool.h"
#include "tlm/protocol_checker.h"

namespace sgs {
namespace {

using test::Threads;

// Answers everything at once, and remembers from where it came.
class Target : public sc_core::sc_module {
 public:
  tlm_utils::multi_passthrough_target_socket<Target> socket;
  explicit Target(const sc_core::sc_module_name& name) : sc_module(name), socket("socket") {
    socket.register_b_transport(this, &Target::b_transport);
    socket.register_nb_transport_fw(this, &Target::nb_transport_fw);
    socket.register_transport_dbg(this, &Target::transport_dbg);
  }
  struct Seen {
    int from;
    std::uint64_t address;
    bool operator==(const Seen& other) const {
      return from == other.from && address == other.address;
    }
  };
  std::vector<Seen> seen;

 private:
  void b_transport(int from, tlm::tlm_generic_payload& payload, sc_core::sc_time&) {
    seen.push_back({from, payload.get_address()});
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
  }
  tlm::tlm_sync_enum nb_transport_fw(int from, tlm::tlm_generic_payload& payload, tlm::tlm_phase&,
                                     sc_core::sc_time& delay) {
    b_transport(from, payload, delay);
    return tlm::TLM_COMPLETED;
  }
  unsigned int transport_dbg(int from, tlm::tlm_generic_payload& payload) {
    seen.push_back({from, payload.get_address()});
    return payload.get_data_length();
  }
};

// Ends every response at once, and keeps its status.
class Source : public sc_core::sc_module {
 public:
  tlm_utils::simple_initiator_socket<Source> socket{"socket"};
  explicit Source(const sc_core::sc_module_name& name) : sc_module(name) {
    socket.register_nb_transport_bw(this, &Source::nb_transport_bw);
  }
  PooledPayload& make(std::uint64_t address, unsigned length) {
    PooledPayload& p = pool.acquire();
    p.set_command(tlm::TLM_READ_COMMAND);
    p.set_address(address);
    p.set_data_ptr(p.buffer(length));
    p.set_data_length(length);
    p.set_streaming_width(length);
    return p;
  }
  tlm::tlm_sync_enum begin(PooledPayload& p) {
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    return socket->nb_transport_fw(p, phase, delay);
  }
  PayloadPool pool;
  std::vector<tlm::tlm_response_status> answers;

 private:
  tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload& p, tlm::tlm_phase&,
                                     sc_core::sc_time&) {
    answers.push_back(p.get_response_status());
    return tlm::TLM_COMPLETED;
  }
};

TEST_CASE("router: transactions reach the target of their range, others are refused") {
  InstantEnd instant_end("instant_end");
  Router router("router", instant_end, 2, 2);
  Target low("low"), high("high");
  Source a("a"), b("b");
  a.socket.bind(router.from_initiators[0]);
  b.socket.bind(router.from_initiators[1]);
  router.map(0x1000, 0x1000, low.socket);
  CHECK_THROWS_AS(router.map(0x1fff, 1, high.socket), std::invalid_argument);
  CHECK_THROWS_AS(router.map(0x9000, 0, high.socket), std::invalid_argument);
  CHECK_THROWS_AS(router.map(~std::uint64_t{0} - 7, 16, high.socket), std::invalid_argument);
  router.map(0x2000, 0x1000, high.socket);
  CHECK_THROWS_AS(router.map(0x5000, 0x1000, high.socket), std::invalid_argument);

  const auto send = [](Source& source, std::uint64_t address, unsigned length) {
    PooledPayload& p = source.make(address, length);
    sc_core::sc_time delay;
    source.socket->b_transport(p, delay);
    const tlm::tlm_response_status blocking = p.get_response_status();
    const bool known = blocking == tlm::TLM_OK_RESPONSE;
    p.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
    CHECK(source.begin(p) == (known ? tlm::TLM_ACCEPTED : tlm::TLM_COMPLETED));
    sc_core::wait(1, sc_core::SC_NS);
    CHECK(p.get_response_status() == blocking);
    CHECK(source.answers.size() == (known ? 1U : 0U));
    source.answers.clear();
    CHECK(source.socket->transport_dbg(p) == (known ? length : 0));
    p.release();
    return blocking;
  };
  Threads threads({[&] {
    CHECK(send(a, 0x1000, 4) == tlm::TLM_OK_RESPONSE);
    CHECK(send(b, 0x2ffc, 4) == tlm::TLM_OK_RESPONSE);
    // Over the border of two ranges.
    CHECK(send(a, 0x1ffe, 4) == tlm::TLM_ADDRESS_ERROR_RESPONSE);
    CHECK(send(a, 0x3000, 4) == tlm::TLM_ADDRESS_ERROR_RESPONSE);
    CHECK(send(a, 0x0fff, 1) == tlm::TLM_ADDRESS_ERROR_RESPONSE);
  }});
  CHECK(threads.run_all());
  using Seen = std::vector<Target::Seen>;
  CHECK(low.seen == Seen{{0, 0x1000}, {0, 0x1000}, {0, 0x1000}});
  CHECK(high.seen == Seen{{1, 0x2ffc}, {1, 0x2ffc}, {1, 0x2ffc}});
}

TEST_CASE("router: requests of one instant arrive in the order of the initiators") {
  constexpr std::uint32_t kSources = 4;
  InstantEnd instant_end("instant_end");
  Router router("router", instant_end, kSources);
  Target memory("memory");
  router.map(0, 1 << 20, memory.socket);
  sc_core::sc_vector<Source> sources("source", kSources);
  for (std::uint32_t i = 0; i < kSources; ++i) sources[i].socket.bind(router.from_initiators[i]);
  const auto send = [&](std::uint32_t from, std::uint64_t address) {
    PooledPayload& p = sources[from].make(address, 1);
    sources[from].begin(p);
    CHECK(p.memory().requester == from);
    p.release();
  };
  // Made last first, and at the same time after different numbers of delta cycles.
  Threads threads({[&] {
                     send(3, 10);
                     sc_core::wait(5, sc_core::SC_NS);
                     send(3, 20);
                   },
                   [&] {
                     sc_core::wait(5, sc_core::SC_NS);
                     for (int k = 0; k < 3; ++k) sc_core::wait(sc_core::SC_ZERO_TIME);
                     send(0, 20);
                   },
                   [&] {
                     send(2, 10);
                     sc_core::wait(5, sc_core::SC_NS);
                     sc_core::wait(sc_core::SC_ZERO_TIME);
                     send(2, 20);
                   },
                   [&] { send(1, 10); }});
  CHECK(threads.run_all());
  CHECK(memory.seen ==
        std::vector<Target::Seen>{{1, 10}, {2, 10}, {3, 10}, {0, 20}, {2, 20}, {3, 20}});
}

// An initiator and a target, with a checker on each hop; with a router between them or without.
struct Chain {
  Chain(const test::ScriptedInitiator::Script& script, test::Answers answers,
        InstantEnd* instant_end)
      : initiator(sc_core::sc_gen_unique_name("initiator"), script),
        target(sc_core::sc_gen_unique_name("target"), answers) {
    initiator.socket.bind(before.from_initiator);
    after.to_target.bind(target.socket);
    if (instant_end == nullptr) {
      before.to_target.bind(after.from_initiator);
      return;
    }
    router = std::make_unique<Router>(sc_core::sc_gen_unique_name("router"), *instant_end, 1);
    before.to_target.bind(router->from_initiators[0]);
    router->map(0, 1 << 20, after.from_initiator);
  }
  test::ScriptedInitiator initiator;
  test::ScriptedTarget target;
  ProtocolChecker before{sc_core::sc_gen_unique_name("before")};
  ProtocolChecker after{sc_core::sc_gen_unique_name("after")};
  std::unique_ptr<Router> router;
};

TEST_CASE("router: whatever way of the base protocol both ends use, it keeps it and adds no time") {
  using test::Answers;
  using test::Ends;
  InstantEnd instant_end("instant_end");
  struct Row {
    std::string what;
    bool ends_at_once;
    std::unique_ptr<Chain> direct, routed;
  };
  std::vector<Row> rows;
  for (int answers = 0; answers <= static_cast<int>(Answers::kMixed); ++answers) {
    for (const Ends ends : {Ends::kByCompletion, Ends::kByPhase, Ends::kByCall}) {
      for (const double delay_ns : {0.0, 3.0}) {
        test::ScriptedInitiator::Script script;
        script.ends = ends;
        script.request_delay = sc_core::sc_time(delay_ns, sc_core::SC_NS);
        const auto how = static_cast<Answers>(answers);
        rows.push_back({fmt::format("answers {}, ends {}, delay {}", answers,
                                    static_cast<int>(ends), delay_ns),
                        ends != Ends::kByCall, std::make_unique<Chain>(script, how, nullptr),
                        std::make_unique<Chain>(script, how, &instant_end)});
      }
    }
  }
  sc_core::sc_start();
  const std::size_t requests = test::ScriptedInitiator::Script{}.requests;
  for (const Row& row : rows) {
    INFO(row.what);
    for (const Chain* chain : {row.direct.get(), row.routed.get()}) {
      CHECK(chain->initiator.answers.size() == requests);
      CHECK(chain->initiator.right == static_cast<int>(requests));
      CHECK(chain->initiator.payloads().in_use() == 0);
      for (const ProtocolChecker* checker : {&chain->before, &chain->after}) {
        CHECK(checker->violations() == std::vector<std::string>{});
        CHECK(checker->in_flight() == 0);
        CHECK(checker->finished() == requests);
      }
    }
    // A response that is ended late holds up one that the target completes by itself.
    if (!row.ends_at_once) continue;
    CHECK(row.routed->initiator.request_ends == row.direct->initiator.request_ends);
    CHECK(row.routed->initiator.answers == row.direct->initiator.answers);
  }
}

}  // namespace
}  // namespace sgs
