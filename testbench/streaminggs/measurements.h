// What a finished simulation has counted, as the sections `frame`, `units`, `binding`, `dram` and
// `sram` of the report (README, "What the report says").
#pragma once

#include <string>

namespace sgs {

class Accelerator;

// JSON text. The accelerator has run.
std::string measure(Accelerator& accelerator);

}  // namespace sgs
