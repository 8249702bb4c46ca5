// The memory's accounts: what every command adds, and the counts and energy up to a moment.
#include <fmt/format.h>

#include <algorithm>

#include "modules/dram/dram_controller.h"

namespace sgs {

DramController::Commands::Commands(const Memspec& memspec, const DramConfig& config)
    : activity(memspec, config) {
  counts.channels.resize(config.buses(memspec));
  counts.clock_period_ns = memspec.clock_period_ns;
  counts.peak_gb_per_s = memspec.peak_gb_per_s() * config.buses(memspec);
  counts.burst_bytes = memspec.burst_bytes();
  counts.burst_cycles = memspec.burst_cycles();
}

void DramController::Commands::on_command(const CommandRecord& record) {
  DramChannelStats& channel = counts.channels[record.channel];
  ++channel.commands[static_cast<std::size_t>(record.command)];
  if (is_read(record.command) || is_write(record.command)) {
    channel.busy_cycles += counts.burst_cycles;
    ++counts.bursts_by_region[record.region][is_write(record.command) ? 1 : 0];
  }
  activity.on_command(record);
  for (CommandSink* other : others_) other->on_command(record);
}

void DramController::Commands::remove(CommandSink& sink) {
  others_.erase(std::remove(others_.begin(), others_.end(), &sink), others_.end());
}

std::uint64_t DramController::accounted_until() const {
  // Annotated delays may reach beyond the kernel's time; commands then lie in the future.
  return std::max(now(), transport_ == Transport::kBlocking ? busy_until_ : 0);
}

void DramController::catch_up() {
  const std::uint64_t cycle = accounted_until();
  for (Channel& channel : channels_) {
    if (transport_ == Transport::kBlocking)
      channel.arrival_order.finish(cycle);
    else
      channel.queued.advance(cycle);
  }
}

DramStats DramController::stats() {
  catch_up();
  const bool blocking = transport_ == Transport::kBlocking;
  const std::uint64_t cycle = accounted_until();
  DramStats stats = commands_.counts;
  stats.elapsed_cycles = cycle;
  if (open_transactions_ > 0) stats.busy_cycles += cycle - busy_from_;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    stats.channels[c].rows =
        blocking ? channels_[c].arrival_order.rows() : channels_[c].queued.rows();
    stats.forwarded_reads += channels_[c].queued.forwarded_reads();
  }
  stats.ranks = commands_.activity.ranks(cycle);
  stats.energy = dram_energy_band(memspec_, config_, stats.ranks, commands_.activity.regions());
  return stats;
}

void DramController::trace(sc_core::sc_trace_file* file) const {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const RowCounts& rows = channels_[c].queued.rows();
    const std::string channel = fmt::format("{}.channel{}", name(), c);
    sc_core::sc_trace(file, rows.bursts[0], channel + ".row_hits");
    sc_core::sc_trace(file, rows.bursts[1], channel + ".row_misses");
    sc_core::sc_trace(file, rows.bursts[2], channel + ".row_conflicts");
  }
}

}  // namespace sgs
