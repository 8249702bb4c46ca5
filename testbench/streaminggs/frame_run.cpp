// The child process simulates and writes its result into a pipe; the parent reads it.
#include "testbench/streaminggs/frame_run.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <systemc>

#include "modules/accelerator.h"
#include "modules/dram/command_trace.h"
#include "testbench/streaminggs/measurements.h"
#include "tlm/time_resolution.h"

namespace sgs {
namespace {

void write_all(int descriptor, const void* from, std::size_t bytes) {
  const char* at = static_cast<const char*>(from);
  while (bytes > 0) {
    const ssize_t written = ::write(descriptor, at, bytes);
    if (written <= 0) throw std::runtime_error("cannot hand the frame to the parent process");
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

bool read_all(int descriptor, void* into, std::size_t bytes) {
  char* at = static_cast<char*>(into);
  while (bytes > 0) {
    const ssize_t got = ::read(descriptor, at, bytes);
    if (got <= 0) return false;
    at += got;
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

void send(int descriptor, const void* from, std::uint64_t bytes) {
  write_all(descriptor, &bytes, sizeof bytes);
  write_all(descriptor, from, bytes);
}

template <class Container>
bool receive(int descriptor, Container& into) {
  std::uint64_t bytes = 0;
  if (!read_all(descriptor, &bytes, sizeof bytes)) return false;
  into.resize(bytes);
  return read_all(descriptor, into.data(), bytes);
}

// The waveform, closed (and so complete) when it goes out of scope.
class Waveform {
 public:
  Waveform(const std::string& path, const Accelerator& accelerator) {
    if (path.empty()) return;
    // SystemC adds the extension itself.
    const std::string stem = path.size() > 4 && path.substr(path.size() - 4) == ".vcd"
                                 ? path.substr(0, path.size() - 4)
                                 : path;
    file_ = sc_core::sc_create_vcd_trace_file(stem.c_str());
    file_->set_time_unit(1, sc_core::SC_PS);
    accelerator.trace(file_);
  }
  ~Waveform() {
    if (file_ != nullptr) sc_core::sc_close_vcd_trace_file(file_);
  }
  Waveform(const Waveform&) = delete;
  Waveform& operator=(const Waveform&) = delete;

 private:
  sc_core::sc_trace_file* file_ = nullptr;
};

// An error that a unit reports ends the child where it is: thrown through the stack of a SystemC
// process it would upset AddressSanitizer, and there is nothing to unwind for.
void end_on_error(const sc_core::sc_report& report, const sc_core::sc_actions& actions) {
  if (report.get_severity() < sc_core::SC_ERROR) {
    sc_core::sc_report_handler::default_handler(report, actions);
    return;
  }
  std::fprintf(stderr, "streaminggs: %s: %s\n", report.get_msg_type(), report.get_msg());
  std::fflush(nullptr);
  ::_exit(1);
}

void simulate(const AcceleratorConfig& config, const FrameJob& job, const MemoryImage& image,
              const RunOptions& options, int result) {
  use_femtosecond_resolution();
  sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
  sc_core::sc_report_handler::set_handler(end_on_error);
  std::optional<StallInjector> stalls;
  constexpr std::uint32_t kLongestStallCycles = 20;
  if (options.stall_probability > 0) {
    stalls.emplace(options.seed, options.stall_probability, kLongestStallCycles);
  }
  Accelerator accelerator("accelerator", config, job, image, options.timing,
                          stalls ? &*stalls : nullptr);
  std::optional<CommandTraceWriter> dram_trace;
  if (!options.dram_trace_path.empty()) {
    dram_trace.emplace(options.dram_trace_path, CommandTraceHeader::of(config.dram));
    accelerator.dram().add_command_sink(*dram_trace);
  }
  {
    const Waveform waveform(options.vcd_path, accelerator);
    accelerator.run();
  }
  if (dram_trace) dram_trace->close();
  const std::string measurements = measure(accelerator);
  send(result, measurements.data(), measurements.size());
  const std::vector<std::byte> frame = accelerator.read_frame();
  send(result, frame.data(), frame.size());
}

[[noreturn]] void child(const AcceleratorConfig& config, const FrameJob& job,
                        const MemoryImage& image, const RunOptions& options, int result) {
  int status = 0;
  try {
    simulate(config, job, image, options, result);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "streaminggs: %s\n", error.what());
    status = 1;
  }
  std::fflush(nullptr);
  ::_exit(status);
}

}  // namespace

FrameRun run_frame(const AcceleratorConfig& config, const FrameJob& job, const MemoryImage& image,
                   const RunOptions& options) {
  const auto began = std::chrono::steady_clock::now();
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe for the simulation");
  std::fflush(nullptr);
  const pid_t process = ::fork();
  if (process < 0) throw std::runtime_error("cannot start a process for the simulation");
  if (process == 0) {
    ::close(ends[0]);
    child(config, job, image, options, ends[1]);
  }
  ::close(ends[1]);
  FrameRun run;
  const bool complete = receive(ends[0], run.measurements_json) && receive(ends[0], run.frame);
  ::close(ends[0]);
  int status = 0;
  ::waitpid(process, &status, 0);
  if (WIFSIGNALED(status)) {
    throw std::runtime_error("the simulation of the frame was ended by signal " +
                             std::to_string(WTERMSIG(status)));
  }
  if (!complete || WEXITSTATUS(status) != 0) {
    throw std::runtime_error("the simulation of the frame failed");
  }
  run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return run;
}

}  // namespace sgs
