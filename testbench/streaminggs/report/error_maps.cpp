// Which two pictures each map compares, and its caption.
#include "testbench/streaminggs/report/error_maps.h"

#include <fmt/format.h>

#include "algorithm/image/error_map.h"

namespace sgs {
namespace {

Image loss_map(const Image& with, const Image& without, const std::string& title, double share) {
  return error_map(with, without,
                   {title, fmt::format("{:.1f} % OF", 100 * share), "SQUARED ERROR"});
}

}  // namespace

std::vector<ErrorMap> error_maps(const ViewResult& view) {
  std::vector<ErrorMap> maps;
  maps.push_back({"error.png", error_map(view.frame, view.reference, {"ERROR"})});
  const OrderLoss loss = view.order_loss.value_or(OrderLoss{});
  if (view.golden.missed > 0) {
    maps.push_back({"missed.png", loss_map(loss.in_order, view.decoded_reference, "MISSED SPLATS",
                                           loss.missed.share)});
  }
  if (view.golden.misordered > 0) {
    maps.push_back({"misordered.png",
                    loss_map(loss.exactly, loss.in_order, "MISORDERED", loss.misordered.share)});
  }
  return maps;
}

}  // namespace sgs
