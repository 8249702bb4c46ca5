// One view: golden pictures, simulation, and what follows from its counts.
#include "testbench/streaminggs/view_result.h"

#include <fmt/format.h>

#include "algorithm/image/quality.h"
#include "algorithm/input_error.h"
#include "algorithm/memory/frame_buffer.h"
#include "algorithm/render/reference_renderer.h"
#include "modules/dram/address_mapping.h"
#include "modules/dram/memspec.h"
#include "testbench/result/collect.h"
#include "testbench/streaminggs/provenance.h"

namespace sgs {
namespace {

void check_capacity(const FrameJob& job, const DramConfig& dram) {
  const std::uint64_t capacity = AddressMapping(dram, load_memspec(dram.memspec)).capacity_bytes();
  const std::uint64_t needed = job.layout.regions.total_bytes();
  if (needed <= capacity) return;
  throw InputError(
      fmt::format("dram: the scene and its frame take {} bytes, {} channels x {} ranks hold {}",
                  needed, dram.channels, dram.ranks, capacity));
}

// What the storage left out, and the machine.
void list_left_out(const StoredScene& scene, const MachineResult& machine, DataSheet& sheet) {
  const SceneLayout& layout = scene.image.layout;
  const std::uint64_t invisible = scene.gaussians - layout.gaussian_count();
  sheet.left_out("invisible_gaussians", "opacity below 1/255: no view can show them", invisible,
                 fmt::format("{} B of DRAM", invisible * layout.record_bytes()));
  for (const LeftOut& entry : machine.left_out) {
    sheet.left_out(entry.what.c_str(), entry.why.c_str(), entry.count, entry.saves);
  }
}

}  // namespace

ViewResult simulate_view(const PreparedScene& scene, int number, const Camera& camera,
                         const RunConfig& config, const Technology& technology,
                         const RunOptions& options) {
  const FrameJob job = config.design->job(scene.stored, camera);
  check_capacity(job, config.dram);
  ViewResult view;
  view.view = number;
  view.camera = camera;
  const auto reference_of = [&](const ActivatedCloud& cloud) {
    return render_reference(job.view, cloud, job.background).image;
  };
  view.decoded_reference = reference_of(scene.stored.decoded);
  view.reference =
      scene.stored.original ? reference_of(*scene.stored.original) : view.decoded_reference;
  view.file_order = file_order_difference(scene, job.view, job.background, view.reference);
  LeftOutCollector left_out(view.left_out);
  view.golden = config.design->golden(scene.stored, job, left_out);

  view.image_hash = fnv1a64(scene.stored.image.bytes);
  view.run = run_frame(*config.design, job, scene.stored.image, config.dram, options);
  view.equals_golden = view.run.frame == encode_frame(job.frame_format, view.golden.image);
  view.frame = decode_frame(job.frame_format, camera.width, camera.height, view.run.frame);
  view.psnr_db = psnr_db(view.frame, view.reference);
  view.ssim = ssim(view.frame, view.reference);
  if (is_lossy(view.golden)) {
    view.order_loss = order_loss(scene.stored.original_known() ? &view.reference : nullptr,
                                 view.decoded_reference, view.golden, view.frame);
  }
  list_left_out(scene.stored, view.run.machine, left_out);
  view.binding = find_binding(view.run);
  if (view.golden.contributing == 0) view.binding = without_advice(view.binding);
  view.energy_j = energy_of(view.run, technology);
  view.area_mm2 = area_of(view.run, technology);
  view.sram_model = technology.sram;
  const SceneLayout& layout = scene.stored.image.layout;
  view.once_bytes = view.golden.contributing * layout.record_bytes() + job.frame_buffer.bytes;
  return view;
}

}  // namespace sgs
