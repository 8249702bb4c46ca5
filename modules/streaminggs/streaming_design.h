// The part of the designs that both orders share.
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

// Adds a region behind those that the job has. Add those that depend on the configuration last: a
// machine of other parameters then finds everything else where it was.
void add_spill(FrameJob& job, std::uint64_t bytes);

// The job of a streaming machine from a FrameJob: adds its groups.
StreamingJob streaming_job(const StreamingConfig& config, const FrameJob& job);

// The golden frame of any machine, without the details of streaming. groups: those that it was
// rendered by.
GoldenFrame golden_frame(StreamingResult&& result, const std::vector<PixelRect>& groups);

// Publishes the bytes that the format of second halves and an earlier frame's codebooks spared.
void publish_left_out(const StreamingConfig& config, const StoredScene& scene, DataSheet& sheet);

}  // namespace sgs
