// report.json of a simulated view (REPORT.md lists its entries).
#pragma once

#include "testbench/streaminggs/run/view_result.h"

namespace sgs {

class ReportVisitor;

constexpr int kReportVersion = 2;

// All entries of a view but those that are the same for all views of a run.
void visit_view(ReportVisitor& r, const ViewResult& view, const PreparedScene& scene);

}  // namespace sgs
