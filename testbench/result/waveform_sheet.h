// The waveform as a visitor of data sheets: every activity, queue, port and signal under its name
// in the hierarchy.
#pragma once

#include <string>
#include <systemc>

#include "tlm/data_sheet.h"

namespace sgs {

class WaveformSheet : public DataSheet {
 public:
  explicit WaveformSheet(sc_core::sc_trace_file* file) : file_(file) {}

  void unit(const sc_core::sc_object& unit) override { unit_ = unit.name(); }
  void activity(Activity& activity, const char*, const char*) override { activity.trace(file_); }
  void queue(FifoChannel& queue, const char*) override { queue.trace(file_); }
  void port(MemoryPort& port, const char*) override { port.trace(file_); }
  void signal(const char* name, const std::uint32_t& value) override {
    sc_core::sc_trace(file_, value, unit_ + "." + name);
  }
  void signal(const char* name, const bool& value) override {
    sc_core::sc_trace(file_, value, unit_ + "." + name);
  }

 private:
  sc_core::sc_trace_file* file_;
  std::string unit_;
};

}  // namespace sgs
