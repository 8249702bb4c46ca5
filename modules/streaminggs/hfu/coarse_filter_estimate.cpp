// Fetching of slices.
#include "modules/streaminggs/hfu/coarse_filter_estimate.h"

namespace sgs {

CoarseFilterEstimate::CoarseFilterEstimate(const HfuConfig& config, const CoarseFilter& unit,
                                           const RecordArray& first_halves,
                                           const PortEstimate& port)
    : config_(config),
      depth_cycles_(config.cfu_depth_cycles),
      turns_(unit.tests(), unit.with_cfus()),
      copies_(unit.tests().copies),
      first_halves_(first_halves),
      port_(port),
      slots_(config.input_slots),
      slices_(config.input_slots) {}

std::uint64_t CoarseFilterEstimate::fetch(std::uint32_t group, std::uint32_t first,
                                          std::uint32_t count) {
  port_.charge_to(group);
  const auto [sent, answered] =
      port_.read(load_, first_halves_.address(first), count * first_halves_.record_bytes,
                 first_halves_.region);
  load_ = sent;
  work_.counters.first_halves += count;
  return answered;
}

}  // namespace sgs
