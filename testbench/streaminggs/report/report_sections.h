// Sections of a view's report, each from a part of the result.
#pragma once

#include "testbench/streaminggs/report/report_visitor.h"
#include "testbench/streaminggs/report/run_report.h"
#include "testbench/streaminggs/run/view_result.h"

namespace sgs {

void visit_scene(ReportVisitor& r, const PreparedScene& scene);
void visit_camera(ReportVisitor& r, const Camera& camera);
// original_known: the scene as given is, beside the scene as encoded.
void visit_image(ReportVisitor& r, const ViewResult& view, bool original_known);

void visit_unit(ReportVisitor& r, const UnitResult& unit);
void visit_binding(ReportVisitor& r, const Binding& binding);
void visit_sram(ReportVisitor& r, const MachineResult& machine, const SramModel& model);
void visit_datapath(ReportVisitor& r, const DatapathResult& result);
void visit_ledger(ReportVisitor& r, const FrameResult& run);

void visit_dram(ReportVisitor& r, const MemoryResult& m);
void visit_memory_interface(ReportVisitor& r, const MemoryInterface& interface);

void visit_energy(ReportVisitor& r, const ViewResult& view);
void visit_fixed_rate(ReportVisitor& r, const FixedRate& rate);
void visit_stream(ReportVisitor& r, const StreamReport& stream);
void visit_flow(ReportVisitor& r, const StreamFlow& flow);
void visit_area(ReportVisitor& r, const ViewResult& view);

}  // namespace sgs
