// The pipe behind waveform.h.
#include "testbench/waveform/waveform.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sysc/tracing/sc_tracing_ids.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace sgs {
namespace {

[[noreturn]] void fail(const OutputFile& to, const char* what) {
  throw std::runtime_error(fmt::format("{}: {} ({})", to.path(), what, std::strerror(errno)));
}

// Takes what comes through the pipe until its last writer has closed it, also when it cannot be
// written: nobody must wait for room in the pipe.
void copy(int from, OutputFile& to) {
  std::array<char, 1 << 16> bytes;
  while (true) {
    const ssize_t got = ::read(from, bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    to.write(bytes.data(), static_cast<std::size_t>(got));
  }
  ::close(from);
}

sc_core::sc_time_unit unit_of(const std::vector<sc_core::sc_time>& steps) {
  const std::uint64_t picosecond = sc_core::sc_time(1, sc_core::SC_PS).value();
  const bool whole = std::all_of(steps.begin(), steps.end(), [&](const sc_core::sc_time& step) {
    return step.value() % picosecond == 0;
  });
  return whole ? sc_core::SC_PS : sc_core::SC_FS;
}

}  // namespace

Waveform::Waveform(OutputFile& to, const std::vector<sc_core::sc_time>& steps) : to_(to) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) fail(to, "no pipe for the waveform");
  // SystemC adds .vcd to the name that it is given, and takes no open file.
  const std::string link = to.temporary_path() + ".vcd";
  if (::symlink(fmt::format("/proc/self/fd/{}", ends[1]).c_str(), link.c_str()) != 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    fail(to, "no link to the waveform's pipe");
  }
  sc_core::sc_report_handler::set_actions(sc_core::SC_ID_TRACING_TIMESCALE_UNIT_, sc_core::SC_INFO,
                                          sc_core::SC_DO_NOTHING);
  file_ = sc_core::sc_create_vcd_trace_file(to.temporary_path().c_str());
  file_->set_time_unit(1, unit_of(steps));
  // Opens the file, which would happen at the first change of a signal otherwise.
  file_->write_comment("waveform of a StreamingGS simulation");
  ::unlink(link.c_str());
  ::close(ends[1]);
  copier_ = std::thread(copy, ends[0], std::ref(to_));
}

Waveform::~Waveform() { end(); }

void Waveform::close() {
  end();
  to_.finish();
}

void Waveform::end() {
  if (file_ == nullptr) return;
  sc_core::sc_close_vcd_trace_file(file_);
  file_ = nullptr;
  copier_.join();
}

}  // namespace sgs
