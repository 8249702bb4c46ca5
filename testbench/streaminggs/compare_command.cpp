// streaminggs compare A B
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>

#include "algorithm/files/input_error.h"
#include "algorithm/image/image_io.h"
#include "algorithm/image/quality.h"
#include "testbench/streaminggs/commands.h"

namespace sgs {
namespace {

// Nothing can be said of the distance to a pixel that is no colour.
Image read_finite(const std::string& path) {
  Image image = read_image(path);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const glm::vec3& p = image.at(x, y);
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
      throw InputError(fmt::format("{}: pixel ({}, {}): got ({}, {}, {}), expected finite numbers",
                                   path, x, y, p.x, p.y, p.z));
    }
  }
  return image;
}

}  // namespace

SubCommand add_compare_command(CommandLine& line, const Kinds&) {
  struct Arguments {
    std::string a, b;
    bool exact = false;
  };
  auto arguments = std::make_shared<Arguments>();
  line.text("A", arguments->a, "image: .exr, .pfm or .png", Given::kAlways);
  line.text("B", arguments->b, "image: .exr, .pfm or .png", Given::kAlways);
  line.flag("--exact", arguments->exact, "exit with status 1 when a pixel differs");
  return [arguments] {
    const Image a = read_finite(arguments->a), b = read_finite(arguments->b);
    if (a.width != b.width || a.height != b.height) {
      throw InputError(fmt::format("{}: got {}x{} px, expected the {}x{} of {}", arguments->b,
                                   b.width, b.height, a.width, a.height, arguments->a));
    }
    const double error = max_abs_error(a, b);
    fmt::print("psnr_db {:.4f}\nssim {:.6f}\nmax_abs_error {:.6g}\n", psnr_db(a, b), ssim(a, b),
               error);
    return arguments->exact && error > 0 ? 1 : 0;
  };
}

}  // namespace sgs
