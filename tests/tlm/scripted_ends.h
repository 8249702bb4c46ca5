// An initiator and a target that use the base protocol in one of the ways that it allows.
#pragma once

#include <tlm_utils/passthrough_target_socket.h>
#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <map>
#include <systemc>
#include <tlm>
#include <utility>
#include <vector>

#include "tlm/payload_pool.h"

namespace sgs::test {

// How responses are ended: by the call that begins them, or by one some time later.
enum class Ends { kByCompletion, kByPhase, kByCall };

// How requests are answered. kMixed: each time in the next of the other ways.
enum class Answers {
  kCompleted,        // TLM_COMPLETED
  kCompletedLater,   // TLM_COMPLETED with a delay
  kEndOfRequest,     // TLM_UPDATED with END_REQ; BEGIN_RESP is called
  kResponse,         // TLM_UPDATED with BEGIN_RESP
  kResponseLater,    // TLM_UPDATED with BEGIN_RESP and a delay
  kCalls,            // TLM_ACCEPTED; END_REQ and BEGIN_RESP are called
  kResponseCall,     // TLM_ACCEPTED; BEGIN_RESP alone is called
  kCallsWithDelays,  // TLM_ACCEPTED; both are called with a delay
  kMixed
};

// Sends requests, one as soon as the one before has ended.
class ScriptedInitiator : public sc_core::sc_module {
 public:
  tlm_utils::simple_initiator_socket<ScriptedInitiator> socket;

  struct Script {
    Ends ends = Ends::kByCompletion;
    sc_core::sc_time request_delay;  // annotated
    int requests = 12;
  };
  SC_HAS_PROCESS(ScriptedInitiator);
  ScriptedInitiator(const sc_core::sc_module_name& name, const Script& script);

  // When each request ended and each response began, and whether the byte that was read is that of
  // its address.
  std::vector<sc_core::sc_time> request_ends, answers;
  int right = 0;
  const PayloadPool& payloads() const { return pool_; }

 private:
  void run();   // thread
  void ends();  // thread: responses that wait for it
  void end_response(tlm::tlm_generic_payload& payload);
  void ended(const tlm::tlm_generic_payload& payload, const sc_core::sc_time& delay);
  void answered(const tlm::tlm_generic_payload& payload, const sc_core::sc_time& delay);
  tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                     sc_core::sc_time& delay);

  const Script script_;
  PayloadPool pool_;
  const tlm::tlm_generic_payload* requesting_ = nullptr;
  sc_core::sc_time ended_at_;  // the last request
  sc_core::sc_event may_request_, may_end_;
  tlm::tlm_generic_payload* to_end_ = nullptr;  // its response is open
  sc_core::sc_time end_at_;
};

// A read gives the byte address / 64.
class ScriptedTarget : public sc_core::sc_module {
 public:
  tlm_utils::passthrough_target_socket<ScriptedTarget> socket;

  SC_HAS_PROCESS(ScriptedTarget);
  ScriptedTarget(const sc_core::sc_module_name& name, Answers answers);

 private:
  struct Call {
    tlm::tlm_generic_payload* payload;
    tlm::tlm_phase phase;
    sc_core::sc_time delay;
  };
  void run();  // thread
  void call(const Call& call);
  void call_later(double ns, const sc_core::sc_time& delay, const Call& call);
  tlm::tlm_sync_enum nb_transport_fw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                     sc_core::sc_time& delay);
  tlm::tlm_sync_enum answer(Answers how, tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                            sc_core::sc_time& delay);

  const Answers answers_;
  int requests_ = 0;
  const tlm::tlm_generic_payload* open_ = nullptr;  // BEGIN_RESP sent, END_RESP not seen
  sc_core::sc_event ended_, changed_;
  std::multimap<sc_core::sc_time, Call> calls_;
};

}  // namespace sgs::test
