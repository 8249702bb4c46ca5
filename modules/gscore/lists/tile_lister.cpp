// Construction of the tile lister, its listing thread, and what it publishes.
#include "modules/gscore/lists/tile_lister.h"

#include <algorithm>

#include "modules/datapath/selection.h"
#include "modules/datapath/work_rates.h"
#include "modules/gscore/gscore_datapaths.h"

namespace sgs::gscore {
namespace {

constexpr const char *kEnds = "ends of lists", *kLines = "lines of lists",
                     *kTags = "tiles of lines", *kWaitingRecords = "records to write",
                     *kListWrites = "list writes", *kTestPasses = "passes to test",
                     *kListed = "listed tiles", *kProjectedPasses = "projected passes",
                     *kTestedRecords = "records under test", *kTestedKeys = "keys under test",
                     *kTestedBoxes = "boxes under test";
// Bytes of a box: its parts along the screen, place and axes along the ellipse, and its limits
// there.
constexpr std::uint32_t kTestedBoxBytes = 4 * 2 + 4 * 4 + 4 * 4;
// Comparators beside the memories: whose line it is, whether line and block are full, whether the
// pool is. Three subtractions of powers of two of the lines give a tile's place among them.
constexpr std::uint32_t kComparators = 4, kAdders = 3;

// Bytes of a line's tag: its tile, the range of its new entries, and its number in the pool, where
// it is written when another tile takes its place.
std::uint32_t tag_bytes(const GscoreConfig& config) {
  const BlockFormat blocks = config.blocks();
  const std::uint64_t lines = std::uint64_t{config.pool_blocks()} * blocks.block_lines;
  const std::uint32_t bits = counter_bits(config.lists.tiles) +
                             2 * counter_bits(blocks.line_entries()) + counter_bits(lines - 1);
  return (bits + 7) / 8;
}

bool has_parts(const GscoreConfig& config) { return config.tiles.subtiles_across > 1; }

// Pipelines that test a tile and its parts.
struct TestPipelines {
  std::uint64_t depth_cycles, part_interval_cycles;
};
TestPipelines test_pipelines(const GscoreConfig& config) {
  TestPipelines out{tile_test_pipeline(config).depth_cycles, 1};
  if (!has_parts(config)) return out;
  const Datapath parts = part_test_pipeline(config);
  out.depth_cycles += parts.depth_cycles;
  out.part_interval_cycles = parts.interval_cycles();
  return out;
}

// Entries of the FIFO of listed tiles, with room for the items in the pipelines.
std::uint32_t listed_entries(const GscoreConfig& config) {
  const TestPipelines tests = test_pipelines(config);
  return static_cast<std::uint32_t>(config.lists.tested_entries +
                                    cycles_for(tests.depth_cycles, tests.part_interval_cycles));
}

// Gaussians that are kept for their tiles: a turn each in the pipelines, one for each listed tile
// that waits, the one that is tested and the one that is listed.
std::uint32_t tested_gaussians(const GscoreConfig& config) {
  return config.lists.tested_entries +
         static_cast<std::uint32_t>(test_pipelines(config).depth_cycles) + 2;
}
// Bytes of the key under test of one entry: its key, and its opacity where there is one.
std::uint32_t tested_key_bytes(const EntryFormat& entry) {
  return entry.key_bytes() + (entry.opacity_bits() + 7) / 8;
}

// Records that are written at once: as many as a transaction takes, at least one.
std::uint32_t records_at_once(const GscoreConfig& config) {
  return std::max(1U, config.memory_port.max_transaction_bytes / kRecordPlaceBytes);
}

}  // namespace

TileLister::TileLister(const sc_core::sc_module_name& name, const UnitContext& context,
                       std::function<void(std::uint32_t frame)> on_drawn)
    : sc_module(name),
      memory("memory", context.config.memory_port, context.clock.period()),
      config_(context.config),
      job_(context.job),
      phases_(context.phases),
      blocks_(config_.blocks()),
      on_drawn_(std::move(on_drawn)),
      tile_path_(tile_test_pipeline(config_)),
      part_path_(has_parts(config_) ? std::optional(part_test_pipeline(config_)) : std::nullopt),
      test_("test", context.clock),
      list_("list", context.clock),
      draw_("draw", context.clock),
      test_passes_("test_passes", context.clock, 1),
      tested_(tested_gaussians(config_)),
      listed_("listed", context.clock, listed_entries(config_),
              static_cast<std::uint32_t>(test_pipelines(config_).depth_cycles)),
      ends_(config_.lists.sets, std::vector<ListEnd>(config_.lists.tiles)),
      projected_("projected", context.clock, 1),
      free_sets_("free_sets", context.clock, config_.lists.sets),
      lines_(config_.lists.lines, Line{LineBuffer(blocks_.line_bytes)}),
      records_(std::size_t{records_at_once(config_)} * kRecordPlaceBytes) {
  for (Activity* a : {&test_, &list_}) context.phases.projecting.add(*a);
  SC_THREAD(run_test);
  SC_THREAD(run_list);
  if (overlaps()) SC_THREAD(run_draw);
}

// A pass that has overflowed is made again with half of its tiles.
void TileLister::run_list() {
  std::uint32_t most = std::min(config_.lists.tiles, job_.tiles_of_frame());
  // Whoever is projected while another is drawn waits for no phase.
  if (overlaps()) {
    phases_.projecting.begin();
    phases_.drawing.begin();
  }
  for (Pass pass; pass.first < job_.tile_count;) {
    const std::uint32_t frame = job_.frame_of(pass.first);
    if (pass.first == job_.first_tile(frame)) await_pose(host, frame, list_);
    if (!overlaps()) phases_.projecting.begin();
    pass.end = std::min(pass.first + most, job_.first_tile(frame + 1));
    ++counters_.passes;
    if (overlaps() && pass.first != projecting_) set_ = free_sets_.pop(list_, WaitFor::kRoom);
    projecting_ = pass.first;
    if (!project(pass)) {
      ++counters_.passes_overflowed;
      most = (pass.end - pass.first + 1) / 2;
      continue;
    }
    if (overlaps()) {
      projected_.push({pass, set_}, list_);
    } else {
      phases_.projecting.end();
      phases_.drawing.begin();
      draw({pass, 0}, list_);
      phases_.drawing.end();
    }
    pass.first = pass.end;
  }
  Pass over;
  over.over = true;
  for (int c = 0; c < passes.size(); ++c) passes[c]->push(over, list_);
  test_passes_.push(over, list_);
  list_.idles();
}

void TileLister::run_draw() {
  for (std::uint32_t set = 0; set < config_.lists.sets; ++set) free_sets_.push(set, draw_);
  for (Pass pass; pass.end < job_.tile_count;) {
    const ProjectedPass next = projected_.pop(draw_);
    pass = next.pass;
    draw(next, draw_);
    free_sets_.push(next.set, draw_);
  }
  draw_.idles();
}

bool TileLister::project(const Pass& pass) {
  const std::uint32_t tiles = pass.end - pass.first;
  for (int c = 0; c < passes.size(); ++c) passes[c]->push(pass, list_);
  test_passes_.push(pass, list_);
  // The table is cleared while the first Gaussians are on their way; a row of it a cycle.
  list_.work(tiles);
  std::fill_n(ends_[set_].begin(), tiles, ListEnd{});
  counters_.table_writes += tiles;
  for (Line& line : lines_) line.tile = 0;  // as each was looked at, at the end of the pass before
  next_block_ = tiles;
  overflowed_ = tiles > config_.pool_blocks();
  record_number_ = 0;
  for (ListedTile next = listed_.pop(list_); !next.end; next = listed_.pop(list_)) {
    take(next, pass);
  }
  // Every line is looked at, whether there is something new in it, which leaves in that cycle.
  for (Line& line : lines_) {
    if (line.tile != 0 && line.buffer.holds_new()) flush_line(line);
    list_.work(1);
  }
  counters_.line_looks += lines_.size();
  counters_.line_changes += lines_.size();
  flush_records();
  await_all(memory, list_);
  return !overflowed_;
}

void TileLister::take(const ListedTile& tile, const Pass& pass) {
  list_.work(1);
  ++counters_.pairs;
  const TestedGaussian& of = tested_[tile.gaussian];
  if (tile.first) put_record(of.splat);
  put_entry(tile.tile - pass.first, {of.key, record_number_ - 1, tile.bitmap,
                                     listed_opacity(config_.tiles.features, of.splat.opacity)});
}

void TileLister::put_record(const Splat& splat) {
  encode_projected(config_.tiles.features, splat,
                   records_.data() + std::size_t{waiting_records_} * kRecordPlaceBytes);
  ++record_number_;
  ++waiting_records_;
  ++counters_.records;
  if (waiting_records_ == records_at_once(config_)) flush_records();
}

void TileLister::flush_records() {
  if (waiting_records_ == 0) return;
  const std::uint32_t bytes = waiting_records_ * kRecordPlaceBytes;
  start_write(memory, list_, job_.record_address(set_, record_number_ - waiting_records_),
              records_.data(), bytes, job_.projected.region);
  waiting_records_ = 0;
}

// Puts an entry behind a tile's list. The first block of tile t has the number t. The link to the
// next block must be there when the first line leaves, so that block is taken now.
void TileLister::put_entry(std::uint32_t tile, const TileEntry& entry) {
  ListEnd& end = ends_[set_][tile];
  ++counters_.table_reads;
  ++counters_.table_writes;
  ++counters_.line_looks;
  if (overflowed_) return;
  if (end.entries % blocks_.block_entries() == 0) {
    if (next_block_ == config_.pool_blocks()) {
      overflowed_ = true;
      return;
    }
    end.block = end.entries == 0 ? tile : end.next;
    end.next = next_block_++;
    ++counters_.blocks;
  }
  const EntryPlace place = place_of(blocks_, end.block, end.entries);
  Line& line = lines_[tile % lines_.size()];
  if (line.tile != tile + 1) {
    if (line.tile != 0 && line.buffer.holds_new()) {
      ++counters_.lines_displaced;
      flush_between(line);
    }
    line.tile = tile + 1;
    line.buffer.begin(place.line, place.begins_line ? 0 : place.at);
  } else if (place.begins_line) {
    line.buffer.begin(place.line, 0);
  }
  counters_.line_writes += gscore::put_entry(blocks_, place, entry, end.next, line.buffer);
  ++counters_.line_changes;
  ++end.entries;
  if (!place.ends_line) return;
  ++counters_.lines_full;
  flush_between(line);
}

// No entry is written while the line is read.
void TileLister::flush_between(Line& line) {
  const std::uint64_t cycles = cycles_for(flush_line(line), kLineBanks);
  list_.work(cycles);
  counters_.line_cycles += cycles;
}

std::uint32_t TileLister::flush_line(Line& line) {
  const std::uint64_t at = line.buffer.address(blocks_.line_bytes);
  const std::uint32_t bytes = line.buffer.new_byte_count();
  const std::uint32_t words =
      line_words(static_cast<std::uint32_t>(at % blocks_.line_bytes), bytes);
  counters_.line_reads += words;
  start_write(memory, list_, job_.lists_of(set_).base + at, line.buffer.new_bytes(), bytes,
              job_.lists.region);
  line.buffer.written();
  return words;
}

// Hands the tiles of a pass out and waits until they are drawn. One request of each core is
// answered by the end of the pass.
void TileLister::draw(const ProjectedPass& projected, Activity& by) {
  const Pass& pass = projected.pass;
  const std::uint32_t frame = job_.frame_of(pass.first);
  if (asked_ == nullptr) asked_ = std::make_unique<FifoSelector<TileRequest>>(requests);
  const auto any = [](int) { return true; };
  for (std::uint32_t tile = pass.first; tile < pass.end; ++tile) {
    const int core = asked_->select(by, any);
    requests[core]->pop(by);
    by.takes_up_tile(tile);
    by.work(1);
    ++counters_.table_reads;
    ++counters_.tiles;
    const ListEnd& end = ends_[projected.set][tile - pass.first];
    counters_.tiles_empty += end.entries == 0 ? 1 : 0;
    counters_.list_entries_max.raise_to(end.entries);
    jobs[core]->push({TileMark::kTile, tile, tile - pass.first, end.entries, projected.set}, by);
  }
  const TileMark mark = pass.end == job_.tile_count ? TileMark::kEndOfFrame : TileMark::kEndOfPass;
  std::vector<bool> told(static_cast<std::size_t>(requests.size()));
  for (int c = 0; c < requests.size(); ++c) {
    const int core =
        asked_->select(by, [&](int index) { return !told[static_cast<std::size_t>(index)]; });
    told[static_cast<std::size_t>(core)] = true;
    requests[core]->pop(by);
    by.work(1);
    jobs[core]->push({mark, 0, 0, 0, 0}, by);
  }
  for (int c = 0; c < done.size(); ++c) done[c]->pop(by);
  if (pass.end == job_.first_tile(frame + 1)) on_drawn_(frame);
}

SramUses TileLister::sram_uses(const GscoreConfig& c) {
  const BlockFormat blocks = c.blocks();
  const std::uint32_t end_bytes = list_end_bytes(blocks, c.pool_blocks());
  const std::uint32_t tested = tested_gaussians(c), key_bytes = tested_key_bytes(c.entries());
  const std::uint32_t record = record_bytes(c.tiles.features);
  SramUses uses = {
      sram_use(kEnds, kBuffer, {{c.lists.tiles, "tiles"}, {end_bytes, "B"}}, {8 * end_bytes},
               kOneOfEach),
      sram_use(kLines, kBuffer, {{c.lists.lines, "lines"}, {blocks.line_bytes, "B"}},
               {8 * kLineWordBytes, SramPorts::kOne, kLineBanks}, {kLineBanks, 0}),
      sram_use(kTags, kBuffer, {{c.lists.lines, "lines"}, {tag_bytes(c), "B"}}, {8 * tag_bytes(c)},
               kOneOfEach),
      sram_use(kWaitingRecords, kBuffer,
               {{records_at_once(c), "records"}, {kRecordPlaceBytes, "B"}}, {8 * kRecordPlaceBytes},
               kOneOfEach),
      fifo_use<Pass>(kTestPasses, kBuffer, 1, "passes"),
      fifo_use<ListedTile>(kListed, kBuffer, listed_entries(c), "tiles"),
      sram_use(kTestedRecords, kBuffer, {{tested, "Gaussians"}, {record, "B"}}, {8 * record},
               kOneOfEach),
      sram_use(kTestedKeys, kBuffer, {{tested, "Gaussians"}, {key_bytes, "B"}}, {8 * key_bytes},
               kOneOfEach),
      outstanding_table(kBuffer, c.memory_port),
      unanswered_writes(kListWrites, kBuffer, c.memory_port, c.memory_port.max_transaction_bytes)};
  uses.front().count = c.lists.sets;
  if (c.lists.sets > 1) {
    uses.push_back(fifo_use<ProjectedPass>(kProjectedPasses, kBuffer, 1, "passes"));
  }
  if (has_parts(c)) {
    uses.push_back(sram_use(kTestedBoxes, kBuffer, {{tested, "Gaussians"}, {kTestedBoxBytes, "B"}},
                            {8 * kTestedBoxBytes}, kOneOfEach));
  }
  return uses;
}

void TileLister::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(test_, "tile tests", "tests tiles and their parts");
  sheet.activity(list_, "listing", "lists Gaussians in tiles, then hands tiles out");
  if (overlaps()) sheet.activity(draw_, "handing out", "hands tiles out");
  sheet.counters(counters_);
  sheet.sram(sram_uses(config_));
  sheet.accesses(kEnds, counters_.table_reads, counters_.table_writes);
  sheet.accesses(kLines, counters_.line_reads, counters_.line_writes);
  sheet.accesses(kTags, counters_.line_looks, counters_.line_changes);
  sheet.accesses(kWaitingRecords, counters_.records, counters_.records);
  const std::uint64_t tested = counters_.gaussians - counters_.gaussians_off_pass;
  sheet.accesses(kTestedRecords, counters_.records, tested);
  sheet.accesses(kTestedKeys, counters_.pairs, tested);
  if (part_path_) sheet.accesses(kTestedBoxes, counters_.part_tests, tested);
  sheet.part("lists", "comparator", kComparators, 1);
  sheet.operations("lists", "comparator", static_cast<double>(kComparators * counters_.pairs));
  sheet.part("lists", "adder", kAdders, 1);
  sheet.operations("lists", "adder", static_cast<double>(kAdders * counters_.pairs));
  // The Gaussian whose tiles are tested; the end of the list that was written last, which may be
  // wanted before it can be read.
  const double tested_bits = 8.0 * Converted::kSramBytes;
  const double end_bits = 8.0 * list_end_bytes(blocks_, config_.pool_blocks());
  sheet.part("lists", "register_bit", tested_bits + end_bits, 1);
  sheet.operations("lists", "register_bit",
                   tested_bits * static_cast<double>(counters_.gaussians) +
                       end_bits * static_cast<double>(counters_.pairs));
  // Selection of the CCU whose Gaussian it is: two-way multiplexers.
  publish_selection(sheet, "lists", {config_.ccus, tested_bits},
                    static_cast<double>(counters_.gaussians));
  sheet.datapath(tile_path_, counters_.tile_steps);
  if (part_path_) sheet.datapath(*part_path_, counters_.part_tests);
  sheet.queue(test_passes_, kTestPasses);
  sheet.queue(listed_, kListed);
  if (overlaps()) sheet.queue(projected_, kProjectedPasses);
  sheet.port(memory, kListWrites);
  sheet.remedy(test_, "lists.tiles_at_once");
  sheet.remedy(listed_, WaitFor::kRoom, "lists.tested_entries");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_writes");
  sheet.may_help("lists.lines");
}

}  // namespace sgs::gscore
