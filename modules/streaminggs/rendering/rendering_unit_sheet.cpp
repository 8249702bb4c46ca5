// Data sheet of the rendering unit: its on-chip memories, counters and costs.
#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "algorithm/memory/splat_record.h"
#include "modules/datapath/rendering_flows.h"
#include "modules/datapath/selection.h"
#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/pipeline_depths.h"
#include "modules/streaminggs/rendering/rendering_unit.h"

namespace sgs {
namespace {

constexpr std::uint32_t kSubtileNumberBytes = 2;
constexpr std::uint32_t kFinishedBytes = kSubtilePixels / 8;  // of a sub-tile, a bit a pixel
constexpr std::uint32_t kFinishedBits = 1;                    // of a memory, as of a pixel
constexpr const char *kBegunSpans = "begun spans", *kFinishedPixels = "finished pixels";
constexpr std::uint32_t kBegunSpanBytes = 4 * kBegunSpanWords;

// Spans: the first and the last sub-tile of each row that a splat reaches, or none. Rows that leave
// the lanes at once lie each in a bank of its own; a row a cycle goes to the dispatcher.
SramUse spans_use(const RenderingConfig& config, const PixelSize& group) {
  const auto rows = static_cast<std::uint32_t>((group.height + kSubtilePx - 1) / kSubtilePx);
  const auto columns = static_cast<std::uint32_t>((group.width + kSubtilePx - 1) / kSubtilePx);
  std::uint32_t bits = 1;
  while ((1U << bits) < columns) ++bits;
  const std::uint32_t at_once = std::min(config.spans_at_once(), std::max(1U, rows));
  return sram_use("spans", kSharedSram,
                  {{config.span_slots, "slots"}, {(rows * 2 * bits + 7) / 8, "B"}},
                  {2 * bits, SramPorts::kReadAndWrite, at_once}, {1, at_once});
}

// Adders of the dispatcher that find each cluster's first sub-tile in the rest of a row: x & -x of
// its bits.
std::uint32_t row_adders(const PixelSize& group, std::uint32_t clusters) {
  constexpr std::uint64_t kAdderBits = 32;
  const auto columns = cycles_for(static_cast<std::uint64_t>(group.width), kSubtilePx);
  return clusters * static_cast<std::uint32_t>(cycles_for(columns, kAdderBits));
}

// Sub-tiles of a group from left to right, or from top to bottom.
std::uint64_t subtiles_of(int pixels) {
  return cycles_for(static_cast<std::uint64_t>(pixels), kSubtilePx);
}

// Adders that divide a number up to `most` by the clusters: one subtracts for each bit of the
// quotient. A power of two shifts.
std::uint32_t division_adders(std::uint64_t most, std::uint32_t clusters) {
  if ((clusters & (clusters - 1)) == 0) return 0;
  return counter_bits(most / clusters);
}

// Of a row that goes out: its first cluster, 2 y.
std::uint32_t row_division_adders(const PixelSize& group, std::uint32_t clusters) {
  return division_adders(2 * (subtiles_of(group.height) - 1), clusters);
}

// Of a sub-tile, among those of the group row by row: the quotient says where it lies in its bank.
// No two meet there, and no row is left free, where a row has two more than a multiple of the
// clusters, as 32 of five. The remainder is then that of x + 2 y, whose it is.
std::uint32_t subtile_division_adders(const PixelSize& group, std::uint32_t clusters) {
  return division_adders(subtiles_of(group.width) * subtiles_of(group.height) - 1, clusters);
}

// Masks of a row that a cluster's sub-tiles may have, by 2 y.
std::uint32_t row_masks(std::uint32_t clusters) { return clusters / std::gcd(2U, clusters); }

// Sub-tiles of a row that finished pixels come from at once.
std::uint64_t drained_at_once(const RenderingConfig& config) {
  return cycles_for(config.drain_pixels_per_cycle, kSubtilePx);
}

std::uint32_t subtiles_of(const PixelSize& group) {
  return static_cast<std::uint32_t>(subtiles_of(group.width) * subtiles_of(group.height));
}

// A group that drains and one that is blended have memories of their own, in each cluster that has
// a sub-tile of any group.
std::uint32_t cluster_banks(const RenderingConfig& config, const PixelSize& group) {
  return std::clamp(subtiles_of(group), 1U, config.clusters) * config.pixel_buffers;
}

// One for each place of a pixel in a sub-tile: a blend reads and writes all 16 of a sub-tile at
// once, each its pixel.
std::uint32_t pixel_banks(const RenderingConfig& config, const PixelSize& group) {
  return kSubtilePixels * cluster_banks(config, group);
}

// Memories that one of the pixels which are converted at once may come from: those of the clusters
// and columns that its place meets, any row of them, in each buffer.
std::uint64_t drain_sources(const RenderingConfig& config, const PixelSize& group) {
  const auto at_once = static_cast<int>(config.drain_pixels_per_cycle);
  std::size_t most = 0;
  for (int place = 0; place < std::min(at_once, group.width); ++place) {
    std::set<std::pair<std::size_t, int>> met;
    for (int x = place; x < group.width; x += at_once) {
      for (int y = 0; y < group.height; y += kSubtilePx) {
        met.insert({cluster_at(x / kSubtilePx, y / kSubtilePx, config.clusters), x % kSubtilePx});
      }
    }
    most = std::max(most, met.size());
  }
  return most * kSubtilePx * config.pixel_buffers;
}

}  // namespace

SramUses RenderingUnit::sram_uses(const RenderingConfig& config, const BuiltFor& built_for) {
  const auto width = static_cast<std::uint32_t>(built_for.group.width);
  const auto height = static_cast<std::uint32_t>(built_for.group.height);
  const std::uint32_t banks = pixel_banks(config, built_for.group);
  const std::uint32_t writes_beside = config.ports_of_pixels() == SramPorts::kOne ? 0 : banks;
  const SramPeak of_clusters{config.clusters, config.clusters};
  return {sram_use("pixel state", kSharedSram,
                   {{config.pixel_buffers, "groups"},
                    {width, "px"},
                    {height, "px"},
                    {config.pixel_state_bytes(), "B"}},
                   {8 * config.pixel_state_bytes(), config.ports_of_pixels(), banks},
                   {banks, writes_beside}),
          // Each place's read a cycle ahead of its pixel, which has a cycle of its own.
          sram_use(kFinishedPixels, kSharedSram,
                   {{config.pixel_buffers, "groups"},
                    {std::max(subtiles_of(built_for.group), 1U), "sub-tiles"},
                    {kFinishedBytes, "B"}},
                   {kFinishedBits, SramPorts::kReadAndWrite, banks}, {banks, banks}),
          sram_use("splats under way", kSharedSram,
                   {{config.span_slots, "slots"}, {kSplatEntryBytes, "B"}}, {8 * kSplatEntryBytes},
                   kOneOfEach),
          sram_use(kBegunSpans, kSharedSram, {{config.span_slots, "slots"}, {kBegunSpanBytes, "B"}},
                   {8 * kBegunSpanBytes}, kOneOfEach),
          spans_use(config, built_for.group),
          sram_use("cluster queues", kSharedSram,
                   {{config.clusters, "clusters"},
                    {config.cluster_queue_entries, "splats"},
                    {kSplatEntryBytes, "B"}},
                   {8 * kSplatEntryBytes, SramPorts::kReadAndWrite, config.clusters}, of_clusters),
          mask_use(built_for.group), outstanding_table(kSharedSram, built_for.memory_port),
          sram_use("sub-tiles in the loop", kSharedSram,
                   {{config.clusters, "clusters"},
                    {config.subtiles_in_loop(), "sub-tiles"},
                    {kSubtileNumberBytes, "B"}},
                   {8 * kSubtileNumberBytes * config.subtiles_in_loop(), SramPorts::kReadAndWrite,
                    config.clusters},
                   of_clusters),
          unanswered_writes("pixel writes", kSharedSram, built_for.memory_port,
                            width * pixel_bytes(built_for.frame_format))};
}

void RenderingUnit::publish_ledger(DataSheet& sheet) {
  const ClusterSchedule::Counters& clusters = schedule_.counters();
  const bool in_half = in_16_bits(config_.precision);
  if (built_for_.splats == NumberFormat::kHalf) {
    sheet.datapath(terms_pipeline(built_for_.single), counters_.splats_taken);
  }
  sheet.datapath(conic_pipeline(config_, built_for_.single), counters_.splats_taken);
  sheet.datapath(blend_pipeline(config_, in_half ? built_for_.half : built_for_.single),
                 clusters.subtile_blends);
  sheet.datapath(begin_pipeline(config_, built_for_.single), counters_.splats_spanned);
  sheet.datapath(span_pipeline(config_, built_for_.single), counters_.spans);
  sheet.accesses(kBegunSpans, counters_.begun_span_reads, counters_.splats_spanned);
  sheet.accesses("splats under way", counters_.splats_taken, counters_.splats_taken);
  sheet.accesses("spans", counters_.spans, counters_.spans);
  sheet.accesses("cluster queues", clusters.subtile_blends, clusters.subtile_blends);
  publish_dispatcher(sheet);
  publish_pixels(sheet);
  sheet.port(memory, "pixel writes");
}

void RenderingUnit::publish_dispatcher(DataSheet& sheet) {
  const ClusterSchedule::Counters& clusters = schedule_.counters();
  // When a splat is taken, all rows are asked at once whether its footprint is finished.
  const std::uint64_t dropped = counters_.splats_hidden + counters_.splats_saturated;
  const double of_splat = mask_comparators(built_for_.group);
  const double of_row = row_adders(built_for_.group, config_.clusters);
  // The head of a queue against all sub-tiles in the loop, in every cycle that it is looked at.
  const double of_loop = config_.subtiles_in_loop();
  // A sub-tile whose pixels are asked for against the one that finishes some meanwhile.
  constexpr double kPastFinished = 1;
  // The splat whose rows go out.
  sheet.part("rendering", "register_bit", 8 * kSplatEntryBytes, 1);
  sheet.operations("rendering", "register_bit",
                   8 * kSplatEntryBytes * static_cast<double>(counters_.splats_taken));
  const auto looks = clusters.subtile_blends + clusters.hazard_cycles;
  sheet.part("rendering", "comparator", of_splat + config_.clusters * (of_loop + kPastFinished), 1);
  sheet.operations("rendering", "comparator",
                   of_splat * static_cast<double>(counters_.splats_taken + dropped) +
                       of_loop * static_cast<double>(looks) +
                       kPastFinished * static_cast<double>(clusters.subtile_blends));
  sheet.part("rendering", "adder", of_row, 1);
  sheet.operations("rendering", "adder", of_row * static_cast<double>(clusters.row_cycles));
  const double of_first = row_division_adders(built_for_.group, config_.clusters);
  const double of_subtile = subtile_division_adders(built_for_.group, config_.clusters);
  // Which of the masks is whose: the row's first cluster is taken from each, round the last.
  const double of_masks = of_first > 0 ? config_.clusters : 0;
  sheet.part("rendering", "adder", of_first + of_masks + config_.clusters * of_subtile, 1);
  sheet.operations("rendering", "adder",
                   (of_first + of_masks) * static_cast<double>(clusters.rows) +
                       of_subtile * static_cast<double>(clusters.subtile_blends));
  publish_selection(
      sheet, "rendering",
      {row_masks(config_.clusters), static_cast<double>(subtiles_of(built_for_.group.width)),
       static_cast<double>(config_.clusters)},
      static_cast<double>(clusters.rows) * config_.clusters);
  const std::uint64_t bits = mask_bits(built_for_.group);
  sheet.accesses("finished sub-tiles",
                 bits * (dropped + counters_.splats_taken + clusters.row_cycles),
                 clusters.finished + bits * counters_.groups);
  sheet.accesses("sub-tiles in the loop", looks, clusters.subtile_blends);
}

// Of a sub-tile each blend reads the unfinished pixels whose alpha passes, and writes those that it
// does not finish. Draining reads it once for each row of pixels, and clears it.
void RenderingUnit::publish_pixels(DataSheet& sheet) {
  std::uint64_t drained = 0, cleared = 0, pixels = 0;
  for (std::uint64_t group = 0; group < counters_.groups; ++group) {
    const PixelRect& px = job_.groups[group];
    const auto width = static_cast<std::uint64_t>(px.width());
    const auto height = static_cast<std::uint64_t>(px.height());
    drained += height * cycles_for(width, kSubtilePx);
    cleared += cycles_for(height, kSubtilePx) * cycles_for(width, kSubtilePx);
    pixels += width * height;
  }
  const std::uint64_t blends = schedule_.counters().subtile_blends;
  const std::uint64_t blended = counters_.contributors;
  const Datapath blend =
      blend_pipeline(config_, in_16_bits(config_.precision) ? built_for_.half : built_for_.single);
  if (const auto held = pixel_writes(blend, config_.ports_of_pixels()).held; held > 0) {
    // A pixel's new state waits for the port.
    const double bits = 8.0 * config_.pixel_state_bytes() * held;
    sheet.part("rendering", "register_bit", bits * config_.clusters, 1);
    sheet.operations("rendering", "register_bit",
                     bits / kSubtilePixels * static_cast<double>(blended));
  }
  const auto passed = static_cast<double>(pixels);
  publish_selection(sheet, "rendering",
                    {drain_sources(config_, built_for_.group), 8.0 * config_.pixel_state_bytes(),
                     static_cast<double>(config_.drain_pixels_per_cycle)},
                    passed);
  const double of_drained = subtile_division_adders(built_for_.group, config_.clusters);
  sheet.part("rendering", "adder", of_drained * static_cast<double>(drained_at_once(config_)), 1);
  sheet.operations("rendering", "adder", of_drained * static_cast<double>(drained));
  // The row of converted pixels that is written next.
  const double bits_of_pixel = 8.0 * pixel_bytes(job_.frame_format);
  sheet.part("rendering", "register_bit", built_for_.group.width * bits_of_pixel, 1);
  sheet.operations("rendering", "register_bit", bits_of_pixel * passed);
  sheet.datapath(drain_pipeline(config_, job_.frame_format, built_for_.single), pixels);
  // Draining reads the places of a row, clearing writes all.
  sheet.accesses("pixel state", blended + finished_pixels_ + kSubtilePx * drained,
                 blended + kSubtilePixels * cleared);
  sheet.accesses(kFinishedPixels, kSubtilePixels * blends,
                 finished_pixels_ + kSubtilePixels * cleared);
}

void RenderingUnit::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(blend_, "rendering", "blends sorted splats into the pixels of a group");
  sheet.activity(drain_, "drain", "writes finished pixels");
  sheet.counters(counters_);
  sheet.counters(schedule_.counters());
  const ClusterSchedule::Counters& clusters = schedule_.counters();
  sheet.by_part("cycles", "cycles", "of rendering, from the end of the group before",
                cycles_of_groups_);
  publish_ledger(sheet);
  // Begin lanes, span lanes and clusters are busy at the same time, on different splats.
  const bool by_rows = clusters.span_cycles > clusters.begin_cycles;
  const char* lanes = by_rows ? "rendering.span_lanes" : "rendering.begin_lanes";
  const bool by_lanes =
      std::max(clusters.span_cycles, clusters.begin_cycles) > schedule_.cluster_cycles();
  sheet.remedy(blend_, by_lanes ? lanes : "rendering.clusters");
  for (const char* key : {"rendering.clusters", "rendering.cluster_lanes", "rendering.begin_lanes",
                          "rendering.span_lanes", "rendering.span_slots"}) {
    sheet.may_help(key);
  }
  sheet.remedy(drain_, "rendering.drain_pixels_per_cycle");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.sram(sram_uses(config_, built_for_));
  sheet.queue(finished_, "pixel state");
  sheet.remedy(finished_, WaitFor::kRoom, "rendering.pixel_buffers");
  sheet.remedy(free_buffers_, WaitFor::kRoom, "rendering.pixel_buffers");
  sheet.signal("group", current_group_);
}

}  // namespace sgs
