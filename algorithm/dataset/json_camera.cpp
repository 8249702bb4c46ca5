// Keys as nerfstudio and instant-ngp write them.
#include "algorithm/dataset/json_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

namespace sgs {
namespace {

constexpr std::array<const char*, 8> kCoefficients = {"k1", "k2", "k3", "k4",
                                                      "k5", "k6", "p1", "p2"};
constexpr std::size_t kFirstTangential = 6;
constexpr std::array<const char*, 5> kOtherCameras = {"equirectangular", "latlong", "orthographic",
                                                      "from_mitsuba", "from_na"};

bool flag_of(const JsonPlace& camera, const char* key) {
  const auto flag = camera.find(key);
  return flag && flag->flag();
}

// Keys that say how a picture came about, of cameras that are not read.
void refuse_other_cameras(const JsonPlace& camera) {
  for (const char* key : kOtherCameras) {
    if (flag_of(camera, key)) camera.at(key).refuse("a pinhole or a fisheye, in its own axes");
  }
  if (const auto focal = camera.find("ftheta_p0")) {
    focal->refuse("no f-theta lens, but a pinhole or fisheye");
  }
  for (const char* key : {"sk_x", "sk_y", "skew"}) {
    const auto skew = camera.find(key);
    if (skew && skew->number() != 0) skew->refuse("0: no skew");
  }
  const auto shutter = camera.find("rolling_shutter");
  if (!shutter) return;
  const std::vector<JsonPlace> times = shutter->elements();
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i].number() != 0) times[i].refuse("0: one pose for the whole picture");
  }
}

// In the order of kCoefficients. distortion_params: k1 k2 k3 k4 p1 p2.
std::array<double, 8> coefficients_of(const JsonPlace& camera) {
  std::array<double, 8> out{};
  const auto list = camera.find("distortion_params");
  const std::vector<double> listed = list ? list->numbers() : std::vector<double>();
  if (!listed.empty() && listed.size() != 4 && listed.size() != 6) {
    list->refuse(fmt::format("{} numbers", listed.size()),
                 "k1, k2, k3, k4 and, but of a fisheye, p1, p2");
  }
  for (std::size_t i = 0; i < listed.size(); ++i) out[i < 4 ? i : i + 2] = listed[i];
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto alone = camera.find(kCoefficients[i]);
    if (!alone) continue;
    if (!listed.empty() && alone->number() != out[i]) {
      alone->refuse("it as distortion_params has it, or one of the two");
    }
    out[i] = alone->number();
  }
  return out;
}

// Programs differ in what further coefficients stand for.
void refuse_other_coefficients(const JsonPlace& camera, const Lens& lens,
                               const std::array<double, 8>& numbers) {
  const bool fisheye = lens.kind == LensKind::kFisheye;
  const std::size_t meant = fisheye ? 4 : lens.model == "FULL_OPENCV" ? numbers.size() : 3;
  for (std::size_t i = meant; i < numbers.size(); ++i) {
    if (numbers[i] == 0 || (i >= kFirstTangential && !fisheye)) continue;
    const char* expected = fisheye ? "0: a fisheye has k1 to k4"
                                   : "0: but of FULL_OPENCV there are k1, k2, k3, p1, p2";
    if (const auto alone = camera.find(kCoefficients[i])) alone->refuse(expected);
    camera.at("distortion_params")
        .refuse(fmt::format("a {} of {}", kCoefficients[i], numbers[i]), expected);
  }
}

}  // namespace

Lens lens_of(const JsonPlace& camera) {
  static const std::set<std::string> kPerspective = {"PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL",
                                                     "RADIAL",  "OPENCV",         "FULL_OPENCV"};
  static const std::set<std::string> kFisheye = {"OPENCV_FISHEYE", "RADIAL_FISHEYE",
                                                 "SIMPLE_RADIAL_FISHEYE"};
  refuse_other_cameras(camera);
  const std::array<double, 8> numbers = coefficients_of(camera);
  const bool fisheye = flag_of(camera, "is_fisheye");
  const auto model = camera.find("camera_model");
  Lens lens;
  lens.model = model ? model->text() : fisheye ? "OPENCV_FISHEYE" : "OPENCV";
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
  refuse_other_coefficients(camera, lens, numbers);
  return lens;
}

int size_px(const JsonPlace& place) {
  return static_cast<int>(place.whole(1, INT32_MAX, " of px"));
}

glm::dmat4 matrix_of(const JsonPlace& place, std::size_t columns) {
  const std::string expected = fmt::format("{0} rows of {0} numbers", columns);
  const std::vector<JsonPlace> rows = place.elements(expected);
  if (rows.size() < 3 || rows.size() > columns) place.refuse(expected);
  glm::dmat4 out(1.0);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::vector<double> numbers = rows[row].numbers(columns);
    for (std::size_t column = 0; column < columns; ++column) {
      out[static_cast<int>(column)][static_cast<int>(row)] = numbers[column];
    }
  }
  return out;
}

void count_unread(const JsonPlace& object, const std::vector<std::string>& known,
                  std::map<std::string, int>& counts) {
  static const std::vector<std::string> kOfLenses = [] {
    std::vector<std::string> keys = {"camera_model", "is_fisheye",     "distortion_params",
                                     "ftheta_p0",    "sk_x",           "sk_y",
                                     "skew",         "rolling_shutter"};
    keys.insert(keys.end(), kCoefficients.begin(), kCoefficients.end());
    keys.insert(keys.end(), kOtherCameras.begin(), kOtherCameras.end());
    return keys;
  }();
  for (const std::string& key : object.keys_beside(known)) {
    if (std::find(kOfLenses.begin(), kOfLenses.end(), key) == kOfLenses.end()) ++counts[key];
  }
}

}  // namespace sgs
