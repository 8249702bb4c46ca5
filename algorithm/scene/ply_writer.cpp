// The writer of ply_writer.h: records are put together block by block and appended.
#include "algorithm/scene/ply_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "algorithm/scene/ply_header.h"

namespace sgs {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "records are written as they lie in memory");

constexpr std::size_t kBlockRecords = 16384;  // at most 4 MB a block

void check_lengths(const std::string& path, const GaussianCloud& cloud) {
  const std::size_t n = cloud.size();
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  if (cloud.sh_degree < 0 || cloud.sh_degree > 3 || cloud.log_scales.size() != n ||
      cloud.quats.size() != n || cloud.opacity_logits.size() != n ||
      cloud.sh_coeffs.size() != n * coeffs) {
    throw InputError(fmt::format(
        "{}: cloud of degree {} with {} means, {} scales, {} quaternions, {} opacities, {} "
        "coefficients cannot be written, expected degree 0 to 3 and equal counts",
        path, cloud.sh_degree, n, cloud.log_scales.size(), cloud.quats.size(),
        cloud.opacity_logits.size(), cloud.sh_coeffs.size()));
  }
}

std::string header_of(const GaussianCloud& cloud, const std::vector<std::string>& notes) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  if (std::find(notes.begin(), notes.end(), kAntialiasedNote) != notes.end()) {
    header += "comment SplatRenderMode: mip\n";  // as Brush has it
  }
  header += fmt::format("element vertex {}\n", cloud.size());
  const auto add = [&header](const char* name, int count) {
    for (int i = 0; i < count; ++i) header += fmt::format("property float {}{}\n", name, i);
  };
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    header += fmt::format("property float {}\n", name);
  }
  add("f_dc_", 3);
  add("f_rest_", 3 * (sh_coeff_count(cloud.sh_degree) - 1));
  header += "property float opacity\n";
  add("scale_", 3);
  add("rot_", 4);
  return header + "end_header\n";
}

// Appends the record of Gaussian i to `out`.
void append_record(const GaussianCloud& cloud, std::size_t i, std::vector<float>& out) {
  const int coeffs = sh_coeff_count(cloud.sh_degree);
  const glm::vec3& mean = cloud.means[i];
  const glm::vec3* sh = &cloud.sh_coeffs[i * static_cast<std::size_t>(coeffs)];
  out.insert(out.end(), {mean.x, mean.y, mean.z, 0.0f, 0.0f, 0.0f, sh[0].x, sh[0].y, sh[0].z});
  for (int channel = 0; channel < 3; ++channel) {
    for (int k = 1; k < coeffs; ++k) out.push_back(sh[k][channel]);
  }
  const glm::vec3& scale = cloud.log_scales[i];
  out.insert(out.end(), {cloud.opacity_logits[i], scale.x, scale.y, scale.z});
  out.insert(out.end(), cloud.quats[i].begin(), cloud.quats[i].end());
}

}  // namespace

void write_ply(const std::string& path, const GaussianCloud& cloud,
               const std::vector<std::string>& notes) {
  check_lengths(path, cloud);
  OutputFile output(path);
  output.write(header_of(cloud, notes));
  std::vector<float> block;
  for (std::size_t begin = 0; begin < cloud.size(); begin += kBlockRecords) {
    block.clear();
    const std::size_t end = std::min(cloud.size(), begin + kBlockRecords);
    for (std::size_t i = begin; i < end; ++i) append_record(cloud, i, block);
    output.write(block.data(), sizeof(float) * block.size());
  }
  output.commit();
}

}  // namespace sgs
