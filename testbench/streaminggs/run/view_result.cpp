// One view: golden pictures, simulation, and what follows from its counts.
#include "testbench/streaminggs/run/view_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/image/quality.h"
#include "algorithm/memory/frame_buffer.h"
#include "algorithm/render/reference_renderer.h"
#include "modules/dram/address_mapping.h"
#include "modules/dram/memspec.h"
#include "testbench/result/collect.h"

namespace sgs {
namespace {

// Bytes of a Gaussian, were the scene stored with colours of another degree.
std::uint64_t record_bytes(const StoredScene& scene, int sh_degree) {
  const SceneLayout& layout = scene.image.layout;
  SecondHalfFormat format = layout.second_half;
  format.sh_degree = sh_degree;
  std::uint32_t& of_bands = format.entries[static_cast<std::size_t>(Codebook::kSh)];
  if (format.quantised() && of_bands == 0) of_bands = scene.storage.vq.entries(Codebook::kSh);
  if (sh_degree == 0) of_bands = 0;
  const RecordSplit split = split_of(layout.order(), format);
  return std::uint64_t{split.first_bytes()} + split.second_bytes;
}

// Those that the scene does not have, and those that its storage spares.
void list_sh_bands(const StoredScene& scene, DataSheet& sheet) {
  constexpr int kMaxDegree = 3;
  const int stored = scene.image.layout.sh_degree(), whole = stored + scene.sh_bands_left_out;
  const std::uint64_t gaussians = scene.image.layout.gaussian_count();
  const auto list = [&](const char* what, const std::string& why, int from, int to) {
    if (from == to) return;
    sheet.left_out(
        what, why.c_str(), gaussians,
        fmt::format("{} B a Gaussian", record_bytes(scene, from) - record_bytes(scene, to)));
  };
  list("sh_bands", fmt::format("the scene has SH degree {}", whole), kMaxDegree, whole);
  list("sh_bands_below_tolerance",
       fmt::format("stored with degree {}: no colour changes by more than {:.3g}", stored,
                   scene.sh_error),
       whole, stored);
}

}  // namespace

void check_capacity(const FrameJob& job, const DramConfig& dram) {
  const std::uint64_t capacity = AddressMapping(dram, load_memspec(dram.memspec)).capacity_bytes();
  const std::uint64_t needed = job.layout.regions.total_bytes();
  if (needed <= capacity) return;
  const auto& largest =
      *std::max_element(job.layout.regions.begin(), job.layout.regions.end(),
                        [](const Region& a, const Region& b) { return a.bytes < b.bytes; });
  throw InputError(fmt::format(
      "dram: the scene and its frame take {} bytes ({} alone {}), {} channels x {} ranks hold {}",
      needed, largest.name, largest.bytes, dram.channels, dram.ranks, capacity));
}

void list_left_out(const StoredScene& scene, const MachineResult& machine, DataSheet& sheet) {
  const SceneLayout& layout = scene.image.layout;
  const std::uint64_t invisible = scene.gaussians - layout.gaussian_count();
  sheet.left_out("invisible_gaussians", "opacity below 1/255: no view can show them", invisible,
                 fmt::format("{} B of DRAM", invisible * layout.record_bytes()));
  list_sh_bands(scene, sheet);
  for (const LeftOut& entry : machine.left_out) {
    sheet.left_out(entry.what.c_str(), entry.why.c_str(), entry.count, entry.saves);
  }
}

ViewJob view_job(const PreparedScene& scene, int view, const Camera& camera,
                 const RunConfig& config) {
  ViewJob job{view, camera, {}};
  naming_origins(config, [&] { job.frame = config.design->job(scene.stored, camera); });
  check_capacity(job.frame, config.dram);
  return job;
}

ReferencePictures reference_pictures(const PreparedScene& scene, const FrameJob& job,
                                     const Image* drawn) {
  const auto reference_of = [&](const ActivatedCloud& cloud) {
    return render_reference(job.view, cloud, job.background).image;
  };
  ReferencePictures out;
  out.decoded_reference = drawn == nullptr ? reference_of(scene.stored.decoded) : *drawn;
  out.reference =
      scene.stored.original ? reference_of(*scene.stored.original) : out.decoded_reference;
  out.file_order = file_order_difference(scene, job.view, job.background, out.reference);
  return out;
}

JudgedFrame judge_frame(const PreparedScene& scene, const ViewJob& job,
                        const ReferencePictures& pictures, const GoldenFrame& golden,
                        const std::vector<std::byte>& bytes) {
  JudgedFrame out;
  out.frame = decode_frame(job.frame.frame_format, job.camera.width, job.camera.height, bytes);
  out.psnr_db = psnr_db(out.frame, pictures.reference);
  out.ssim = ssim(out.frame, pictures.reference);
  if (is_lossy(golden)) {
    out.order_loss = order_loss(scene.stored.original_known() ? &pictures.reference : nullptr,
                                pictures.decoded_reference, golden, out.frame);
  }
  return out;
}

void account(ViewResult& view, const DramConfig& dram, const Technology& technology) {
  view.area_totals_mm2 = area_totals(view.run, technology);
  view.memory_interface = memory_interface_of(dram, technology);
  view.binding = find_binding(view.run, view.area_totals_mm2);
  view.energy_j = energy_of(view.run, technology);
  view.energy_totals_j = energy_totals(view.run, technology);
  view.area_mm2 = area_of(view.run, technology);
  view.area_by_owner_mm2 = area_by_owner(view.run, technology);
  view.sram_model = technology.sram;
}

ViewResult view_result(const PreparedScene& scene, const ViewJob& job, ReferencePictures pictures,
                       GoldenFrame golden, JudgedFrame judged, FrameResult run,
                       const DramConfig& dram, const Technology& technology) {
  ViewResult view;
  static_cast<ReferencePictures&>(view) = std::move(pictures);
  static_cast<JudgedFrame&>(view) = std::move(judged);
  view.view = job.view;
  view.camera = job.camera;
  view.golden = std::move(golden);
  view.run = std::move(run);
  view.image_hash = scene.image_hash;
  account(view, dram, technology);
  if (is_empty(view)) view.binding = without_advice(view.binding);
  const SceneLayout& layout = scene.stored.image.layout;
  view.once_bytes = view.golden.contributing * layout.record_bytes() +
                    job.frame.eyes * job.frame.frame_buffer.bytes;
  return view;
}

RightEye judge_right_eye(const PreparedScene& scene, const FrameJob& job, const GoldenFrame& golden,
                         const std::vector<std::byte>& bytes, bool draws_reference) {
  const View<float>& view = job.picture(0, 1).view;
  RightEye out;
  out.frame = decode_frame(job.frame_format, view.width, view.height, bytes);
  if (scene.stored.original || !draws_reference) {
    out.reference = render_reference(view, scene.given(), job.background).image;
  } else {
    out.reference = golden.right;
  }
  out.psnr_db = psnr_db(out.frame, out.reference);
  out.ssim = ssim(out.frame, out.reference);
  return out;
}

ViewResult simulate_view(const PreparedScene& scene, int number, const Camera& camera,
                         const RunConfig& config, const Technology& technology,
                         const RunOptions& options) {
  const ViewJob job = view_job(scene, number, camera, config);
  std::vector<LeftOut> entries;
  LeftOutCollector left_out(entries);
  GoldenFrame golden = config.design->golden(scene.stored, job.frame, left_out);
  FrameResult run = run_frame(*config.design, job.frame, scene.stored.image, config.dram, options);
  ReferencePictures pictures = reference_pictures(
      scene, job.frame, config.design->draws_reference() ? &golden.image : nullptr);
  list_left_out(scene.stored, run.machine, left_out);
  bool equal = run.frame == encode_frame(job.frame.frame_format, golden.image);
  std::optional<RightEye> right;
  if (job.frame.eyes > 1) {
    equal = equal && run.right_frame == encode_frame(job.frame.frame_format, golden.right);
    right = judge_right_eye(scene, job.frame, golden, run.right_frame,
                            config.design->draws_reference());
  }
  JudgedFrame judged = judge_frame(scene, job, pictures, golden, run.frame);
  ViewResult view = view_result(scene, job, std::move(pictures), std::move(golden),
                                std::move(judged), std::move(run), config.dram, technology);
  for (const double per_s : options.frame_rates) {
    view.fixed_rates.push_back(at_rate(per_s, view.run, config.dram, technology));
  }
  view.stated_area_mm2 = config.design->stated_area_mm2();
  view.right = std::move(right);
  view.equals_golden = equal;
  view.left_out = std::move(entries);
  return view;
}

}  // namespace sgs
