// Shared data are made in the parent, and their pages stay shared: nobody writes to them.
#include "testbench/streaminggs/sweep/sweep_simulations.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>
#include <utility>

#include "algorithm/memory/frame_buffer.h"
#include "testbench/streaminggs/run/camera_check.h"
#include "testbench/streaminggs/run/clock_check.h"

namespace sgs {
namespace {

std::uint64_t memory_bytes() {
  return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t bytes_of(const Image& image) { return image.pixels.size() * sizeof image.pixels[0]; }

// The data sheet of the design's golden renderer is not read.
ExpectedFrame expected_of(const MachineDesign& design, const PreparedScene& scene,
                          const ViewJob& job, const ReferencePictures& pictures) {
  DataSheet unread;
  ExpectedFrame out;
  out.golden = design.golden(scene.stored, job.frame, unread);
  out.bytes = encode_frame(job.frame.frame_format, out.golden.image);
  out.judged = judge_frame(scene, job, pictures, out.golden, out.bytes);
  if (job.frame.eyes > 1) {
    out.right_bytes = encode_frame(job.frame.frame_format, out.golden.right);
    out.right =
        judge_right_eye(scene, job.frame, out.golden, out.right_bytes, design.draws_reference());
  }
  out.golden.in_order = {};  // may read the scene, which need not stay
  return out;
}

}  // namespace

std::uint64_t size_bytes(const ReferencePictures& pictures) {
  return bytes_of(pictures.reference) + bytes_of(pictures.decoded_reference);
}

// Golden and judged picture, those of the loss, and the same of a right eye.
std::uint64_t size_bytes(const ExpectedFrame& expected) {
  return ((expected.judged.order_loss ? 5 : 3) + (expected.right ? 4 : 0)) *
         bytes_of(expected.golden.image);
}

SweepSimulations::SweepSimulations(const SweepPlan& plan, Technology technology, RunFacts facts,
                                   VqProgress progress)
    : plan_(plan),
      technology_(std::move(technology)),
      facts_(std::move(facts)),
      progress_(std::move(progress)),
      scenes_(memory_bytes() / 4),
      references_(memory_bytes() / 16),
      expected_(memory_bytes() / 16) {}

std::unique_ptr<ChildProcess> SweepSimulations::start(const SweepTask& task) {
  RunConfig config = plan_.resolved(task);
  const std::string of_clock = doubt_about_clock(config, technology_);
  if (!of_clock.empty() && doubts_.insert(of_clock).second) {
    fmt::print(stderr, "streaminggs: note: {}\n", of_clock);
  }
  const std::string of_scene =
      fmt::format("{}\n{}\n{}", task.words.scene, task.words.cameras, task.storage);
  const auto scene = scenes_.get(of_scene, [&] { return task.scene->prepared(config, progress_); });
  adapt(config, *scene);
  const ViewJob job = view_job(*scene, task.view, task.camera, config);
  const std::string of_view =
      fmt::format("{}\n{}\n{} {} {}", of_scene, text_of(task.camera), job.frame.background.x,
                  job.frame.background.y, job.frame.background.z);
  const auto references = references_.get(of_view, [&] {
    const std::string doubt = doubt_about(task.camera, scene->given());
    if (!doubt.empty()) {
      fmt::print(stderr, "streaminggs: {} view {}: {}\n", task.words.scene, task.view, doubt);
    }
    return reference_pictures(*scene, job.frame, nullptr);
  });
  const std::string of_picture =
      fmt::format("{}\n{} {}", of_view, task.picture, static_cast<int>(job.frame.frame_format));
  const auto expected = expected_.get(
      of_picture, [&] { return expected_of(*config.design, *scene, job, *references); });
  return std::make_unique<ChildProcess>([&] {
    FrameResult frame =
        simulate_frame(*config.design, job.frame, scene->stored.image, config.dram, {});
    if (frame.frame != expected->bytes || frame.right_frame != expected->right_bytes) {
      throw std::runtime_error("the frame differs from the streaming renderer's");
    }
    ViewResult view = view_result(*scene, job, *references, expected->golden, expected->judged,
                                  std::move(frame), config.dram, technology_);
    view.right = expected->right;
    view.equals_golden = true;
    return line_of_done(task.key, task.words, *RunReport(config, facts_).of_view(view, *scene));
  });
}

}  // namespace sgs
