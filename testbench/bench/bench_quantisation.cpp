// Quality of vector quantisation on views that had no part in it: each view in turn is left out of
// the weighting and then rendered. Beside it plain k-means of the same sizes: scales as they are,
// quaternions as four numbers, every Gaussian worth the same.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/image/quality.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/storage/encoded_cloud.h"
#include "algorithm/vq/image_weights.h"
#include "algorithm/vq/kmeans.h"
#include "testbench/bench/bench_scene.h"
#include "testbench/command_line/guard.h"

namespace sgs {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

// Each value of the cloud replaced by its centroid. access(gaussian index, dimension): reference.
template <class Access>
void quantise_plainly(std::size_t count, int dims, std::uint32_t entries, const VqConfig& config,
                      Access&& access) {
  PointSet points;
  points.dims = dims;
  points.weights.assign(count, 1);
  for (std::size_t i = 0; i < count; ++i) {
    for (int d = 0; d < dims; ++d) points.values.push_back(access(i, d));
  }
  KMeansConfig kmeans_config;
  kmeans_config.entries = entries;
  kmeans_config.iterations = config.iterations;
  kmeans_config.seed = config.seed;
  const KMeansResult result = kmeans(points, kmeans_config);
  for (std::size_t i = 0; i < count; ++i) {
    for (int d = 0; d < dims; ++d) {
      access(i, d) = result.centroids[std::size_t{result.labels[i]} * dims + d];
    }
  }
}

ActivatedCloud plain(ActivatedCloud cloud, const VqConfig& config) {
  const std::size_t count = cloud.size();
  const auto stride = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  quantise_plainly(count, 3, config.scale_entries, config,
                   [&](std::size_t i, int d) -> float& { return cloud.gaussians[i].scale[d]; });
  quantise_plainly(count, 4, config.rotation_entries, config, [&](std::size_t i, int d) -> float& {
    return cloud.gaussians[i].quat[static_cast<std::size_t>(d)];
  });
  quantise_plainly(count, 3, config.dc_entries, config,
                   [&](std::size_t i, int d) -> float& { return cloud.sh_coeffs[i * stride][d]; });
  if (cloud.sh_degree > 0) {
    quantise_plainly(
        count, 3 * (static_cast<int>(stride) - 1), config.sh_entries, config,
        [&](std::size_t i, int d) -> float& {
          return cloud.sh_coeffs[i * stride + 1 + static_cast<std::size_t>(d) / 3][d % 3];
        });
  }
  for (Gaussian<float>& g : cloud.gaussians) {
    float squared = 0;
    for (const float component : g.quat) squared += component * component;
    for (float& component : g.quat) component /= std::sqrt(squared);
    g.opacity = std::round(g.opacity * 255) / 255;
  }
  return cloud;
}

struct Quality {
  std::vector<double> psnr_db;  // one a view
  double seconds = 0;           // for one training
};

std::string text(const Quality& quality) {
  std::string line;
  for (const double psnr_db : quality.psnr_db) line += fmt::format("{:.1f} ", psnr_db);
  return fmt::format("{}| {:.1f}", line, quality.seconds);
}

void measure(const std::string& spec) {
  const Scene scene = load_bench_scene(spec);
  const ActivatedCloud cloud = activate(scene.cloud);
  const std::vector<Camera>& cameras = scene.cameras;
  const VqConfig config;
  std::vector<Image> reference;
  for (const Camera& camera : cameras) {
    reference.push_back(render_reference(make_view<float>(camera), cloud).image);
  }
  const auto psnr_of = [&](const ActivatedCloud& decoded, std::size_t view) {
    return psnr_db(render_reference(make_view<float>(cameras[view]), decoded).image,
                   reference[view]);
  };
  const auto ours = [&](const std::vector<Camera>& weighing, Quality& quality) {
    const auto began = Clock::now();
    const EncodedCloud encoded = encode_quantised(
        cloud,
        quantise(cloud, image_weights(cloud, weighing), pixel_sizes(cloud, weighing), config),
        SecondHalfEncoding::kVq);
    quality.seconds = seconds_since(began);
    return encoded.decoded;
  };

  Quality plain_quality, held_out, all_views, no_views;
  const auto began = Clock::now();
  const ActivatedCloud plain_cloud = plain(cloud, config);
  plain_quality.seconds = seconds_since(began);
  const ActivatedCloud with_all = ours(cameras, all_views), without = ours({}, no_views);
  for (std::size_t view = 0; view < cameras.size(); ++view) {
    plain_quality.psnr_db.push_back(psnr_of(plain_cloud, view));
    all_views.psnr_db.push_back(psnr_of(with_all, view));
    no_views.psnr_db.push_back(psnr_of(without, view));
    std::vector<Camera> others = cameras;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(view));
    held_out.psnr_db.push_back(psnr_of(ours(others, held_out), view));
  }
  fmt::print("| {} | {} | {} | {} | {} | {} |\n", scene.name, scene.cloud.sh_degree,
             text(plain_quality), text(no_views), text(held_out), text(all_views));
  std::fflush(stdout);
}

}  // namespace
}  // namespace sgs

int main(int argc, char** argv) {
  return sgs::run_guarded("bench_quantisation", [&] {
    if (argc < 2) throw sgs::InputError("got no scene, expected bench_quantisation SCENE...");
    fmt::print(
        "vector quantisation, codebooks of the paper's sizes: PSNR of each view against the scene "
        "as given, seconds of one training\n"
        "| scene | SH degree | plain k-means, dB | s | ours, weighed by sizes alone, dB | s | "
        "ours, "
        "weighed by the other views, dB | s | ours, weighed by all views, dB | s |\n"
        "| --- | ---: | --- | ---: | --- | ---: | --- | ---: | --- | ---: |\n");
    for (int i = 1; i < argc; ++i) sgs::measure(argv[i]);
    return sgs::kDone;
  });
}
