// report.json of a simulated view (REPORT.md lists its entries).
#pragma once

#include "testbench/streaminggs/run/view_result.h"

namespace sgs {

class ReportVisitor;

constexpr int kReportVersion = 2;

// All entries of a view but those that are the same for all views of a run.
void visit_view(ReportVisitor& r, const ViewResult& view, const PreparedScene& scene);

// Those of machine and memory, over all frames of a stream.
void visit_view_of_stream(ReportVisitor& r, const ViewResult& all, const PreparedScene& scene);

}  // namespace sgs
