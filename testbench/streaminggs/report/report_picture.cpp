// Sections of the scene, the camera and the picture.
#include <cmath>
#include <nlohmann/json.hpp>
#include <variant>

#include "algorithm/image/quality.h"
#include "algorithm/storage/storage_scheme.h"
#include "testbench/streaminggs/report/report_sections.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity: equal pictures report null and say so by max_abs_error 0.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

void visit_codebooks(ReportVisitor& r, const SecondHalfFormat& format) {
  r.object("codebooks", [&] {
    for (std::size_t id = 0; id < kCodebookCount; ++id) {
      if (!r.has(format.entries[id] > 0)) continue;
      const auto codebook = static_cast<Codebook>(id);
      r.object({"CODEBOOK", kCodebookNames[id]}, [&] {
        r("entries", "", "Entries of this codebook.", format.entries[id]);
        r("words", "", "Numbers in an entry.", codebook_words(codebook, format.sh_degree));
        r("bytes", "B", "Size of this codebook.",
          format.entries[id] * format.entry_bytes(codebook));
      });
    }
  });
}

void visit_facts(ReportVisitor& r, const StorageScheme& scheme, const TableLayout& table) {
  for (const StorageFact& fact : scheme.facts(table)) {
    std::visit([&](auto number) { r(fact.key, fact.unit, fact.meaning, number); }, fact.value);
  }
}

void visit_error_part(ReportVisitor& r, const char* step, const ErrorPart& part) {
  r.object({"STEP", step}, [&] {
    r("share", "ratio",
      "This step's part of the squared error; all add up to 1. `null` where pictures are equal.",
      finite(part.share));
    r("alone", "ratio",
      "This step's own square over the squared error. `null` where pictures are equal.",
      finite(part.alone));
  });
}

void visit_error_parts(ReportVisitor& r, const OrderLoss& loss) {
  r.object("error_parts", [&] {
    if (loss.encoding) visit_error_part(r, "encoding", *loss.encoding);
    visit_error_part(r, "missed", loss.missed);
    visit_error_part(r, "misordered", loss.misordered);
    if (loss.arithmetic) visit_error_part(r, "arithmetic", *loss.arithmetic);
    visit_error_part(r, "pixel_format", loss.pixel_format);
  });
}

void visit_file_order(ReportVisitor& r, const std::optional<FileOrderDifference>& difference) {
  if (r.has(!difference)) {
    r("file_order", "", "`null` for a packed scene: the order of its file is not known.", nullptr);
  }
  r.each(difference, [&](const FileOrderDifference& d) {
    r.object("file_order", [&] {
      r("psnr_db", "dB",
        "Reference picture, with ties of depth by storage slot, against ties in the file's order. "
        "`null`: equal.",
        finite(d.psnr_db));
      r("max_abs_error", "linear", "Largest difference of a channel between these two pictures.",
        d.max_abs_error);
      r("pixels", "", "Pixels that differ between them.", d.pixels);
    });
  });
}

}  // namespace

void visit_scene(ReportVisitor& r, const PreparedScene& scene) {
  const SceneLayout& layout = scene.stored.image.layout;
  const StorageScheme& scheme = scheme_of(layout.order());
  r("name", "", "Name of the scene.", scene.name);
  r("gaussians", "", "Gaussians in the file, without those that were dropped.",
    scene.stored.gaussians);
  r("sh_degree", "0..3", "Degree of the stored colours.", layout.sh_degree());
  r("dropped_invalid", "", "Gaussians that `--drop-invalid` left out.", scene.dropped_invalid);
  r("axes", "",
    "Where x, y and z of the file point, before the scene was turned to right, down, forward; `as "
    "stored`: it was not turned.",
    scene.axes.empty() ? "as stored" : scene.axes);
  r("stored_by", "", "Storage order: `chunks`, `voxels` or `file`.", scheme.name());
  if (r.telling()) {
    for (const StorageScheme* any : {&voxel_scheme(), &chunk_scheme(), &file_scheme()}) {
      visit_facts(r, *any, any->empty_table());
    }
  } else {
    visit_facts(r, scheme, layout.table);
  }
  r("second_half_bytes", "B", "Size of one second half in this encoding.",
    layout.second_halves.record_bytes);
  visit_codebooks(r, layout.second_half);
  r("stored_bytes", "B", "Size of the scene in DRAM: tables, both halves and codebooks.",
    layout.stored_bytes);
}

void visit_camera(ReportVisitor& r, const Camera& camera) {
  const glm::dmat3& axes = camera.world_from_camera;
  Json rotation = Json::array();
  for (int row = 0; row < 3; ++row) rotation.push_back({axes[0][row], axes[1][row], axes[2][row]});
  r("id", "", "Number that the cameras' file gives it.", camera.id);
  r("img_name", "", "Name that the cameras' file gives it.", camera.name);
  r("fx_px", "px", "Horizontal focal length of the frame, after `--size`.", camera.focal_x);
  r("fy_px", "px", "Vertical focal length of the frame, after `--size`.", camera.focal_y);
  r("position", "world units", "Centre of the camera: x, y, z.",
    Json{camera.position.x, camera.position.y, camera.position.z});
  r("rotation", "",
    "Rows of a matrix whose columns are the axes right, down and forward, in the world.", rotation);
  if (r.has(camera.eyes_apart != 0)) {
    r("eyes_apart", "world units",
      "Distance of the right eye, along the axis right; none where there is one eye.",
      camera.eyes_apart);
  }
  if (!r.has(camera.principal_offset != glm::dvec2(0))) return;
  r("cx_px", "px", "Principal point from the left edge; none where it is in the middle.",
    0.5 * camera.width + camera.principal_offset.x);
  r("cy_px", "px", "Principal point from the top edge; none where it is in the middle.",
    0.5 * camera.height + camera.principal_offset.y);
}

void visit_image(ReportVisitor& r, const ViewResult& view, bool original_known) {
  const GoldenFrame& golden = view.golden;
  r("reference", "",
    "Scene that the reference picture shows: `scene`, as given; `decoded_scene`, where it was "
    "packed in an encoding that loses.",
    original_known ? "scene" : "decoded_scene");
  r("empty", "bool",
    "No Gaussian contributes: the picture is background, and equality says nothing.",
    is_empty(view));
  r("psnr_db", "dB",
    "Frame against reference picture, both clamped to 0..1. `null`: infinite, they are equal.",
    finite(view.psnr_db));
  r("ssim", "0..1", "Frame against reference picture, both clamped to 0..1.", view.ssim);
  r("max_abs_error", "linear",
    "Largest difference of a channel, not clamped: rgb8 frames differ where the picture is "
    "brighter than 1.",
    [&] { return max_abs_error(view.frame, view.reference); });
  r("decoded_psnr_db", "dB",
    "Frame against the reference picture of the scene as encoded: the cost of order and pixel "
    "format.",
    [&] { return finite(psnr_db(view.frame, view.decoded_reference)); });
  if (r.has(original_known)) {
    r("encoding_psnr_db", "dB",
      "The reference picture of the scene as encoded against that of the scene as given: the cost "
      "of encoding.",
      [&] { return finite(psnr_db(view.decoded_reference, view.reference)); });
  }
  visit_file_order(r, view.file_order);
  r("equals_streaming_renderer", "bool",
    "The frame buffer equals the machine's streaming renderer, byte for byte.", view.equals_golden);
  r("missed", "",
    "Pairs of a group and a splat that touches it from a voxel that none of its rays crosses.",
    golden.missed);
  r("misordered", "", "Blends behind a splat that is farther away, at the same pixel.",
    golden.misordered);
  r("blends", "", "Pairs of a splat and a pixel that it contributes to.", golden.blends);
  r.each(view.right, [&](const RightEye& right) {
    r.object("right_eye", [&] {
      r("psnr_db", "dB", "As `image.psnr_db`, which is the left eye's where there are two.",
        finite(right.psnr_db));
      r("ssim", "0..1", "As `image.ssim`.", right.ssim);
      r("max_abs_error", "linear", "As `image.max_abs_error`.",
        [&] { return max_abs_error(right.frame, right.reference); });
      r("empty", "bool", "No Gaussian contributes to this eye's picture.",
        golden.contributing_of[1] == 0);
    });
  });
  r.each(view.order_loss, [&](const OrderLoss& loss) { visit_error_parts(r, loss); });
}

}  // namespace sgs
