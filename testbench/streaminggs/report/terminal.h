// The printed output of `simulate`: a table with a line a view, and below it explanations of the
// lines. Without --verbose it is short.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "testbench/streaminggs/run/run_setting.h"
#include "testbench/streaminggs/run/view_result.h"

namespace sgs {

void print_table_head(Detail detail);
void print_table_line(const ViewResult& view, Detail detail);

void print_bottleneck(const ViewResult& view);
// Nothing where there is one eye.
void print_right_eye(const ViewResult& view);
// How many of these views or frames, as `what` calls them, no Gaussian contributes to; nothing
// where one does to each.
void print_empty(std::size_t empty, std::size_t all, const char* what);
// Energy with its band, without the memory's where that is not known.
void print_energy(const ViewResult& view);
// "0.31 (0.2 .. 0.47)"
std::string rounded(const Band& band);
// Power at the rates that are asked for.
void print_fixed_rates(const ViewResult& view);
// What the memspec lacks for the memory's energy, in a frame or at a rate; nothing where it is
// known. The same for all views.
void print_unknown_energy(const ViewResult& view);
// What ties of depth, order, arithmetic and encoding cost, where they cost anything.
void print_losses(const ViewResult& view);
// Bytes by region that are not 0.
void print_regions(const ViewResult& view);

// Prints the facts of loading: Gaussians dropped, where storage comes from. dropping: it was asked
// for.
void print_scene(const PreparedScene& scene, const RunConfig& config, bool dropping);

// Area with its band, and where none is known for the memory's interface a line about that; the
// same for all views. technology: its name.
void print_area(const ViewResult& view, const std::string& technology, Detail detail);
// Lanes of each datapath; the same for all views.
void print_lanes(const ViewResult& view);
// What was left to the model.
void print_choices(const std::vector<AutoChoice>& chosen, Detail detail);

}  // namespace sgs
