// Reading the CSV and comparing.
#include "tests/algorithm/render/against_golden.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <numeric>
#include <sstream>
#include <vector>

#include "algorithm/render/reference_renderer.h"

namespace sgs::test {
namespace {

struct GoldenLine {
  int view, x, y;
  double r, g, b, t;
  std::uint64_t contributors;
};

std::vector<GoldenLine> lines_of_view(const std::string& path, int view) {
  std::ifstream file(path);
  std::string text;
  std::vector<GoldenLine> lines;
  while (std::getline(file, text)) {
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream fields(text);
    GoldenLine line{};
    fields >> line.view >> line.x >> line.y >> line.r >> line.g >> line.b >> line.t >>
        line.contributors;
    if (fields && line.view == view) lines.push_back(line);
  }
  return lines;
}

double clamped(double value) { return std::clamp(value, 0.0, 1.0); }

}  // namespace

void check_against_golden(const std::string& path, const Camera& camera,
                          const ActivatedCloud& cloud) {
  const RenderResult result = render_reference(make_view<float>(camera), cloud);
  const auto total =
      std::accumulate(result.contributors.begin(), result.contributors.end(), std::uint64_t{0});
  double squares = 0, golden_total = 0;
  int pixels = 0, within = 0, contributors_differ = 0;
  for (const GoldenLine& line : lines_of_view(path, camera.id)) {
    if (line.x < 0) {
      golden_total = static_cast<double>(line.contributors);
      glm::dvec3 mean(0);
      for (const auto& pixel : result.image.pixels) mean += pixel;
      mean /= static_cast<double>(result.image.pixels.size());
      CHECK(mean.x == Approx(line.r).margin(1e-5));
      CHECK(mean.y == Approx(line.g).margin(1e-5));
      CHECK(mean.z == Approx(line.b).margin(1e-5));
      continue;
    }
    ++pixels;
    const glm::vec3& at = result.image.at(line.x, line.y);
    const auto index = static_cast<std::size_t>(line.y) * camera.width + line.x;
    const double error[3] = {at.x - line.r, at.y - line.g, at.z - line.b};
    bool close = std::abs(result.transmittance[index] - line.t) <= 1e-4;
    for (const double e : error) close = close && std::abs(e) <= 1e-4;
    within += close;
    contributors_differ += result.contributors[index] != line.contributors;
    squares += std::pow(clamped(at.x) - clamped(line.r), 2) +
               std::pow(clamped(at.y) - clamped(line.g), 2) +
               std::pow(clamped(at.z) - clamped(line.b), 2);
  }
  REQUIRE(pixels == 1500);
  REQUIRE(golden_total > 0);
  const double psnr = -10 * std::log10(squares / (3 * pixels));
  const double drift = (static_cast<double>(total) - golden_total) / golden_total;
  fmt::print(
      "{} view {}: {:.1f} dB, {:.2f} % of pixels within 1e-4, contributors {} ({:+.5f} %), "
      "differing at {} pixels\n",
      path.substr(path.rfind('/') + 1), camera.id, psnr, 100.0 * within / pixels, total,
      100 * drift, contributors_differ);
  CHECK(psnr >= 65);
  CHECK(within >= 0.997 * pixels);
  CHECK(std::abs(drift) <= 1e-3);
}

}  // namespace sgs::test
