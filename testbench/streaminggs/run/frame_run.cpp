// Machine and memory put together, and time.
#include "testbench/streaminggs/run/frame_run.h"

#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <systemc>
#include <utility>
#include <vector>

#include "algorithm/files/output_file.h"
#include "modules/display/display.h"
#include "modules/dram/command_trace.h"
#include "modules/dram/dram_controller.h"
#include "testbench/process/child_process.h"
#include "testbench/result/collect.h"
#include "testbench/result/collect_memory.h"
#include "testbench/result/frame_result.h"
#include "testbench/result/sram_budget.h"
#include "testbench/result/waveform_sheet.h"
#include "testbench/streaminggs/run/progress.h"
#include "testbench/timeline/timeline.h"
#include "testbench/waveform/waveform.h"
#include "tlm/run_simulation.h"
#include "tlm/time_resolution.h"

namespace sgs {
namespace {

// Null: not wanted.
struct Outputs {
  OutputFile* vcd = nullptr;
  OutputFile* timeline = nullptr;
  GroupRange timeline_groups;
  OutputFile* dram_trace = nullptr;
};

// How the frames of a stream are shown; none of a single frame.
struct Shown {
  double rate;
  ShownPictures* pictures;
};

// Display of a stream in the simulation, and the frames that it shows.
class Stream {
 public:
  Stream(const FrameJob& job, const Shown& shown, Machine& machine, DramController& memory)
      : job_(job),
        rate_(shown.rate),
        display_("display", job, shown.rate, machine.clock().period()) {
    result_.frames.resize(job.frames());
    machine.host.bind(display_);
    machine.bind_display(display_.memory);
    display_.on_rest = [&memory](bool rests) { memory.rest(rests); };
    display_.on_shown = [&job, &memory, pictures = shown.pictures](
                            std::uint32_t frame, std::uint32_t eye, const std::byte* bytes) {
      if (bytes != nullptr) return pictures->write(frame, eye, bytes);
      std::vector<std::byte> drawn(job.frame_buffer.bytes);
      memory.read_back(job.picture(frame, eye).frame_buffer.base, drawn.data(), drawn.size());
      pictures->write(frame, eye, drawn.data());
    };
  }

  void publish(DataSheet& sheet) { display_.publish(sheet); }
  sc_core::sc_time rested() const { return display_.rested(); }

  // Simulates until the last frame is shown. counts(): those up to now.
  template <class Counts>
  void run(const Counts& counts) {
    if (rate_ == 0) return;
    std::vector<FrameResult>& at = result_.first_and_last_shown;
    for (std::uint64_t picture = 1; display_.frames_shown() < job_.frames(); ++picture) {
      run_simulation_until(display_.due(picture) + sc_core::sc_get_time_resolution());
      if (display_.frames_shown() > 0 && at.empty()) at.push_back(counts());
    }
    at.push_back(counts());
  }

  StreamResult result() {
    for (std::uint32_t frame = 0; frame < job_.frames(); ++frame) {
      const FrameTimes& times = display_.times()[frame];
      StreamedFrame& of = result_.frames[frame];
      of.pose_s = times.pose.to_seconds();
      of.begun_s = times.begun.to_seconds();
      of.drawn_s = times.drawn.to_seconds();
      of.shown_s = times.shown.to_seconds();
      of.buffer_wait_s = display_.buffer_wait(frame).to_seconds();
    }
    result_.pictures = display_.counters().pictures;
    result_.repeated = display_.counters().repeated;
    result_.rows_late = display_.counters().rows_late;
    return std::move(result_);
  }

 private:
  const FrameJob& job_;
  const double rate_;
  Display display_;
  StreamResult result_;
};

FrameResult simulate(const MachineDesign& design, const FrameJob& job, const MemoryImage& image,
                     const DramConfig& dram, const std::optional<Shown>& shown,
                     const BuildOptions& build, const Outputs& outputs) {
  use_femtosecond_resolution();
  sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
  fail_child_on_sc_error();
  DramController memory("dram", dram);
  memory.load(0, image.bytes.data(), image.bytes.size());
  if (const auto& table = job.renaming.contents) {
    memory.load(job.renaming.records.base, table->data(), table->size());
  }
  const std::unique_ptr<Machine> machine = design.build("accelerator", job, build);
  check_sram_budget(*machine);
  for (auto& socket : machine->memory) socket.bind(memory.socket);
  std::optional<Stream> stream;
  if (shown) stream.emplace(job, *shown, *machine, memory);
  const Publisher sheets = [&](DataSheet& sheet) {
    machine->publish(sheet);
    if (stream) stream->publish(sheet);
  };
  std::optional<CommandTraceWriter> dram_trace;
  if (outputs.dram_trace != nullptr) {
    dram_trace.emplace(*outputs.dram_trace, CommandTraceHeader::of(dram), memory);
  }
  std::optional<Waveform> waveform;
  if (outputs.vcd != nullptr) {
    std::vector<sc_core::sc_time> steps = {machine->clock().period(), memory.clock_period()};
    // Rows of a display come at any moment.
    if (shown && shown->rate > 0) steps.push_back(sc_core::sc_get_time_resolution());
    waveform.emplace(*outputs.vcd, steps);
    WaveformSheet sheet(waveform->file());
    machine->publish(sheet);
    memory.trace(waveform->file());
  }
  std::unique_ptr<Timeline> timeline;
  if (outputs.timeline != nullptr) {
    timeline =
        std::make_unique<Timeline>(*outputs.timeline, *machine, memory, outputs.timeline_groups);
  }
  const auto counts = [&] {
    FrameResult result;
    result.cycles = machine->clock().now_cycles();
    if (stream) result.rest_cycles = stream->rested().value() / machine->clock().period().value();
    result.clock_mhz = machine->clock().mhz();
    result.machine = collect(*machine, sheets);
    add_memory_path(sheets, dram.buses(memory.memspec()), result.machine);
    result.memory = collect_memory(memory.stats(), job.layout.regions, machine->requesters());
    result.memory.write_queue_entries = dram.write_queue_entries;
    return result;
  };
  if (stream) stream->run(counts);
  // Until nothing can happen any more: the frame ends when its last posted write is in the memory.
  run_simulation();
  if (dram_trace) dram_trace->close();
  if (!machine->done()) {
    throw std::runtime_error("the simulation ran out of events before the frame was finished");
  }
  FrameResult result = counts();
  result.drained = drained(sheets) && memory.idle();
  if (timeline) timeline->close();
  if (stream) {
    result.stream = stream->result();
  } else {
    result.frame.resize(job.frame_buffer.bytes);
    memory.read_back(job.frame_buffer.base, result.frame.data(), result.frame.size());
    if (job.eyes > 1) {
      result.right_frame.resize(job.frame_buffer.bytes);
      memory.read_back(job.picture(0, 1).frame_buffer.base, result.right_frame.data(),
                       result.right_frame.size());
    }
  }
  if (waveform) {
    // The kernel writes what changed in a moment when time goes on.
    sc_core::sc_start(sc_core::sc_get_time_resolution());
    waveform->close();
  }
  return result;
}

FrameResult run(const MachineDesign& design, const FrameJob& job, const MemoryImage& image,
                const DramConfig& dram, const std::optional<Shown>& shown,
                const RunOptions& options) {
  const auto began = std::chrono::steady_clock::now();
  // Made here, so that nothing is left of them whatever becomes of the child.
  OutputSet files;
  Outputs outputs;
  if (!options.vcd_path.empty()) outputs.vcd = &files.add(options.vcd_path);
  if (!options.timeline_path.empty()) outputs.timeline = &files.add(options.timeline_path);
  outputs.timeline_groups = options.timeline_groups;
  if (!options.dram_trace_path.empty()) outputs.dram_trace = &files.add(options.dram_trace_path);
  const std::string bytes = in_child(
      [&] { return to_wire(simulate(design, job, image, dram, shown, options.build, outputs)); });
  files.commit();
  FrameResult result = from_wire(bytes);
  result.wall_s = seconds_since(began);
  return result;
}

}  // namespace

FrameResult simulate_frame(const MachineDesign& design, const FrameJob& job,
                           const MemoryImage& image, const DramConfig& dram,
                           const BuildOptions& build) {
  const auto began = std::chrono::steady_clock::now();
  FrameResult result = simulate(design, job, image, dram, {}, build, {});
  result.wall_s = seconds_since(began);
  return result;
}

FrameResult run_frame(const MachineDesign& design, const FrameJob& job, const MemoryImage& image,
                      const DramConfig& dram, const RunOptions& options) {
  return run(design, job, image, dram, {}, options);
}

FrameResult simulate_stream(const MachineDesign& design, const FrameJob& job,
                            const MemoryImage& image, const DramConfig& dram, double rate,
                            const RunOptions& options, ShownPictures& shown) {
  return run(design, job, image, dram, Shown{rate, &shown}, options);
}

}  // namespace sgs
