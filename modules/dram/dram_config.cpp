// Combinations of the memory system's keys that cannot be built.
#include "modules/dram/dram_config.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "modules/dram/address_mapping.h"
#include "modules/dram/memspec.h"

namespace sgs {

std::uint32_t DramConfig::buses(const Memspec& device) const {
  return channels * device.organisation.pseudo_channels;
}

IoEnergy DramConfig::io_pj_per_bit_of(const Memspec& device) const {
  if (io_pj_per_bit) return {*io_pj_per_bit, *io_pj_per_bit, *io_pj_per_bit};
  return {device.least_io_pj_per_bit(), device.io_pj_per_bit, device.most_io_pj_per_bit()};
}

std::uint32_t DramConfig::refreshes_postponed(const Memspec& device) const {
  if (refresh_postpone_max >= 0) return static_cast<std::uint32_t>(refresh_postpone_max);
  const bool device_names_bank =
      refresh != RefreshMode::kPerBank || device.refresh_order == RefreshOrder::kInTurn;
  return device_names_bank ? 0 : device.refresh_postpone_limit;
}

void DramConfig::validate() const {
  const auto refuse = [](const char* key, const std::string& got, const std::string& expected) {
    throw InputError(fmt::format("dram.{}: got {}, expected {}", key, got, expected));
  };
  const auto power_of_two = [&](const char* key, std::uint32_t value) {
    if (value == 0 || (value & (value - 1)) != 0)
      refuse(key, std::to_string(value), "a power of two");
  };
  power_of_two("channels", channels);
  power_of_two("ranks", ranks);
  if (read_queue_entries == 0) refuse("read_queue_entries", "0", "at least 1");
  if (write_high_watermark == 0 || write_high_watermark > write_queue_entries)
    refuse("write_high_watermark", std::to_string(write_high_watermark),
           fmt::format("1 to write_queue_entries {}", write_queue_entries));
  if (write_low_watermark >= write_high_watermark)
    refuse("write_low_watermark", std::to_string(write_low_watermark),
           fmt::format("less than write_high_watermark {}", write_high_watermark));
  if (self_refresh_idle_cycles != 0 && self_refresh_idle_cycles <= power_down_idle_cycles)
    refuse("self_refresh_idle_cycles", std::to_string(self_refresh_idle_cycles),
           fmt::format("0 or more than power_down_idle_cycles {}", power_down_idle_cycles));
  const Memspec device = load_memspec(memspec);
  if (ranks * device.organisation.banks > 64)
    refuse("ranks", std::to_string(ranks),
           fmt::format("at most 64 banks a channel; each rank has {}", device.organisation.banks));
  if (refresh_postpone_max > static_cast<std::int32_t>(device.refresh_postpone_limit))
    refuse("refresh_postpone_max", std::to_string(refresh_postpone_max),
           fmt::format("at most the memspec's refresh_postpone_limit {}",
                       device.refresh_postpone_limit));
  if (!current_set.empty() && device.currents.count(current_set) == 0) {
    std::string known;
    for (const auto& set : device.currents) known += (known.empty() ? "" : ", ") + set.first;
    refuse("current_set", current_set, "one of " + known);
  }
  AddressMapping(*this, device);
}

DramConfig DramConfig::at_rest() const {
  constexpr std::uint32_t kAtOnce = 1;
  DramConfig config = *this;
  if (between_frames == BetweenFrames::kByIdleCycles) return config;
  const bool power_down = between_frames == BetweenFrames::kPowerDown;
  config.power_down_idle_cycles = power_down ? kAtOnce : 0;
  config.self_refresh_idle_cycles = power_down ? 0 : kAtOnce;
  return config;
}

}  // namespace sgs
