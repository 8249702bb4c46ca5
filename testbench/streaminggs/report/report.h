// report.json of a simulated view (README.md here, "What the report says").
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "testbench/streaminggs/run/view_result.h"

namespace sgs {

constexpr int kReportVersion = 2;

nlohmann::ordered_json view_report(const ViewResult& view, const PreparedScene& scene);

}  // namespace sgs
