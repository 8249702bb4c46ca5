// What must hold of any report.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "algorithm/image/image.h"

namespace sgs::test {

// Of a view of any machine: the frame is the golden renderer's, nothing is left over, every
// activity accounts for all cycles, bytes add up, and the bus moves no more than it can.
void check_any_machine(const nlohmann::json& view);

// Of a view of a machine that fetches halves of Gaussians: their bytes are counters times sizes.
void check_halves(const nlohmann::json& view);

// Of a view of a streaming machine, all of that and: in exact order the frame is the reference
// picture of what second halves decode to; bytes are visits times sizes; units hand on what they
// take; and no unit does more than the frame has cycles for. The view's report holds its `config`.
void check_streaming_machine(const nlohmann::json& view);

// What the view's frame was held against, in the folder of results, is this reference picture of
// the scene in its file's order, but for the order of equal depths: where a machine draws it,
// `simulate` takes the golden picture for it.
void check_reference(const nlohmann::json& view, const std::string& folder, const Image& reference);

}  // namespace sgs::test
