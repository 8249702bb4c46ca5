// The camera of a frame (transforms_frame.h), as nerfstudio and instant-ngp write it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "algorithm/dataset/transforms_frame.h"

namespace sgs {
namespace {

constexpr std::array<const char*, 8> kCoefficients = {"k1", "k2", "k3", "k4",
                                                      "k5", "k6", "p1", "p2"};
constexpr std::size_t kFirstTangential = 6;
constexpr std::array<const char*, 5> kOtherCameras = {"equirectangular", "latlong", "orthographic",
                                                      "from_mitsuba", "from_na"};

// Keys that say how a picture came about, of cameras that are not read.
void refuse_other_cameras(const TransformsFrame& frame) {
  for (const char* key : kOtherCameras) {
    if (frame.flag(key)) frame.fail(key, "true", "a pinhole or a fisheye, in its own axes");
  }
  if (const auto focal = frame.number("ftheta_p0")) {
    frame.fail("ftheta_p0", fmt::format("{}", *focal), "no f-theta lens, but a pinhole or fisheye");
  }
  for (const char* key : {"sk_x", "sk_y"}) {
    const double skew = frame.number(key).value_or(0);
    if (skew != 0) frame.fail(key, fmt::format("{}", skew), "0: no skew");
  }
  const std::vector<double> shutter = frame.numbers("rolling_shutter");
  for (std::size_t i = 1; i < shutter.size(); ++i) {
    if (shutter[i] == 0) continue;
    frame.fail(fmt::format("rolling_shutter[{}]", i), fmt::format("{}", shutter[i]),
               "0: one pose for the whole picture");
  }
}

// In the order of kCoefficients. distortion_params: k1 k2 k3 k4 p1 p2.
std::array<double, 8> coefficients_of(const TransformsFrame& frame) {
  std::array<double, 8> out{};
  const std::vector<double> listed = frame.numbers("distortion_params");
  if (!listed.empty() && listed.size() != 4 && listed.size() != 6) {
    frame.fail("distortion_params", fmt::format("{} numbers", listed.size()),
               "k1, k2, k3, k4 and, but of a fisheye, p1, p2");
  }
  for (std::size_t i = 0; i < listed.size(); ++i) out[i < 4 ? i : i + 2] = listed[i];
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto alone = frame.number(kCoefficients[i]);
    if (!alone) continue;
    if (!listed.empty() && *alone != out[i]) {
      frame.fail(kCoefficients[i], fmt::format("{}", *alone),
                 "it as distortion_params has it, or one of the two");
    }
    out[i] = *alone;
  }
  return out;
}

Lens lens_of(const TransformsFrame& frame) {
  static const std::set<std::string> kPerspective = {"PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL",
                                                     "RADIAL",  "OPENCV",         "FULL_OPENCV"};
  static const std::set<std::string> kFisheye = {"OPENCV_FISHEYE", "RADIAL_FISHEYE",
                                                 "SIMPLE_RADIAL_FISHEYE"};
  const std::array<double, 8> numbers = coefficients_of(frame);
  const bool fisheye = frame.flag("is_fisheye");
  Lens lens;
  lens.model = frame.text("camera_model").value_or(fisheye ? "OPENCV_FISHEYE" : "OPENCV");
  lens.kind = kPerspective.count(lens.model) > 0 ? LensKind::kPerspective
              : kFisheye.count(lens.model) > 0   ? LensKind::kFisheye
                                                 : LensKind::kOther;
  if (fisheye && lens.kind == LensKind::kPerspective) {
    lens.model = "OPENCV_FISHEYE";  // as instant-ngp takes it
    lens.kind = LensKind::kFisheye;
  }
  std::copy_n(numbers.begin(), lens.k.size(), lens.k.begin());
  lens.p1 = numbers[kFirstTangential];
  lens.p2 = numbers[kFirstTangential + 1];
  // Programs differ in what further coefficients stand for.
  const std::size_t meant = lens.kind == LensKind::kFisheye ? 4
                            : lens.model == "FULL_OPENCV"   ? numbers.size()
                                                            : 3;
  for (std::size_t i = meant; i < numbers.size(); ++i) {
    const bool tangential = i >= kFirstTangential;
    if (numbers[i] == 0 || (tangential && lens.kind != LensKind::kFisheye)) continue;
    frame.fail(kCoefficients[i], fmt::format("{}", numbers[i]),
               lens.kind == LensKind::kFisheye
                   ? "0: a fisheye has k1 to k4"
                   : "0: but of FULL_OPENCV there are k1, k2, k3, p1, p2");
  }
  return lens;
}

int size_of(const TransformsFrame& frame, const char* key) {
  const auto size = frame.number(key);
  if (!size) return 0;
  if (!(*size >= 1 && *size <= INT32_MAX) || *size != std::floor(*size)) {
    frame.fail(key, fmt::format("{}", *size), "a whole number of px from 1");
  }
  return static_cast<int>(*size);
}

std::optional<double> angle_of(const TransformsFrame& frame, const char* key) {
  const auto angle = frame.number(key);
  if (angle && !(*angle > 0 && *angle < M_PI)) {
    frame.fail(key, fmt::format("{}", *angle), "radians between 0 and pi");
  }
  return angle;
}

}  // namespace

Intrinsics transforms_intrinsics(const TransformsFrame& frame) {
  refuse_other_cameras(frame);
  Intrinsics out;
  out.lens = lens_of(frame);
  out.width = size_of(frame, "w");
  out.height = size_of(frame, "h");
  out.focal_x = frame.number("fl_x");
  out.focal_y = frame.number("fl_y");
  if (!out.focal_x) out.angle_x = angle_of(frame, "camera_angle_x");
  if (!out.focal_y) out.angle_y = angle_of(frame, "camera_angle_y");
  if (!out.focal_x && !out.focal_y && !out.angle_x && !out.angle_y) {
    frame.fail("fl_x", "nothing", "it, or camera_angle_x");
  }
  out.centre_x = frame.number("cx");
  out.centre_y = frame.number("cy");
  return out;
}

bool is_read_of_transforms(const std::string& key) {
  static const std::set<std::string> kKeys = {"frames",
                                              "file_path",
                                              "mask_path",
                                              "transform_matrix",
                                              "ply_file_path",
                                              "train_filenames",
                                              "test_filenames",
                                              "val_filenames",
                                              "camera_model",
                                              "is_fisheye",
                                              "w",
                                              "h",
                                              "fl_x",
                                              "fl_y",
                                              "camera_angle_x",
                                              "camera_angle_y",
                                              "cx",
                                              "cy",
                                              "distortion_params",
                                              "ftheta_p0",
                                              "sk_x",
                                              "sk_y",
                                              "rolling_shutter"};
  return kKeys.count(key) > 0 ||
         std::find(kCoefficients.begin(), kCoefficients.end(), key) != kCoefficients.end() ||
         std::find(kOtherCameras.begin(), kOtherCameras.end(), key) != kOtherCameras.end();
}

}  // namespace sgs
