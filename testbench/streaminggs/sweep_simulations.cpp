// What is shared is made in the parent, and its pages stay shared: nobody writes to them.
#include "testbench/streaminggs/sweep_simulations.h"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace sgs {
namespace {

std::uint64_t memory_bytes() {
  return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t bytes_of(const Image& image) { return image.pixels.size() * sizeof image.pixels[0]; }

// What else a design's golden renderer knows is not asked for.
GoldenFrame draw_golden(const MachineDesign& design, const StoredScene& scene,
                        const FrameJob& job) {
  DataSheet unread;
  GoldenFrame golden = design.golden(scene, job, unread);
  if (golden.missed > 0 && golden.in_order) {
    golden.in_order = [picture = golden.in_order()] { return picture; };
  }
  return golden;
}

}  // namespace

std::uint64_t size_bytes(const ReferencePictures& pictures) {
  return bytes_of(pictures.reference) + bytes_of(pictures.decoded_reference);
}

// Itself, and the one that it may tell.
std::uint64_t size_bytes(const GoldenFrame& golden) { return 2 * bytes_of(golden.image); }

SweepSimulations::SweepSimulations(const SweepPlan& plan, Technology technology, RunFacts facts,
                                   VqProgress progress)
    : plan_(plan),
      technology_(std::move(technology)),
      facts_(std::move(facts)),
      progress_(std::move(progress)),
      scenes_(memory_bytes() / 4),
      references_(memory_bytes() / 16),
      golden_(memory_bytes() / 16) {}

std::unique_ptr<ChildProcess> SweepSimulations::start(const SweepTask& task) {
  RunConfig config = plan_.resolved(task);
  const std::string of_scene =
      fmt::format("{}\n{}\n{}", task.words.scene, task.words.cameras, task.storage);
  const auto scene = scenes_.get(of_scene, [&] { return task.scene->prepared(config, progress_); });
  adapt(config, *scene);
  const ViewJob job = view_job(*scene, task.view, task.camera, config);
  const std::string of_view =
      fmt::format("{}\n{}\n{} {} {}", of_scene, text_of(task.camera), job.frame.background.x,
                  job.frame.background.y, job.frame.background.z);
  const auto references =
      references_.get(of_view, [&] { return reference_pictures(*scene, job.frame); });
  const auto golden = golden_.get(of_view + "\n" + task.picture, [&] {
    return draw_golden(*config.design, scene->stored, job.frame);
  });
  return std::make_unique<ChildProcess>([&] {
    FrameResult frame =
        simulate_frame(*config.design, job.frame, scene->stored.image, config.dram, {});
    const ViewResult view =
        judge_frame(*scene, job, *references, *golden, std::move(frame), technology_);
    if (!view.equals_golden) {
      throw std::runtime_error("the frame differs from the golden renderer's");
    }
    return line_of_done(task.key, task.words, *RunReport(config, facts_).of_view(view, *scene));
  });
}

}  // namespace sgs
