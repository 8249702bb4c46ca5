// The protocol checker finds each planted breach, and nothing in a clean exchange.
#include "tlm/protocol_checker.h"

#include <catch2/catch.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "tlm/payload_pool.h"

namespace sgs {
namespace {

// Both ends are scripted: what the target returns and what it calls back with.
struct Ends : sc_core::sc_module {
  tlm_utils::simple_initiator_socket<Ends> initiator{"initiator"};
  tlm_utils::passthrough_target_socket<Ends> target{"target"};
  tlm::tlm_sync_enum answer = tlm::TLM_ACCEPTED;  // of the target to requests
  std::optional<tlm::tlm_phase> changed;          // what the target makes of their phase
  tlm::tlm_sync_enum taken = tlm::TLM_ACCEPTED;   // of the initiator to what comes back

  explicit Ends(const sc_core::sc_module_name& name) : sc_module(name) {
    initiator.register_nb_transport_bw(this, &Ends::nb_transport_bw);
    target.register_nb_transport_fw(this, &Ends::nb_transport_fw);
    target.register_b_transport(this, &Ends::b_transport);
  }
  tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload&, tlm::tlm_phase&,
                                     sc_core::sc_time&) {
    return taken;
  }
  tlm::tlm_sync_enum nb_transport_fw(tlm::tlm_generic_payload&, tlm::tlm_phase& phase,
                                     sc_core::sc_time&) {
    phase = changed.value_or(phase);
    return answer;
  }
  void b_transport(tlm::tlm_generic_payload&, sc_core::sc_time&) {}
};

struct Bench {
  Bench() {
    sc_core::sc_report_handler::set_actions(sc_core::SC_WARNING, sc_core::SC_DO_NOTHING);
    ends.initiator.bind(checker.from_initiator);
    checker.to_target.bind(ends.target);
  }
  PooledPayload& make() {
    PooledPayload& p = pool.acquire();
    p.set_command(tlm::TLM_READ_COMMAND);
    p.set_data_ptr(p.buffer(4));
    p.set_data_length(4);
    p.set_streaming_width(4);
    return p;
  }
  void forward(tlm::tlm_generic_payload& p, tlm::tlm_phase phase, double delay_ns = 0) {
    sc_core::sc_time delay(delay_ns, sc_core::SC_NS);
    ends.initiator->nb_transport_fw(p, phase, delay);
  }
  void backward(tlm::tlm_generic_payload& p, tlm::tlm_phase phase, double delay_ns = 0) {
    sc_core::sc_time delay(delay_ns, sc_core::SC_NS);
    ends.target->nb_transport_bw(p, phase, delay);
  }
  void respond(tlm::tlm_generic_payload& p) {
    p.set_response_status(tlm::TLM_OK_RESPONSE);
    backward(p, tlm::BEGIN_RESP);
  }
  bool found(const std::string& what) const {
    for (const std::string& violation : checker.violations())
      if (violation.find(what) != std::string::npos) return true;
    return false;
  }

  PayloadPool pool;
  Ends ends{sc_core::sc_gen_unique_name("ends")};
  ProtocolChecker checker{sc_core::sc_gen_unique_name("checker")};
};

TEST_CASE("protocol checker: two overlapping clean transactions raise nothing") {
  Bench b;
  sc_core::sc_start(sc_core::SC_ZERO_TIME);
  PooledPayload& p = b.make();
  PooledPayload& q = b.make();
  b.forward(p, tlm::BEGIN_REQ);
  b.backward(p, tlm::END_REQ);
  b.forward(q, tlm::BEGIN_REQ);
  b.respond(p);
  b.backward(q, tlm::END_REQ);
  b.forward(p, tlm::END_RESP);
  b.respond(q);
  b.forward(q, tlm::END_RESP);
  CHECK(b.checker.violations().empty());
  CHECK(b.checker.in_flight() == 0);
  CHECK(b.checker.finished() == 2);
}

TEST_CASE("protocol checker: an early completion ends a transaction, even beside a response") {
  Bench b;
  sc_core::sc_start(sc_core::SC_ZERO_TIME);
  PooledPayload& p = b.make();
  b.forward(p, tlm::BEGIN_REQ);
  b.respond(p);
  PooledPayload& q = b.make();
  b.ends.answer = tlm::TLM_COMPLETED;
  b.forward(q, tlm::BEGIN_REQ);
  CHECK(b.found("TLM_COMPLETED with TLM_INCOMPLETE_RESPONSE"));
  CHECK(b.checker.violations().size() == 1);
  CHECK(b.checker.in_flight() == 1);
}

TEST_CASE("protocol checker: planted breaches") {
  struct Case {
    const char* what;
    std::function<void(Bench&)> act;
  };
  const std::vector<Case> cases = {
      {"BEGIN_REQ before the END_REQ of the one before",
       [](Bench& b) {
         b.forward(b.make(), tlm::BEGIN_REQ);
         b.forward(b.make(), tlm::BEGIN_REQ);
       }},
      {"BEGIN_REQ of a transaction that is in flight",
       [](Bench& b) {
         PooledPayload& p = b.make();
         b.forward(p, tlm::BEGIN_REQ);
         b.backward(p, tlm::END_REQ);
         b.forward(p, tlm::BEGIN_REQ);
       }},
      {"END_REQ of a transaction that is not in flight",
       [](Bench& b) { b.backward(b.make(), tlm::END_REQ); }},
      {"END_REQ out of order",
       [](Bench& b) {
         PooledPayload& p = b.make();
         b.forward(p, tlm::BEGIN_REQ);
         b.backward(p, tlm::END_REQ);
         b.backward(p, tlm::END_REQ);
       }},
      {"a second BEGIN_RESP",
       [](Bench& b) {
         PooledPayload& p = b.make();
         b.forward(p, tlm::BEGIN_REQ);
         b.respond(p);
         b.respond(p);
       }},
      {"BEGIN_RESP before the END_RESP of the one before",
       [](Bench& b) {
         PooledPayload& p = b.make();
         PooledPayload& q = b.make();
         b.forward(p, tlm::BEGIN_REQ);
         b.backward(p, tlm::END_REQ);
         b.forward(q, tlm::BEGIN_REQ);
         b.respond(p);
         b.respond(q);
       }},
      {"END_RESP without BEGIN_RESP",
       [](Bench& b) {
         PooledPayload& p = b.make();
         b.forward(p, tlm::BEGIN_REQ);
         b.forward(p, tlm::END_RESP);
       }},
      {"BEGIN_RESP with TLM_INCOMPLETE_RESPONSE",
       [](Bench& b) {
         PooledPayload& p = b.make();
         b.forward(p, tlm::BEGIN_REQ);
         b.backward(p, tlm::BEGIN_RESP);
       }},
      {"status is not TLM_INCOMPLETE_RESPONSE",
       [](Bench& b) {
         PooledPayload& p = b.make();
         p.set_response_status(tlm::TLM_OK_RESPONSE);
         b.forward(p, tlm::BEGIN_REQ);
       }},
      {"an attribute changed between request and response",
       [](Bench& b) {
         PooledPayload& p = b.make();
         b.forward(p, tlm::BEGIN_REQ);
         p.set_data_length(3);
         b.respond(p);
       }},
      {"without memory manager",
       [](Bench& b) {
         static tlm::tlm_generic_payload bare;
         static std::uint8_t data[4];
         bare.set_command(tlm::TLM_READ_COMMAND);
         bare.set_data_ptr(data);
         bare.set_data_length(4);
         bare.set_streaming_width(4);
         b.forward(bare, tlm::BEGIN_REQ);
       }},
      {"time runs backwards",
       [](Bench& b) {
         PooledPayload& p = b.make();
         b.forward(p, tlm::BEGIN_REQ, 10);
         b.backward(p, tlm::END_REQ, 5);
       }},
      {"a read or write without data",
       [](Bench& b) {
         PooledPayload& p = b.make();
         p.set_data_ptr(nullptr);
         b.forward(p, tlm::BEGIN_REQ);
       }},
      {"streaming width 0",
       [](Bench& b) {
         PooledPayload& p = b.make();
         p.set_streaming_width(0);
         b.forward(p, tlm::BEGIN_REQ);
       }},
      {"the phase was changed by a call that returned TLM_ACCEPTED",
       [](Bench& b) {
         b.ends.changed = tlm::END_REQ;
         b.forward(b.make(), tlm::BEGIN_REQ);
       }},
      {"TLM_COMPLETED returned to a call that was not BEGIN_RESP",
       [](Bench& b) {
         PooledPayload& p = b.make();
         b.forward(p, tlm::BEGIN_REQ);
         b.ends.taken = tlm::TLM_COMPLETED;
         b.backward(p, tlm::END_REQ);
       }},
      {"on the forward path", [](Bench& b) { b.forward(b.make(), tlm::END_REQ); }},
      {"on the backward path",
       [](Bench& b) {
         PooledPayload& p = b.make();
         b.forward(p, tlm::BEGIN_REQ);
         b.backward(p, tlm::END_RESP);
       }},
      {"b_transport returned with TLM_INCOMPLETE_RESPONSE",
       [](Bench& b) {
         sc_core::sc_time delay;
         b.ends.initiator->b_transport(b.make(), delay);
       }},
  };
  // A breach spoils its hop, and a process elaborates once: a hop for each, made beforehand.
  std::vector<std::unique_ptr<Bench>> benches;
  for (std::size_t i = 0; i < cases.size(); ++i) benches.push_back(std::make_unique<Bench>());
  sc_core::sc_start(sc_core::SC_ZERO_TIME);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    INFO(cases[i].what);
    cases[i].act(*benches[i]);
    CHECK(benches[i]->found(cases[i].what));
  }
}

}  // namespace
}  // namespace sgs
