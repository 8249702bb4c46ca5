// Keys of the rendering unit.
#include "modules/streaminggs/rendering/rendering_config.h"

namespace sgs {

void visit(ConfigVisitor& v, RenderingConfig& c) {
  v("clusters", c.clusters, in_range(1, 256), "4x4 sub-tiles blended a cycle");
  v("depth_cycles", c.depth_cycles, in_range(1, 1000),
    "latency of a blend: drain and news of a finished group come so much later");
  v("pixel_buffers", c.pixel_buffers, in_range(1, 2), "groups whose pixels are on chip");
  v("drain_pixels_per_cycle", c.drain_pixels_per_cycle, in_range(1, 4096),
    "finished pixels converted a cycle");
  v("ellipse_test", c.ellipse_test, "sub-tiles that a splat's ellipse cannot reach are skipped");
  v("subtile_tests_per_cycle", c.subtile_tests_per_cycle, in_range(1, 4096), "of the ellipse");
  v("feedback_latency_cycles", c.feedback_latency_cycles, in_range(1, 1000),
    "until VSU and HFUs see that a group is finished");
  v("saturation_feedback", c.saturation_feedback, "a finished group's visits are dropped upstream");
  v("input_fifo_entries", c.input_fifo_entries, in_range(1, 4096),
    "sorted splats waiting from each sorting unit");
}

}  // namespace sgs
