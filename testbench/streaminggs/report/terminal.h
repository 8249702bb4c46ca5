// The printed output of `simulate`: a table with a line a view, and below it explanations of the
// lines.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "testbench/streaminggs/run/view_result.h"

namespace sgs {

void print_table_head();
void print_table_line(const ViewResult& view);

// Binding unit, bytes by region that are not 0, costs of tests.
void print_details(const ViewResult& view);

// Prints the facts of loading: Gaussians dropped, where storage comes from. dropping: it was asked
// for.
void print_scene(const PreparedScene& scene, const RunConfig& config, bool dropping);

// Area, and what was left to the model; the same for all views. technology: its name.
void print_machine(const ViewResult& view, const std::vector<AutoChoice>& chosen,
                   const std::string& technology);

}  // namespace sgs
