// The record of splat_file.h.
#include "algorithm/scene_files/splat_file.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"
#include "algorithm/scene_files/decoded_scene.h"

namespace sgs {
namespace {

constexpr std::uint64_t kRecordBytes = 32;
constexpr int kScaleAt = 12, kColourAt = 24, kOpacityAt = 27, kRotationAt = 28;

void decode_rotation(const char* bytes, float* rotation) {
  std::array<double, 4> q{};
  for (int k = 0; k < 4; ++k) q[k] = (byte_at(bytes + k) / 255.0) * 2 - 1;
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int k = 0; k < 4; ++k) rotation[k] = static_cast<float>(q[k] / length);
}

}  // namespace

SceneContents read_splat(const std::string& path, const SceneReadOptions& options) {
  const InputFile file(path);
  if (file.size_bytes() == 0 || file.size_bytes() % kRecordBytes != 0) {
    throw InputError(fmt::format("{}: got {} bytes, expected records of {} bytes", path,
                                 file.size_bytes(), kRecordBytes));
  }
  const std::string bytes = file.text_from(0, file.size_bytes());
  return decoded_scene(path, bytes.size() / kRecordBytes, 0, options,
                       [&](std::uint64_t index, float* slots) {
                         const char* record = &bytes[index * kRecordBytes];
                         for (int axis = 0; axis < 3; ++axis) {
                           slots[kMeanSlot + axis] = load_number<float>(record + 4 * axis);
                           const double scale = load_number<float>(record + kScaleAt + 4 * axis);
                           slots[kScaleSlot + axis] = static_cast<float>(std::log(scale));
                           const double colour = byte_at(record + kColourAt + axis) / 255.0;
                           slots[kDcSlot + axis] = static_cast<float>(dc_of_colour(colour));
                         }
                         slots[kOpacitySlot] = logit_of_byte(byte_at(record + kOpacityAt));
                         decode_rotation(record + kRotationAt, slots + kRotationSlot);
                       });
}

}  // namespace sgs
