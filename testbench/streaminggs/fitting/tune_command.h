// The tunings of a scene, a file each.
#pragma once

#include "testbench/streaminggs/fitting/tune_job.h"

namespace sgs {

// Each returns the exit status. Throw InputError.
int tune_for_boundaries(const TuneArguments& arguments, const TuningJob& job);
int tune_for_streaming(const TuneArguments& arguments, const TuningJob& job);
int tune_for_codebooks(const TuneArguments& arguments, const TuningJob& job);

}  // namespace sgs
