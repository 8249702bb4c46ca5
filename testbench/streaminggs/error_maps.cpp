// Which two pictures each map compares, and its caption.
#include "testbench/streaminggs/error_maps.h"

#include <fmt/format.h>

#include <string>

#include "algorithm/image/error_map.h"
#include "algorithm/image/image_io.h"

namespace sgs {
namespace {

void write_loss_map(const std::filesystem::path& path, std::uint64_t lost, const Image& with,
                    const Image& without, const std::string& title, double share) {
  std::filesystem::remove(path);
  if (lost == 0) return;
  write_image(
      path.string(),
      error_map(with, without, {title, fmt::format("{:.1f} % OF", 100 * share), "SQUARED ERROR"}));
}

}  // namespace

void write_error_maps(const std::filesystem::path& folder, const ViewResult& view) {
  write_image((folder / "error.png").string(), error_map(view.frame, view.reference, {"ERROR"}));
  const StreamingStats& stats = view.golden.stats;
  const OrderLoss loss = view.order_loss.value_or(OrderLoss{});
  write_loss_map(folder / "missed.png", stats.missed, loss.in_order, view.decoded_reference,
                 "MISSED SPLATS", loss.missed.share);
  write_loss_map(folder / "misordered.png", stats.misordered, view.golden.frame.image,
                 loss.in_order, "MISORDERED", loss.misordered.share);
}

}  // namespace sgs
