// A waveform whose every byte is accounted for.
#pragma once

#include <systemc>
#include <thread>
#include <vector>

#include "algorithm/files/output_file.h"

namespace sgs {

// SystemC's own file reports no error when the disk is full. Here it writes into a pipe, from which
// a thread takes the bytes to `to`, which whoever made it commits. Time unit: 1 ps where all steps
// are whole picoseconds, else 1 fs: SystemC warns at each moment that lies between two units.
class Waveform {
 public:
  // steps: each moment at which a signal may change is so often one of these after the start.
  // Throws std::runtime_error when the pipe cannot be made.
  Waveform(OutputFile& to, const std::vector<sc_core::sc_time>& steps);
  ~Waveform();
  Waveform(const Waveform&) = delete;
  Waveform& operator=(const Waveform&) = delete;

  // For sc_trace(), before the simulation begins.
  sc_core::sc_trace_file* file() const { return file_; }

  // Ends the waveform at this moment. Throws std::runtime_error when it could not be written whole.
  void close();

 private:
  void end();

  OutputFile& to_;
  sc_core::sc_trace_file* file_ = nullptr;
  std::thread copier_;
};

}  // namespace sgs
