// Where a bench's job lies in memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "modules/streaminggs/streaming_job.h"

namespace sgs::tb {

// Behind what is in `layout`: a spill region and a frame buffer of the job's view and format.
inline void place(const SceneLayout& layout, std::uint64_t spill_bytes, StreamingJob& job) {
  job.layout = layout;
  job.spill = job.layout.regions.add("spill", spill_bytes);
  job.frame_buffer =
      job.layout.regions.add("frame_buffer", std::uint64_t{pixel_bytes(job.frame_format)} *
                                                 job.view.width * job.view.height);
}

// Bytes of a memory that holds all of the job's regions.
inline std::size_t memory_bytes(const FrameJob& job) { return job.layout.regions.total_bytes(); }

}  // namespace sgs::tb
