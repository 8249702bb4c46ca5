// Is told when an instant of simulated time is over: nothing more happens in it.
#pragma once

#include <functional>
#include <string>
#include <systemc>

namespace sgs {

// The kernel tells its trace files; this is one that traces nothing. To be made before the
// simulation begins. While none lives nothing is called.
class InstantWatcher : public sc_core::sc_trace_file {
 public:
  explicit InstantWatcher(std::function<void()> over) : over_(std::move(over)) {
    sc_core::sc_get_curr_simcontext()->add_trace_file(this);
  }
  ~InstantWatcher() override { sc_core::sc_get_curr_simcontext()->remove_trace_file(this); }
  InstantWatcher(const InstantWatcher&) = delete;
  InstantWatcher& operator=(const InstantWatcher&) = delete;

 protected:
  void cycle(bool delta) override {
    if (!delta) over_();
  }

 private:
#define SGS_NOT_TRACED(Type) \
  void trace(const Type&, const std::string&) override {}
#define SGS_NOT_TRACED_WIDE(Type) \
  void trace(const Type&, const std::string&, int) override {}
  SGS_NOT_TRACED(sc_core::sc_event)
  SGS_NOT_TRACED(sc_core::sc_time)
  SGS_NOT_TRACED(bool)
  SGS_NOT_TRACED(sc_dt::sc_bit)
  SGS_NOT_TRACED(sc_dt::sc_logic)
  SGS_NOT_TRACED_WIDE(unsigned char)
  SGS_NOT_TRACED_WIDE(unsigned short)
  SGS_NOT_TRACED_WIDE(unsigned int)
  SGS_NOT_TRACED_WIDE(unsigned long)
  SGS_NOT_TRACED_WIDE(char)
  SGS_NOT_TRACED_WIDE(short)
  SGS_NOT_TRACED_WIDE(int)
  SGS_NOT_TRACED_WIDE(long)
  SGS_NOT_TRACED_WIDE(sc_dt::int64)
  SGS_NOT_TRACED_WIDE(sc_dt::uint64)
  SGS_NOT_TRACED(float)
  SGS_NOT_TRACED(double)
  SGS_NOT_TRACED(sc_dt::sc_int_base)
  SGS_NOT_TRACED(sc_dt::sc_uint_base)
  SGS_NOT_TRACED(sc_dt::sc_signed)
  SGS_NOT_TRACED(sc_dt::sc_unsigned)
  SGS_NOT_TRACED(sc_dt::sc_fxval)
  SGS_NOT_TRACED(sc_dt::sc_fxval_fast)
  SGS_NOT_TRACED(sc_dt::sc_fxnum)
  SGS_NOT_TRACED(sc_dt::sc_fxnum_fast)
  SGS_NOT_TRACED(sc_dt::sc_bv_base)
  SGS_NOT_TRACED(sc_dt::sc_lv_base)
#undef SGS_NOT_TRACED
#undef SGS_NOT_TRACED_WIDE
  void trace(const unsigned int&, const std::string&, const char**) override {}
  void write_comment(const std::string&) override {}
  void set_time_unit(double, sc_core::sc_time_unit) override {}

  const std::function<void()> over_;
};

}  // namespace sgs
