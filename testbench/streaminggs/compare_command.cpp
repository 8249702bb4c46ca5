// streaminggs compare A B
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "algorithm/image/image_io.h"
#include "algorithm/image/quality.h"
#include "testbench/streaminggs/commands.h"

namespace sgs {

SubCommand add_compare_command(CLI::App& app, const Kinds&) {
  struct Arguments {
    std::string a, b;
    bool exact = false;
  };
  auto arguments = std::make_shared<Arguments>();
  app.add_option("A", arguments->a, "image: .exr, .pfm or .png")->required();
  app.add_option("B", arguments->b, "image: .exr, .pfm or .png")->required();
  app.add_flag("--exact", arguments->exact, "exit with status 1 when a pixel differs");
  return [arguments] {
    const Image a = read_image(arguments->a), b = read_image(arguments->b);
    const double error = max_abs_error(a, b);
    fmt::print("psnr_db {:.4f}\nssim {:.6f}\nmax_abs_error {:.6g}\n", psnr_db(a, b), ssim(a, b),
               error);
    return arguments->exact && error > 0 ? 1 : 0;
  };
}

}  // namespace sgs
