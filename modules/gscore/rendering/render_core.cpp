// The three threads of a rendering core.
#include "modules/gscore/rendering/render_core.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "algorithm/render/tile_renderer.h"
#include "modules/datapath/selection.h"
#include "modules/datapath/work_rates.h"
#include "modules/gscore/gscore_datapaths.h"
#include "tlm/row_writer.h"

namespace sgs::gscore {
namespace {

constexpr const char *kRecordSlots = "records", *kFetchedEntries = "fetched entries",
                     *kPixels = "pixel state", *kPixelWrites = "pixel writes",
                     *kMask = "finished parts", *kFinishedPixels = "finished pixels";
constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint32_t kReadCycles = 1, kWriteCycles = 1;
constexpr std::uint32_t kTilePixels = kTilePx * kTilePx;
constexpr std::uint32_t kFinishedBytes = kSubtilePixels / 8;  // of a block, a bit a pixel
constexpr std::uint32_t kFinishedBits = 1;                    // of a memory, as of a pixel

// R, G, B and transmittance.
std::uint32_t state_bytes(const GscoreConfig& config) {
  return in_16_bits(config.rendering.precision) ? 8 : 16;
}

// Memories of one place of a pixel.
std::uint32_t memories_of_place(const GscoreConfig& config) {
  return shares_pixel_memories(config) ? 1 : config.rendering.pixel_buffers;
}
// A blend reads and writes 16 pixels at once, each in the memory of its place.
std::uint32_t pixel_banks(const GscoreConfig& config) {
  return kSubtilePixels * memories_of_place(config);
}

std::uint32_t parts_of(const GscoreConfig& config) {
  return static_cast<std::uint32_t>(config.tiles.subtiles_across * config.tiles.subtiles_across);
}

GroupReach reach_of(std::size_t block) {
  const auto x = static_cast<std::uint8_t>(block % kSubtilesPerTile);
  const auto y = static_cast<std::uint8_t>(block / kSubtilesPerTile);
  return {x, y, x, y};
}

// The blocks of 16 px of a part, row by row.
template <class Visit>
void for_each_block(int part, const TileRules& rules, const Visit& visit) {
  const int side = kSubtilesPerTile / rules.subtiles_across;
  const int x = part % rules.subtiles_across * side, y = part / rules.subtiles_across * side;
  for (int b = 0; b < side * side; ++b) {
    visit(static_cast<std::size_t>((y + b / side) * kSubtilesPerTile + x + b % side));
  }
}

}  // namespace

RenderCore::RenderCore(const sc_core::sc_module_name& name, const UnitContext& context,
                       FinishedTiles& finished)
    : sc_module(name),
      record_memory("record_memory", context.config.memory_port, context.clock.period()),
      pixel_memory("pixel_memory", context.config.memory_port, context.clock.period()),
      config_(context.config),
      job_(context.job),
      finished_(finished),
      conic_path_(conic_pipeline(config_)),
      corner_path_(corner_pipeline(config_)),
      blend_path_(blend_pipeline(config_)),
      drain_path_(drain_pipeline(config_)),
      pixel_writes_(pixel_writes(blend_path_, ports_of_pixels(config_))),
      record_bytes_(record_bytes(config_.tiles.features)),
      fetch_("fetch", context.clock),
      blend_("blend", context.clock),
      drain_("drain", context.clock),
      records_(std::size_t{config_.rendering.record_slots} * record_bytes_),
      fetched_("fetched", context.clock, config_.rendering.record_slots + 1),
      free_records_("free_records", context.clock, config_.rendering.record_slots, 0),
      finished_states_("finished_states", context.clock, config_.rendering.pixel_buffers + 1,
                       static_cast<std::uint32_t>(depth_cycles()) + drain_path_.depth_cycles),
      free_pixels_("free_pixels", context.clock, config_.rendering.pixel_buffers, 0),
      free_from_(kBlocks),
      finished_from_(kBlocks) {
  for (Activity* a : {&fetch_, &blend_, &drain_}) context.phases.drawing.add(*a);
  SC_THREAD(run_fetch);
  SC_THREAD(run_blend);
  SC_THREAD(run_drain);
}

// The conic is wanted behind the corner's subtractions.
std::uint64_t RenderCore::depth_cycles() const {
  const std::uint32_t conic = conic_path_ ? conic_path_->depth_cycles : 0;
  return std::max(conic, corner_path_.depth_cycles) + blend_path_.depth_cycles +
         pixel_writes_.wait_cycles + kReadCycles + kWriteCycles;
}

void RenderCore::run_fetch() {
  for (std::uint32_t s = 0; s < config_.rendering.record_slots; ++s) free_records_.push(s, fetch_);
  for (EntryMark mark = EntryMark::kEntry; mark != EntryMark::kEndOfFrame;) {
    Fetched next;
    next.entry = sorted->pop(fetch_);
    mark = next.entry.mark;
    if (of_tile(mark)) fetch_.takes_up_tile(next.entry.tile);
    if (mark == EntryMark::kEntry && finished_.finished(next.entry.tile)) {
      fetch_.work(1);
      ++counters_.dropped;
      continue;
    }
    if (mark == EntryMark::kEntry) next.slot = free_records_.pop(fetch_, WaitFor::kRoom);
    fetch_.work(1);
    if (mark == EntryMark::kEntry) {
      next.ticket =
          start_read(record_memory, fetch_, job_.record_address(next.entry.set, next.entry.record),
                     records_.data() + std::size_t{next.slot} * record_bytes_, record_bytes_,
                     job_.projected.region);
      ++counters_.records;
    }
    fetched_.push(next, fetch_);
  }
  fetch_.idles();
}

// A mark goes through the pipeline as a block does, in its cycle.
void RenderCore::run_blend() {
  for (EntryMark mark = EntryMark::kEntry; mark != EntryMark::kEndOfFrame;) {
    const Fetched next = fetched_.front(blend_);
    mark = next.entry.mark;
    if (mark == EntryMark::kEndOfPass || mark == EntryMark::kEndOfFrame) {
      fetched_.remove_front();
      finished_states_.push({mark, nullptr, 0}, blend_);
      blend_.work(1);
      continue;
    }
    if (!in_tile_) begin_tile(next.entry.tile);
    if (mark == EntryMark::kEntry) {
      take(next);
      continue;
    }
    fetched_.remove_front();
    ++counters_.tiles;
    counters_.tiles_finished += state_->saturated() ? 1 : 0;
    counters_.contributors += state_->contributors();
    finished_pixels_ += state_->finished_pixels();
    in_tile_ = false;
    finished_states_.push({mark, std::move(state_), next.entry.tile}, blend_);
    blend_.work(1);
  }
  blend_.idles();
}

// Blocks outside the frame are finished from the start.
void RenderCore::begin_tile(std::uint32_t tile) {
  blend_.takes_up_tile(tile);
  free_pixels_.pop(blend_, WaitFor::kRoom);
  in_tile_ = true;
  tile_ = tile;
  const PixelRect pixels = job_.pixels(tile);
  state_ = std::make_shared<GroupState>(pixels, job_.view.width, job_.view.height,
                                        config_.rendering.precision, SubtileTest::kBox);
  std::fill(free_from_.begin(), free_from_.end(), 0);
  for (std::size_t block = 0; block < kBlocks; ++block) {
    finished_from_[block] = state_->any_unfinished(reach_of(block)) ? kNever : 0;
  }
}

// An entry stays where it is until its turn.
void RenderCore::take(const Fetched& next) {
  await(record_memory, blend_, next.ticket);
  if (finished_.finished(next.entry.tile)) {
    ++counters_.dropped_fetched;
    fetched_.remove_front();
    blend_.work(1);
  } else {
    wait_for_turn(blend_, blend_path_.interval_cycles());
    fetched_.remove_front();
    with_record(config_.tiles.features, config_.rendering.precision,
                records_.data() + std::size_t{next.slot} * record_bytes_, next.entry.opacity,
                [&](const auto& splat) { blend(next.entry, splat); });
  }
  free_records_.push(next.slot, blend_);
}

// Blends a splat whose turn it is.
template <class AnySplat>
void RenderCore::blend(const SortedEntry& entry, const AnySplat& splat) {
  const std::uint64_t now = blend_.clock().now_cycles();
  ++counters_.splats;
  const TileRules rules = config_.tiles.rules();
  const std::uint64_t interval = blend_path_.interval_cycles();
  const std::uint64_t loop = pixel_writes_.loop_cycles + kReadCycles + kWriteCycles;
  const std::uint64_t depth = depth_cycles();
  std::uint64_t begin = now;
  const auto left_out = [&](std::uint64_t known) {
    return known <= now && (config_.rendering.skip_finished || known == 0);
  };
  for_each_part(rules, job_.tile_x(entry.tile), job_.tile_y(entry.tile), entry.bitmap, splat,
                [&](const AnySplat& in_part, int part) {
                  if (left_out(finished_from(part))) {
                    ++counters_.parts_finished;
                    return;
                  }
                  ++counters_.parts;
                  for_each_block(part, rules, [&](std::size_t at) {
                    if (left_out(finished_from_[at])) {
                      ++counters_.blocks_finished;
                      return;
                    }
                    const std::uint64_t free = next_turn(std::max(begin, free_from_[at]), interval);
                    counters_.hazard_cycles += free - begin;
                    free_from_[at] = free + loop;
                    begin = free + interval;
                    ++counters_.blocks;
                  });
                  state_->blend(in_part);
                  for_each_block(part, rules, [&](std::size_t at) {
                    if (finished_from_[at] == kNever && !state_->any_unfinished(reach_of(at)))
                      finished_from_[at] = free_from_[at] - loop + depth;
                  });
                });
  if (state_->saturated()) {
    finished_.finish(entry.tile, *std::max_element(finished_from_.begin(), finished_from_.end()));
  }
  // The conic's lanes keep the pace of whole parts.
  const std::uint64_t least = begin > now && conic_path_ ? conic_path_->interval_cycles() : 1;
  blend_.work(std::max(begin - now, least));
}

std::uint64_t RenderCore::finished_from(int part) const {
  std::uint64_t last = 0;
  for_each_block(part, config_.tiles.rules(),
                 [&](std::size_t at) { last = std::max(last, finished_from_[at]); });
  return last;
}

void RenderCore::run_drain() {
  for (std::uint32_t b = 0; b < config_.rendering.pixel_buffers; ++b) free_pixels_.push(b, drain_);
  for (EntryMark mark = EntryMark::kEndOfTile; mark != EntryMark::kEndOfFrame;) {
    const Finished next = finished_states_.pop(drain_);
    mark = next.mark;
    if (mark == EntryMark::kEndOfTile) {
      drain_.takes_up_tile(next.tile);
      await_buffer(host, job_.frame_of(next.tile), drain_);
      write_tile(*next.state, job_.picture_of(next.tile));
      free_pixels_.push(0, drain_);
      continue;
    }
    await_all(pixel_memory, drain_);
    drain_.work(1);
    done->push({}, drain_);
  }
  drain_.idles();
}

// Each pixel is cleared as it is read.
void RenderCore::write_tile(const GroupState& state, const Picture& picture) {
  const PixelRect& pixels = state.pixels();
  const auto width = static_cast<std::uint32_t>(pixels.width());
  const std::uint32_t bytes = pixel_bytes(job_.frame_format);
  std::vector<std::byte> row(std::size_t{width} * bytes);
  const std::uint64_t row_cycles = drain_row_cycles(config_, width);
  RowWriter rows(pixel_memory, drain_);
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      encode_pixel(job_.frame_format, state.colour(x, y, job_.background),
                   row.data() + static_cast<std::size_t>(x - pixels.x0) * bytes);
    }
    rows.make(row_cycles);
    rows.write(picture.pixel_address(pixels.x0, y), row.data(),
               static_cast<std::uint32_t>(row.size()), picture.frame_buffer.region,
               y + 1 < pixels.y1 ? row_cycles : 0);
    counters_.pixels += width;
  }
}

SramUses RenderCore::sram_uses(const GscoreConfig& c) {
  const std::uint32_t banks = pixel_banks(c), buffers = c.rendering.pixel_buffers;
  const SramPorts ports = ports_of_pixels(c);
  SramUses uses = {
      sram_use(kRecordSlots, kBuffer,
               {{c.rendering.record_slots, "slots"}, {record_bytes(c.tiles.features), "B"}},
               {8 * record_bytes(c.tiles.features)}, kOneOfEach),
      fifo_use<Fetched>(kFetchedEntries, kBuffer, c.rendering.record_slots + 1, "entries",
                        SortedEntry::sram_bytes(c.entries())),
      sram_use(kPixels, kBuffer, {{buffers, "tiles"}, {kTilePixels, "px"}, {state_bytes(c), "B"}},
               {8 * state_bytes(c), ports, banks}, {banks, ports == SramPorts::kOne ? 0 : banks}),
      // Each place's read a cycle ahead of its pixel, which has a cycle of its own.
      sram_use(kFinishedPixels, kBuffer,
               {{buffers, "tiles"}, {kBlocks, "blocks"}, {kFinishedBytes, "B"}},
               {kFinishedBits, SramPorts::kReadAndWrite, banks}, {kSubtilePixels, banks}),
      sram_use(kMask, kBuffer, {{parts_of(c), "parts"}, {1, "B"}}, {8 * parts_of(c)}, kOneOfEach),
      unanswered_writes(kPixelWrites, kBuffer, c.memory_port,
                        kTilePx * pixel_bytes(c.framebuffer))};
  add(uses, outstanding_table(kBuffer, c.memory_port), 2);
  return uses;
}

void RenderCore::publish(DataSheet& sheet) {
  const Counters& n = counters_;
  sheet.unit(*this);
  sheet.activity(fetch_, "record fetch", "asks for records of sorted entries");
  sheet.activity(blend_, "rendering", "blends them into a tile");
  sheet.activity(drain_, "drain", "writes finished pixels");
  sheet.counters(counters_);
  if (conic_path_) sheet.datapath(*conic_path_, n.splats);
  sheet.datapath(corner_path_, n.blocks);
  sheet.datapath(blend_path_, n.blocks);
  sheet.datapath(drain_path_, n.pixels);
  sheet.sram(sram_uses(config_));
  sheet.accesses(kRecordSlots, n.splats + n.dropped_fetched, n.records);
  // A blend reads the unfinished pixels whose alpha passes, and writes those that it does not
  // finish; draining reads and clears all.
  sheet.accesses(kPixels, n.contributors + finished_pixels_ + n.pixels, n.contributors + n.pixels);
  sheet.accesses(kFinishedPixels, kSubtilePixels * n.blocks,
                 finished_pixels_ + kTilePixels * n.tiles);
  // A block whose pixels are asked for against the one that finishes some meanwhile; the next block
  // among those that are left: x & -x of their bits.
  for (const char* part : {"comparator", "adder"}) {
    sheet.part("rendering", part, 1, 1);
    sheet.operations("rendering", part, static_cast<double>(n.blocks));
  }
  if (pixel_writes_.held > 0) {
    // A pixel's new state waits for the port.
    const double bits = 8.0 * state_bytes(config_) * pixel_writes_.held;
    sheet.part("rendering", "register_bit", bits, 1);
    sheet.operations("rendering", "register_bit",
                     bits / kSubtilePixels * static_cast<double>(n.contributors));
  }
  sheet.accesses(kMask, n.splats, n.splats);
  // For each block: a counter of cycles until a splat leaves the loop through its pixels, set when
  // the splat begins; and whether all are finished. For the splat: which of its parts and blocks is
  // next.
  const std::uint32_t loop = pixel_writes_.loop_cycles + kReadCycles + kWriteCycles;
  const std::uint32_t flight_bits = counter_bits(loop), next_bits = counter_bits(kBlocks) + kBlocks;
  sheet.part("rendering", "register_bit", double{kBlocks} * (flight_bits + 1) + next_bits, 1);
  sheet.operations("rendering", "register_bit",
                   static_cast<double>(n.blocks) * static_cast<double>(loop + 1 + next_bits));
  // Each place among the pixels converted at once meets so many of a block's four columns, in any
  // row.
  const std::uint32_t at_once = config_.rendering.drain_pixels_per_cycle;
  const std::uint32_t columns = kSubtilePx / std::gcd(kSubtilePx, at_once);
  publish_selection(sheet, "rendering",
                    {columns * kSubtilePx * memories_of_place(config_), 8.0 * state_bytes(config_),
                     static_cast<double>(at_once)},
                    static_cast<double>(n.pixels));
  // The row of pixels that the drain fills while those before it are unanswered.
  const double bits_of_pixel = 8.0 * pixel_bytes(config_.framebuffer);
  sheet.part("rendering", "register_bit", kTilePx * bits_of_pixel, 1);
  sheet.operations("rendering", "register_bit", bits_of_pixel * static_cast<double>(n.pixels));
  sheet.queue(fetched_, kFetchedEntries);
  sheet.queue(finished_states_, kPixels);
  sheet.port(record_memory);
  sheet.port(pixel_memory, kPixelWrites);
  sheet.left_out("blocks_not_touched", "bits of parts of tiles, or the block was finished",
                 kBlocks * n.splats - n.blocks, "16 fragments each");
  sheet.left_out("records_of_finished_tiles", "their tile finished before they were fetched",
                 n.dropped, "their records");
  sheet.remedy(blend_, "cores");
  sheet.remedy(drain_, "rendering.drain_pixels_per_cycle");
  sheet.remedy(record_memory, WaitFor::kReads, "rendering.record_slots");
  sheet.remedy(record_memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.remedy(pixel_memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.remedy(fetched_, WaitFor::kRoom, "rendering.record_slots");
  sheet.remedy(free_records_, WaitFor::kRoom, "rendering.record_slots");
  sheet.remedy(finished_states_, WaitFor::kRoom, "rendering.pixel_buffers");
  sheet.remedy(free_pixels_, WaitFor::kRoom, "rendering.pixel_buffers");
  sheet.signal("tile", tile_);
}

}  // namespace sgs::gscore
