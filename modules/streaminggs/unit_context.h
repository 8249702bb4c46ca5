// Arguments that every unit of a streaming machine is built with, beside its own parameters.
#pragma once

#include "modules/streaminggs/built_for.h"
#include "modules/streaminggs/streaming_job.h"
#include "tlm/clock_domain.h"

namespace sgs {

// Clock and job outlive the unit.
struct UnitContext {
  const ClockDomain& clock;
  const StreamingJob& job;
  BuiltFor built_for;
};

}  // namespace sgs
