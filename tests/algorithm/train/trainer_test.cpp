// Schedules by the step.
#include "algorithm/train/trainer.h"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "algorithm/image/quality.h"
#include "algorithm/splat/activate.h"
#include "algorithm/train/comparison.h"
#include "algorithm/train/start_cloud.h"
#include "algorithm/tune/group_sequences.h"
#include "tests/algorithm/render/test_clouds.h"

namespace sgs::test {
namespace {

TEST_CASE("schedule: pictures grow to their full size, in steps of the square root of 2") {
  TrainingConfig config;
  config.steps = 1000;
  CHECK(config.downscale_at(0) == 4);
  double before = 4;
  for (int step = 0; step < 1000; ++step) {
    const double now = config.downscale_at(step);
    REQUIRE(now <= before);
    const double halvings = 2 * std::log2(now);
    REQUIRE(halvings == Approx(std::round(halvings)).margin(1e-12));
    before = now;
  }
  CHECK(config.downscale_at(250) == 1);
  config.first_downscale = 1;
  CHECK(config.downscale_at(0) == 1);
}

TEST_CASE("schedule: degrees, growth and rates") {
  TrainingConfig config;
  config.steps = 10'000;
  CHECK(config.degree_at(0) == 0);
  CHECK(config.degree_at(499) == 0);
  CHECK(config.degree_at(500) == 1);
  CHECK(config.degree_at(1500) == 3);
  CHECK(config.degree_at(9999) == 3);
  config.sh_degree = 0;
  CHECK(config.degree_at(9999) == 0);

  CHECK_FALSE(config.grows_at(100));
  CHECK(config.grows_at(200));
  CHECK_FALSE(config.grows_at(250));
  CHECK(config.grows_at(8000));
  CHECK_FALSE(config.grows_at(8100));

  CHECK(config.rates_at(0, 2).mean == Approx(2 * 1.6e-4));
  CHECK(config.rates_at(10'000, 2).mean == Approx(2 * 1.6e-6));
}

// 3D Gaussian Splatting as MCMC (Kheradmand et al. 2024) and its code: 5 % more each 100 steps,
// noise_lr, opacity_reg, scale_reg.
TEST_CASE("schedule: defaults of MCMC") {
  const TrainingConfig config;
  CHECK(config.growth == Growth::kMcmc);
  CHECK(config.growth_factor == 1.05);
  CHECK(config.grow_every == 100);
  CHECK(config.noise == 5e5);
  CHECK(config.opacity_share == 0.01);
  CHECK(config.scale_share == 0.01);
}

// Arguments of the original's released code (Kerbl et al. 2023): opacity_reset_interval,
// densify_grad_threshold, percent_dense, scaling_lr, rotation_lr, opacity_lr of the first release,
// feature_lr and a 20th of it, position_lr_init, _final and _max_steps.
TEST_CASE("schedule: defaults of the original") {
  const TrainingConfig config;
  CHECK(config.reset_every == 3000);
  CHECK(config.densification.pull == 2e-4);
  CHECK(config.densification.clone_share == 0.01);
  CHECK(config.densification.least_opacity == 0.005);
  CHECK(config.densification.most_scale_share == 0.1);
  CHECK(config.densification.most_radius_px == 20);
  CHECK(config.densification.reset_opacity == 0.01);

  // Positions by the extent, halfway by the geometric mean; the rest does not change.
  const LearningSchedule schedule;
  for (const auto& [step, mean] :
       {std::pair{0, 1.6e-4}, {15'000, 1.6e-5}, {30'000, 1.6e-6}, {40'000, 1.6e-6}}) {
    CAPTURE(step);
    const LearningRates rates = schedule.at(step, 3);
    CHECK(rates.mean == Approx(3 * mean));
    CHECK(rates.log_scale == 5e-3);
    CHECK(rates.quat == 1e-3);
    CHECK(rates.opacity_logit == 0.05);
    CHECK(rates.sh_dc == 2.5e-3);
    CHECK(rates.sh_rest == 2.5e-3 / 20);
  }
}

}  // namespace
}  // namespace sgs::test

namespace sgs::test {
namespace {

// Around the origin, at a distance of 3.
Camera camera_at(int number, int of, double downscale) {
  Camera camera = forward_camera(static_cast<int>(std::lround(64 / downscale)),
                                 static_cast<int>(std::lround(48 / downscale)), 60 / downscale);
  const double turn = 6.283185307179586 * number / of;
  const glm::dvec3 z = glm::normalize(glm::dvec3(std::cos(turn), std::sin(turn), 0.2));
  const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0, 0, 1)));
  camera.world_from_camera = glm::dmat3(x, glm::cross(z, x), z);
  camera.position = -3.0 * z;
  return camera;
}

// Transparent where nothing is.
Photographs photographs_of(const GaussianCloud& scene, std::size_t count, int turned_by = 0) {
  const int of = static_cast<int>(count);
  return Photographs(count, [scene, of, turned_by](std::size_t at, double downscale) {
    Photograph out;
    out.camera = camera_at(2 * static_cast<int>(at) + turned_by, 2 * of, downscale);
    const RenderResult drawn =
        draw(reference_sequences(make_view<float>(out.camera), activate(scene)));
    out.image = RgbaImage(drawn.image.width, drawn.image.height);
    for (std::size_t i = 0; i < out.image.pixels.size(); ++i) {
      out.image.pixels[i] = glm::vec4(drawn.image.pixels[i], 1 - drawn.transmittance[i]);
    }
    return out;
  });
}

GaussianCloud scene() {
  GaussianCloud cloud;
  add_ball(cloud, {0, 0, 0}, 0.3, 0.95, {0.9F, 0.2F, 0.1F});
  add_ball(cloud, {0.4F, 0.1F, 0.2F}, 0.15, 0.9, {0.1F, 0.8F, 0.2F});
  add_ball(cloud, {-0.3F, 0.3F, -0.2F}, 0.2, 0.9, {0.2F, 0.3F, 0.9F});
  return cloud;
}

TrainingConfig short_training(int steps) {
  TrainingConfig config;
  config.steps = steps;
  config.most_gaussians = 200;
  config.sh_degree = 1;
  config.grow_every = 20;
  config.first_downscale = 2;
  return config;
}

GaussianCloud start(std::uint64_t seed) {
  return start_at_points(random_points({glm::vec3(-0.8F), glm::vec3(0.8F)}, 100, seed), 100, {},
                         seed);
}

double test_psnr(const GaussianCloud& cloud) {
  Photographs test = photographs_of(scene(), 6, 1);
  test.load(1);
  return mean_quality(qualities(activate(cloud), test, glm::vec3(1))).psnr_db;
}

TEST_CASE("training: views between those that were seen come nearer, by either growth") {
  for (const Growth growth : {Growth::kMcmc, Growth::kOriginal}) {
    TrainingConfig config = short_training(400);
    config.growth = growth;
    Photographs photographs = photographs_of(scene(), 8);
    Trainer trainer(config, photographs, 3, start(1));
    const double before = test_psnr(trainer.cloud());
    while (!trainer.done()) trainer.step();
    CAPTURE(before, static_cast<int>(growth));
    CHECK(test_psnr(trainer.cloud()) > before + 12);
    CHECK(trainer.cloud().size() <= config.most_gaussians);
    CHECK(trainer.cloud().sh_degree == 1);
    if (growth == Growth::kMcmc) CHECK(trainer.cloud().size() == config.most_gaussians);
  }
}

struct Trained {
  std::vector<double> losses;
  GaussianCloud cloud;
};

Trained trained(std::uint64_t seed, int steps) {
  TrainingConfig config = short_training(100);
  config.seed = seed;
  Photographs photographs = photographs_of(scene(), 5);
  Trainer trainer(config, photographs, 3, start(seed));
  Trained out;
  for (int i = 0; i < steps; ++i) out.losses.push_back(trainer.step().loss);
  out.cloud = trainer.cloud();
  return out;
}

TEST_CASE("training: the same bits on 1 and 3 threads, others by another seed") {
  std::vector<Trained> runs;
  for (const std::size_t threads : {1, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    runs.push_back(trained(1, 60));
  }
  CHECK(runs[0].losses == runs[1].losses);
  CHECK(runs[0].cloud.means == runs[1].cloud.means);
  CHECK(runs[0].cloud.sh_coeffs == runs[1].cloud.sh_coeffs);
  CHECK(trained(2, 60).losses != runs[0].losses);
}

TEST_CASE("training: from a saved state it goes on, bit for bit") {
  for (const Growth growth : {Growth::kMcmc, Growth::kOriginal}) {
    TrainingConfig config = short_training(100);
    config.growth = growth;
    config.reset_every = 30;
    Photographs photographs = photographs_of(scene(), 5);
    Trainer whole(config, photographs, 3, start(1));
    for (int i = 0; i < 45; ++i) whole.step();
    Photographs again = photographs_of(scene(), 5);
    Trainer resumed(config, again, 3, whole.state());
    while (!whole.done()) {
      const Trainer::Step a = whole.step(), b = resumed.step();
      REQUIRE(a.number == b.number);
      REQUIRE(a.photograph == b.photograph);
      REQUIRE(a.loss == b.loss);
    }
    CHECK(whole.cloud().means == resumed.cloud().means);
    CHECK(whole.cloud().quats == resumed.cloud().quats);
  }
}

TEST_CASE("training: what is no number stops it, and the step has changed nothing") {
  Photographs photographs = photographs_of(scene(), 3);
  GaussianCloud cloud = start(1);
  for (glm::vec3& coeff : cloud.sh_coeffs) coeff.x = 1e38F;
  Trainer trainer(short_training(10), photographs, 3, cloud);
  CHECK_THROWS_WITH(trainer.step(), Catch::StartsWith("step 1: a derivative of Gaussian "));
  CHECK(trainer.cloud().means == cloud.means);
  CHECK(trainer.next_step() == 0);
}

TEST_CASE("training: pixels that do not count change no scene and no quality") {
  // A third of each photograph is masked, and there of another colour each time.
  const auto masked = [](float red) {
    Photographs photographs(5, [red](std::size_t at, double downscale) {
      Photographs whole = photographs_of(scene(), 5);
      whole.load(downscale);
      Photograph out;
      out.camera = whole.camera(at);
      const Image image = whole.before(at, glm::vec3(0));
      out.image = RgbaImage(image.width, image.height);
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const bool counts = static_cast<int>(i) % image.width >= image.width / 3;
        out.image.pixels[i] = glm::vec4(counts ? image.pixels[i] : glm::vec3(red, 0, 0), 1);
        out.counts.push_back(counts ? 1 : 0);
      }
      return out;
    });
    photographs.load(1);
    return photographs;
  };
  const auto trained = [&](float red) {
    Photographs photographs = masked(red);
    TrainingConfig config = short_training(30);
    config.background = Background::kBlack;
    Trainer trainer(config, photographs, 3.3, start(1));
    while (!trainer.done()) trainer.step();
    return trainer.cloud();
  };
  const GaussianCloud cloud = trained(0.5F);
  const bool same = cloud.means == trained(1).means && cloud.sh_coeffs == trained(1).sh_coeffs;
  CHECK(same);
  const auto quality = [&](const Photographs& photographs) {
    return mean_quality(qualities(activate(cloud), photographs, glm::vec3(0)));
  };
  const Quality half = quality(masked(0.5F)), red = quality(masked(1));
  CHECK(half.psnr_db == red.psnr_db);
  CHECK(half.ssim == red.ssim);
}

TEST_CASE("quality: over the pixels that count alone") {
  Image a(30, 12), b(30, 12);
  std::vector<std::uint8_t> counts(30 * 12, 0);
  double squares = 0;
  int counted = 0;
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 30; ++x) {
      a.at(x, y) = glm::vec3(0.02F * static_cast<float>(x), 0.5F, 0.3F);
      b.at(x, y) = x < 10 ? glm::vec3(1, 0, 1) : a.at(x, y) + glm::vec3(0.1F, 0, 0);
      counts[static_cast<std::size_t>(30 * y + x)] = x >= 10;
      if (x < 10) continue;
      squares += 0.01;
      counted += 3;
    }
  }
  CHECK(quality_of(a, b, counts).psnr_db == Approx(-10 * std::log10(squares / counted)));
  CHECK(quality_of(a, a, counts).ssim == Approx(1));
  CHECK(quality_of(a, b, counts).ssim < 0.99);
  CHECK(quality_of(a, b, counts).psnr_db > psnr_db(a, b) + 5);
  CHECK(quality_of(a, b, {}).psnr_db == psnr_db(a, b));
}

TEST_CASE("training: photographs keep 8 bits exactly and know whether they are transparent") {
  const auto source = [](std::size_t, double) {
    Photograph out;
    out.camera = forward_camera(16, 16, 16);
    out.image = RgbaImage(16, 16);
    for (std::size_t i = 0; i < 256; ++i) {
      out.image.pixels[i] = glm::vec4(glm::vec3(static_cast<float>(i) / 255), 1);
    }
    return out;
  };
  Photographs opaque(1, source);
  opaque.load(1);
  CHECK_FALSE(opaque.transparent());
  const Image image = opaque.before(0, glm::vec3(1));
  for (std::size_t i = 0; i < 256; ++i) {
    CHECK(image.pixels[i].y == static_cast<float>(i) / 255);
  }
  Photographs through = photographs_of(scene(), 2);
  through.load(2);
  CHECK(through.transparent());
  CHECK(through.camera(0).width == 32);
}

}  // namespace
}  // namespace sgs::test
