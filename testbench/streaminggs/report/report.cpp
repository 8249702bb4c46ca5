// The report of a view: its sections in their order.
#include "testbench/streaminggs/report/report.h"

#include "testbench/streaminggs/report/report_sections.h"

namespace sgs {
namespace {

void visit_left_out(ReportVisitor& r, const std::vector<LeftOut>& left_out) {
  r.list("left_out", left_out, [&](const LeftOut& entry) {
    r("what", "", "What the frame did not need and did not pay, or could do without.", entry.what);
    r("why", "", "Why it was not needed.", entry.why);
    r("count", "", "How much of it.", entry.count);
    r("saves", "", "What that saves.", entry.saves);
  });
}

// Units, memory, joules, area and ledger.
void visit_machine(ReportVisitor& r, const ViewResult& view) {
  const FrameResult& run = view.run;
  r.object("units", [&] {
    r.each(run.machine.units, [&](const UnitResult& unit) {
      r.object({"PATH", unit.name}, [&] { visit_unit(r, unit); });
    });
  });
  r.object("binding", [&] { visit_binding(r, view.binding); });
  r.object("dram", [&] { visit_dram(r, run.memory); });
  r.object("energy", [&] { visit_energy(r, view); });
  if (r.has(!view.fixed_rates.empty())) {
    r.list("fixed_rates", view.fixed_rates,
           [&](const FixedRate& rate) { visit_fixed_rate(r, rate); });
  }
  r.object("memory_interface", [&] { visit_memory_interface(r, view.memory_interface); });
  r.object("area_mm2", [&] { visit_area(r, view); });
  r.object("sram", [&] { visit_sram(r, run.machine, view.sram_model); });
  r.object("datapath", [&] {
    r.each(run.machine.datapaths, [&](const DatapathResult& datapath) {
      r.object({"DATAPATH", datapath.datapath.name}, [&] { visit_datapath(r, datapath); });
    });
  });
  r.object("ledger", [&] { visit_ledger(r, run); });
}

void visit_wall_time(ReportVisitor& r, const FrameResult& run) {
  r.object("host", [&] {
    r("simulation_wall_s", "s", "Host time of elaboration, loading and simulation of this view.",
      run.wall_s);
  });
}

}  // namespace

void visit_view(ReportVisitor& r, const ViewResult& view, const PreparedScene& scene) {
  const FrameResult& run = view.run;
  r("schema_version", "", "Version of this layout.", kReportVersion);
  r.object("scene", [&] { visit_scene(r, scene); });
  r("view", "", "Number of the camera: its place among the cameras, from 0.", view.view);
  r.object("camera", [&] { visit_camera(r, view.camera); });
  r.object("image", [&] { visit_image(r, view, scene.stored.original_known()); });
  r.object("frame", [&] {
    r("cycles", "cycles", "Cycles from time 0 until the last pixel is in DRAM.", run.cycles);
    r("time_s", "s", "These cycles at the configured clock.", run.time_s());
    r("fps", "1/s", "Frames a second: 1 over the frame time.", 1 / run.time_s());
    r("width_px", "px", "Width of the picture: the camera's, or `--size`.", view.camera.width);
    r("height_px", "px", "Height of the picture.", view.camera.height);
    r("drained", "bool", "No FIFO, port or queue holds anything at the end.", run.drained);
  });
  visit_machine(r, view);
  r.object("limit", [&] {
    r("contributing_gaussians", "", "Gaussians that are blended into a pixel or more.",
      view.golden.contributing);
    r("bytes_read_once", "B", "Both halves of each of these once, and the frame.", view.once_bytes);
    r("ratio", "ratio", "`dram.bytes` over `limit.bytes_read_once`.", view.once_ratio());
  });
  visit_left_out(r, view.left_out);
  visit_wall_time(r, run);
}

void visit_view_of_stream(ReportVisitor& r, const ViewResult& all, const PreparedScene& scene) {
  const FrameResult& run = all.run;
  r.object("scene", [&] { visit_scene(r, scene); });
  r.object("frame", [&] {
    r("cycles", "cycles", "Cycles of the machine's clock until nothing happens any more.",
      run.cycles);
    r("time_s", "s", "These cycles at the configured clock.", run.time_s());
    r("rest_cycles", "cycles", "Of these, in which no frame is under way.", run.rest_cycles);
    r("drained", "bool", "No FIFO, port or queue holds anything at the end.", run.drained);
  });
  visit_machine(r, all);
  visit_left_out(r, all.left_out);
  visit_wall_time(r, run);
}

}  // namespace sgs
