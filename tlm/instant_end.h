// The end of an instant: when everything that happens at the present simulated time has happened.
//
// The standard leaves open in which order the kernel runs the processes of one instant. An arbiter
// that took requests as they are made would let results depend on that order. Arbiters therefore
// collect all requests and decide here, in an order of their own.
#pragma once

#include <systemc>
#include <vector>

namespace sgs {

// One for all arbiters of a simulation: two would take each other's waiting for activity.
class InstantEnd : public sc_core::sc_module {
 public:
  class Arbiter {
   public:
    // Decides on all that was asked for up to now. Requests that follow at the same time get an end
    // of their own.
    virtual void decide() = 0;

   protected:
    ~Arbiter() = default;
  };

  SC_HAS_PROCESS(InstantEnd);
  explicit InstantEnd(const sc_core::sc_module_name& name);
  ~InstantEnd() override;

  // Has arbiter.decide() called at the end of the present instant; once for any number of calls.
  void ask_for(Arbiter& arbiter);

 private:
  void on_delta();  // method

  std::vector<Arbiter*> asked_, deciding_;
  sc_core::sc_event delta_;
};

}  // namespace sgs
