// A stream's simulation, its pictures against the golden ones, its report.
#include "testbench/streaminggs/run/stream_run.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "algorithm/image/image_io.h"
#include "algorithm/memory/frame_buffer.h"
#include "testbench/result/collect.h"
#include "testbench/streaminggs/report/contact_sheet.h"
#include "testbench/streaminggs/report/json_table.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/report/terminal.h"
#include "testbench/streaminggs/run/progress.h"
#include "testbench/streaminggs/run/view_result.h"

namespace sgs {
namespace {

// Golden pictures of the frames, one after the other, and what they leave out together.
class Judge {
 public:
  Judge(const PreparedScene& scene, const RunConfig& config, DataSheet& left_out)
      : scene_(scene), config_(config), left_out_(left_out) {}

  struct Judged {
    StreamedPicture said;
    Image picture;
    std::optional<Image> right;
  };

  Judged judge(int number, const Camera& camera, const ShownPictures& shown) {
    const auto bytes_of = [&](std::uint32_t eye) {
      return shown.read(static_cast<std::uint32_t>(number), eye);
    };
    const std::vector<std::byte> left = bytes_of(0);
    const ViewJob job = view_job(scene_, number, camera, config_);
    const GoldenFrame golden = config_.design->golden(scene_.stored, job.frame, left_out_);
    const ReferencePictures pictures = reference_pictures(
        scene_, job.frame, config_.design->draws_reference() ? &golden.image : nullptr);
    JudgedFrame judged = judge_frame(scene_, job, pictures, golden, left);
    const auto equal = [&](const std::vector<std::byte>& bytes, const Image& expected) {
      return bytes == encode_frame(job.frame.frame_format, expected);
    };
    Judged out;
    out.said.psnr_db = judged.psnr_db;
    out.said.ssim = judged.ssim;
    out.said.equals_golden = equal(left, golden.image);
    out.said.empty = golden.contributing == 0;
    out.picture = std::move(judged.frame);
    if (job.frame.eyes > 1) {
      const std::vector<std::byte> bytes = bytes_of(1);
      RightEye right =
          judge_right_eye(scene_, job.frame, golden, bytes, config_.design->draws_reference());
      out.said.right = {right.psnr_db, right.ssim};
      out.said.equals_golden = out.said.equals_golden && equal(bytes, golden.right);
      out.right = std::move(right.frame);
    }
    return out;
  }

 private:
  const PreparedScene& scene_;
  const RunConfig& config_;
  DataSheet& left_out_;
};

std::string in_ms(double seconds) { return rounded(1e3 * seconds); }

// A frame that begins as its pose comes has no later one to take.
void print_late_poses(const StreamSummary& s) {
  constexpr double kNothing = 1e-3;  // of a latency
  if (s.latched_late.worst_s < (1 - kNothing) * s.latency.worst_s) {
    fmt::print("  with poses measured when frames begin: median {} ms, worst {} ms\n",
               in_ms(s.latched_late.median_s), in_ms(s.latched_late.worst_s));
    return;
  }
  fmt::print("  frames begin as their poses come: to measure these then gains nothing{}\n",
             !s.missed.empty()
                 ? ""
                 : fmt::format("; each frame waits {} ms for its picture, or more: its pose may "
                               "come so much later",
                               in_ms(s.least_wait_s)));
}

// "1, 6, 10", of many with how many more.
std::string first_of(const std::vector<std::size_t>& numbers) {
  constexpr std::size_t kNamed = 6;
  std::vector<std::string> named;
  for (const std::size_t number : numbers) {
    if (named.size() < kNamed) named.push_back(std::to_string(number));
  }
  if (numbers.size() == named.size()) return join(named);
  return fmt::format("{} and {} more", join(named), numbers.size() - named.size());
}

void print_buffer_waits(const StreamSummary& s) {
  if (s.waiting == 0) return;
  fmt::print(
      "  {} of these frames wait for a buffer that the display still shows, up to {} ms; without "
      "that: worst {} ms, median {} ms\n",
      s.waiting, in_ms(s.buffer_wait.worst_s), in_ms(s.own_time.worst_s),
      in_ms(s.own_time.median_s));
}

void print_display(const StreamSummary& s) {
  if (s.rate == 0) return;
  if (s.missed.empty()) {
    fmt::print("every frame is shown in its picture, {} a second\n", rounded(s.rate));
  } else {
    fmt::print(
        "{} of {} frames miss their picture ({}), {} a second: {} of {} pictures repeat the one "
        "before{}\n",
        s.missed.size(), s.frames.size(), first_of(s.missed), rounded(s.rate), s.repeated,
        s.pictures, s.frames.front().held ? "" : "; ahead of the first frame nothing is shown");
    fmt::print(
        "no frame is left out: one that misses keeps its buffer until the next picture, and "
        "delays all later ones\n");
  }
  if (s.rows_late > 0) {
    fmt::print(
        "{} rows of pixels come to the display too late; pictures due before the last one are left "
        "out\n",
        grouped(s.rows_late));
  }
  fmt::print(
      "motion to photon: median {} ms, worst {} ms, from the time of frame n's pose, n/{} s, to "
      "the light of the picture's middle row\n",
      in_ms(s.latency.median_s), in_ms(s.latency.worst_s), rounded(s.rate));
  print_late_poses(s);
}

void print_flow(const StreamFlow& flow, bool memory_known) {
  const double frames = static_cast<double>(flow.frames);
  const Totals watts = flow.totals_w();
  const char* const without = memory_known ? "" : " without the memory";
  fmt::print(
      "{} mJ and {} MB a frame, with the rest between frames; {} W{}; {} W with PHY and "
      "controller\n",
      rounded(1e3 * flow.totals_j.without_memory_interface.middle / frames),
      rounded(1e-6 * static_cast<double>(flow.bytes) / frames),
      rounded(watts.without_memory_interface), without, rounded(watts.with_memory_interface));
  if (!memory_known) return;
  double commands_w = 0, memory_w = 0;
  std::string states, high_end;
  for (const MemoryState& state : flow.states) {
    if (state.time_s == 0) continue;
    memory_w += state.energy_j / flow.time_s;
    states += fmt::format("{} {} W in {} % of the time, ", state.name,
                          rounded(state.energy_j / flow.time_s),
                          rounded(100 * state.time_s / flow.time_s));
    if (state.name == kSelfRefreshState) high_end = "; at the band's high end in power-down";
  }
  for (const auto& [command, joules] : flow.commands) commands_w += joules / flow.time_s;
  fmt::print("  of these the memory {} W: {}commands and I/O {} W{}\n",
             rounded(memory_w + commands_w), states, rounded(commands_w), high_end);
}

void print_frames(const StreamReport& stream) {
  fmt::print("{:>5} {:>10} {:>10} {:>10} {:>8} {:>8} {:>6} {:>8} {:>8}\n", "frame", "begun ms",
             "drawn ms", "shown ms", "ms", "waits ms", "held", "PSNR dB", "= golden");
  for (std::size_t i = 0; i < stream.frames.size(); ++i) {
    const StreamedPicture& frame = stream.frames[i];
    const FrameTiming& t = frame.timing;
    fmt::print(
        "{:>5} {:>10.4f} {:>10.4f} {:>10.4f} {:>8.4f} {:>8.4f} {:>6} {:>8} {:>8}\n", i,
        1e3 * t.begun_s, 1e3 * t.drawn_s, 1e3 * t.shown_s, 1e3 * t.time_s(), 1e3 * t.buffer_wait_s,
        t.held ? "yes" : "NO",
        std::isinf(frame.worst_psnr_db()) ? "equal" : fmt::format("{:.2f}", frame.worst_psnr_db()),
        frame.equals_golden ? "yes" : "NO");
  }
}

void print_stream(const StreamReport& stream, const ViewResult& all) {
  const StreamSummary& s = stream.summary;
  const char* const of_eyes = stream.frames.front().right ? " of two eyes" : "";
  fmt::print("\n{} frames{} along {}, back to back: {} frames a second\n", s.frames.size(), of_eyes,
             stream.name, rate_in_words(s.frames_per_s));
  fmt::print("from begin to last pixel: worst {} ms (frame {}), p99 {} ms, median {} ms\n",
             in_ms(s.frame_time.worst_s), s.worst_frame, in_ms(s.frame_time_p99_s),
             in_ms(s.frame_time.median_s));
  print_buffer_waits(s);
  print_display(s);
  print_flow(stream.flow, all.run.memory.energy_not_stated.empty());
  if (s.rate == 0 || !s.missed.empty()) fmt::print("all frames: {}\n", all.binding.sentence());
  std::size_t empty = 0, worst = 0;
  for (std::size_t i = 0; i < stream.frames.size(); ++i) {
    empty += stream.frames[i].empty ? 1 : 0;
    if (stream.frames[i].worst_psnr_db() < stream.frames[worst].worst_psnr_db()) worst = i;
  }
  print_empty(empty, stream.frames.size(), "frames");
  const double worst_db = stream.frames[worst].worst_psnr_db();
  if (std::isinf(worst_db)) {
    fmt::print("every frame equals its reference picture\n");
  } else {
    fmt::print("PSNR: worst {:.2f} dB (frame {})\n", worst_db, worst);
  }
}

}  // namespace

int run_stream(const PathJob& job, RunSetting& setting, const ResultFolder& out, bool dropping) {
  const PreparedScene& scene = setting.scene;
  RunConfig& config = setting.config;
  RunReport report(config, setting.facts);
  print_doubt(job, scene);
  FrameJob frames;
  naming_origins(config, [&] { frames = config.design->stream(scene.stored, job.frames); });
  check_capacity(frames, config.dram);
  ShownPictures shown(frames);
  ViewResult all;
  all.image_hash = scene.image_hash;
  all.run = simulate_stream(*config.design, frames, scene.stored.image, config.dram, job.frame_rate,
                            setting.options, shown);
  account(all, config.dram, setting.technology);
  LeftOutCollector left_out(all.left_out);
  list_left_out(scene.stored, all.run.machine, left_out);
  const StreamSummary summary = summarise(all.run, job.frame_rate);
  StreamReport stream{
      job.name, summary, flow_of(all.run, summary, config.dram, setting.technology), {}};
  Judge judge(scene, config, left_out);
  ContactSheet sheet(job.frames.size());
  bool all_equal = true;
  {
    ProgressLine progress;
    for (std::size_t i = 0; i < job.frames.size(); ++i) {
      auto [frame, picture, right] = judge.judge(static_cast<int>(i), job.frames[i], shown);
      frame.timing = stream.summary.frames[i];
      write_frame(out, i, picture, right ? &*right : nullptr);
      if (sheet.shows(i)) {
        sheet.add(picture, fmt::format("{} - {} ms", i, in_ms(frame.timing.time_s())));
      }
      all_equal = all_equal && frame.equals_golden;
      stream.frames.push_back(frame);
      progress.say(fmt::format("{} of {} frames judged", i + 1, job.frames.size()));
    }
  }
  const nlohmann::ordered_json text = report.of_stream(stream, report.of_all(all, scene));
  OutputSet files;
  files.add(out.report().string()).write(report_text(text));
  files.add(out.path_table().string()).write(csv_of(text["stream"]["frames"]));
  write_image(files.add(out.contact_sheet().string()), sheet.sheet());
  files.commit();
  if (setting.detail == Detail::kAll) print_frames(stream);
  print_stream(stream, all);
  print_scene(scene, config, dropping);
  print_unknown_energy(all);
  print_area(all, setting.technology.name, setting.detail);
  if (setting.detail == Detail::kAll) print_lanes(all);
  print_choices(config.chosen, setting.detail);
  if (!all_equal) fmt::print("\na frame differs from the streaming renderer's\n");
  fmt::print("\nwritten to {}\n", out.report().parent_path().string());
  return all_equal ? 0 : 1;
}

}  // namespace sgs
