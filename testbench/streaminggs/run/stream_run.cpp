// A stream's simulation, its pictures against the golden ones, its report.
#include "testbench/streaminggs/run/stream_run.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "algorithm/files/output_file.h"
#include "algorithm/image/image_io.h"
#include "algorithm/memory/frame_buffer.h"
#include "testbench/cost/cost.h"
#include "testbench/result/collect.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/run/stream_summary.h"
#include "testbench/streaminggs/run/view_result.h"

namespace sgs {

std::vector<std::filesystem::path> files_of_stream(const PathJob& job, const ResultFolder& out) {
  std::vector<std::filesystem::path> files;
  for (std::size_t i = 0; i < job.frames.size(); ++i) files.push_back(out.frame(i));
  return files;
}

int run_stream_of(const PathJob& job, RunSetting& setting, const ResultFolder& out) {
  const RunConfig& config = setting.config;
  const StoredScene& scene = setting.scene.stored;
  const FrameJob frames = config.design->stream(scene, job.frames);
  const FrameResult run =
      run_stream(*config.design, frames, scene.image, config.dram, job.frame_rate, setting.options);
  std::size_t equal = 0;
  for (std::size_t i = 0; i < job.frames.size(); ++i) {
    std::vector<LeftOut> entries;
    LeftOutCollector left_out(entries);
    const GoldenFrame golden =
        config.design->golden(scene, config.design->job(scene, job.frames[i]), left_out);
    const std::vector<std::byte>& bytes = run.stream.frames[i].bytes;
    equal += bytes == encode_frame(frames.frame_format, golden.image) ? 1 : 0;
    write_image(out.frame(i).string(), decode_frame(frames.frame_format, job.frames[i].width,
                                                    job.frames[i].height, bytes));
  }
  const StreamSummary s = summarise(run.stream, job.frame_rate);
  fmt::print("{} frames: {} frames a second, {} pictures, {} repeated; idle {} of {} s\n", s.frames,
             rate_in_words(s.frames_s), s.pictures, s.repeated, s.idle_s, run.time_s());
  fmt::print("latency ms median {} worst {}; late latch {} {}\n", 1e3 * s.latency_median_s,
             1e3 * s.latency_worst_s, 1e3 * s.late_median_s, 1e3 * s.late_worst_s);
  const CostResult energy = energy_of(run, setting.technology);
  fmt::print("{} mJ a frame, {} MB a frame, {} cycles, equal {} of {}\n",
             1e3 * energy.total.middle / static_cast<double>(s.frames),
             1e-6 * static_cast<double>(run.memory.bytes) / static_cast<double>(s.frames),
             run.cycles, equal, s.frames);
  for (const StreamedFrame& f : run.stream.frames) {
    fmt::print("  pose {:.3f} begun {:.3f} drawn {:.3f} shown {:.3f} ms\n", 1e3 * f.pose_s,
               1e3 * f.begun_s, 1e3 * f.drawn_s, 1e3 * f.shown_s);
  }
  return equal == s.frames ? 0 : 1;
}

}  // namespace sgs
