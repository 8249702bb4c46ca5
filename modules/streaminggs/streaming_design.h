// What the designs of both orders have in common.
#pragma once

#include "algorithm/render/render_result.h"
#include "algorithm/scene/camera.h"
#include "algorithm/storage/stored_scene.h"
#include "modules/auto_choice.h"
#include "modules/golden_frame.h"
#include "modules/streaminggs/streaming_config.h"
#include "modules/streaminggs/streaming_job.h"
#include "tlm/data_sheet.h"

namespace sgs {

// Costs that were left to the model, and codebooks that must fit their buffer, for a scene with
// such second halves. Throws InputError.
void adapt(StreamingConfig& config, StorageOrder order, const SecondHalfFormat& format,
           std::vector<AutoChoice>& chosen);

// A frame of the scene, without regions of the machine's own.
FrameJob scene_job(const StreamingConfig& config, const StoredScene& scene, const Camera& camera);

// Regions behind those that the job has. What depends on the configuration belongs behind what does
// not: a machine of other parameters then finds everything where it was.
void add_spill(FrameJob& job, std::uint64_t bytes);
void add_frame_buffer(FrameJob& job);

// Of a job that has passed as a FrameJob: its groups.
StreamingJob streaming_job(const StreamingConfig& config, const FrameJob& job);

// What any machine tells of its golden picture, and nothing of streaming. groups: that it was
// rendered by.
GoldenFrame golden_frame(StreamingResult&& result, const std::vector<PixelRect>& groups);

// What the format of second halves and an earlier frame's codebooks spared.
void publish_left_out(const StreamingConfig& config, const StoredScene& scene, DataSheet& sheet);

}  // namespace sgs
