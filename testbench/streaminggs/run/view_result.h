// Everything that is known of one simulated view. The terminal and report.json are made from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/image/image.h"
#include "algorithm/scene/camera.h"
#include "modules/auto_choice.h"
#include "modules/golden_frame.h"
#include "testbench/cost/cost.h"
#include "testbench/cost/fixed_rate.h"
#include "testbench/result/frame_result.h"
#include "testbench/streaminggs/report/binding.h"
#include "testbench/streaminggs/report/memory_interface.h"
#include "testbench/streaminggs/run/frame_run.h"
#include "testbench/streaminggs/run/order_loss.h"
#include "testbench/streaminggs/run/prepared_scene.h"

namespace sgs {

// A view of a scene, as a machine is to draw it.
struct ViewJob {
  int view = 0;   // index of the camera
  Camera camera;  // as the frame has it: in its size
  FrameJob frame;
};

// Throws InputError when scene and frame do not fit the memory.
ViewJob view_job(const PreparedScene& scene, int view, const Camera& camera,
                 const RunConfig& config);

// Pictures of a view that depend on the scene, the camera and the background, but not on the
// machine.
struct ReferencePictures {
  Image reference;                                // the scene as given, in storage order
  Image decoded_reference;                        // the scene as encoded
  std::optional<FileOrderDifference> file_order;  // for `reference`; none where it is not known
};

// drawn: that of the scene as encoded, where it is known; null: it is drawn.
ReferencePictures reference_pictures(const PreparedScene& scene, const FrameJob& job,
                                     const Image* drawn);

// A frame out of the modelled DRAM as a picture, against those.
struct JudgedFrame {
  Image frame;
  double psnr_db = 0, ssim = 0;         // against `reference`; infinite where they are equal
  std::optional<OrderLoss> order_loss;  // where splats were missed or blended out of order
};

// bytes: of the frame buffer.
JudgedFrame judge_frame(const PreparedScene& scene, const ViewJob& job,
                        const ReferencePictures& pictures, const GoldenFrame& golden,
                        const std::vector<std::byte>& bytes);

// The right one of two eyes: its picture and the reference picture of what it sees.
struct RightEye {
  Image frame, reference;
  double psnr_db = 0, ssim = 0;  // infinite where they are equal
};

// job: of one frame, golden: its golden frame. bytes: of the right eye's frame buffer.
// draws_reference: the golden picture is the reference picture of the scene as encoded.
RightEye judge_right_eye(const PreparedScene& scene, const FrameJob& job, const GoldenFrame& golden,
                         const std::vector<std::byte>& bytes, bool draws_reference);

// Pictures and their measures are those of the left eye where there are two.
struct ViewResult : ReferencePictures, JudgedFrame {
  int view = 0;   // index of the camera
  Camera camera;  // as the frame has it: in its size
  GoldenFrame golden;
  std::optional<RightEye> right;
  bool equals_golden = false;  // bytes of all frame buffers against the golden renderer's
  FrameResult run;
  std::vector<LeftOut> left_out;
  Binding binding;
  CostResult energy_j, area_mm2, area_by_owner_mm2;
  Totals area_totals_mm2, energy_totals_j;
  double stated_area_mm2 = 0;  // published for the machine; 0 where none is
  MemoryInterface memory_interface;
  SramModel sram_model;          // the model they were made with
  std::uint64_t image_hash = 0;  // hash of the bytes loaded into the memory
  std::uint64_t once_bytes = 0;  // each contributing Gaussian read once, each pixel written
  double once_ratio() const {
    return static_cast<double>(run.memory.bytes) / static_cast<double>(once_bytes);
  }
  std::vector<FixedRate> fixed_rates;  // those that are asked for
  double mean_power_w() const { return run.cycles > 0 ? energy_j.total.middle / run.time_s() : 0; }
};

// No Gaussian contributes: the picture is background, and equality says nothing.
inline bool is_empty(const ViewResult& view) { return view.golden.contributing == 0; }

// Makes the result from these and a simulation; `left_out` and `equals_golden` are not filled in.
// dram: of the simulation.
ViewResult view_result(const PreparedScene& scene, const ViewJob& job, ReferencePictures pictures,
                       GoldenFrame golden, JudgedFrame judged, FrameResult run,
                       const DramConfig& dram, const Technology& technology);

// Fills in what follows from the counts of a simulation, in `run`: joules, area, bottleneck.
void account(ViewResult& view, const DramConfig& dram, const Technology& technology);

// Lists the data that the storage and the machine left out.
void list_left_out(const StoredScene& scene, const MachineResult& machine, DataSheet& sheet);

// Throws InputError when scene and frames do not fit the memory.
void check_capacity(const FrameJob& job, const DramConfig& dram);

// Simulates one view and judges it: golden picture, costs, binding unit. Throws InputError when
// scene and frame do not fit the memory, std::runtime_error when the simulation fails.
ViewResult simulate_view(const PreparedScene& scene, int number, const Camera& camera,
                         const RunConfig& config, const Technology& technology,
                         const RunOptions& options);

}  // namespace sgs
