// Filling of the codebook buffer, and who reads which bank when.
#include "modules/streaminggs/hfu/codebook_buffer.h"

#include <algorithm>
#include <iterator>

#include "modules/datapath/selection.h"

namespace sgs {

CodebookBuffer::CodebookBuffer(const sc_core::sc_module_name& name, const CodebookConfig& config,
                               const UnitContext& context, InstantEnd& instant_end,
                               std::uint32_t readers)
    : sc_module(name),
      memory("memory", context.built_for.memory_port, context.clock.period()),
      config_(config),
      built_for_(context.built_for),
      job_(context.job),
      instant_end_(instant_end),
      load_("load", context.clock),
      bytes_(job_.layout.second_half.codebook_bytes()),
      requests_(readers) {
  SC_THREAD(run_load);
}

// Codebooks left by an earlier frame cost neither traffic nor time.
void CodebookBuffer::start_of_simulation() {
  if (!config_.preloaded) return;
  ::tlm::tlm_generic_payload payload;
  payload.set_read();
  payload.set_address(job_.layout.codebooks.base);
  payload.set_data_ptr(reinterpret_cast<unsigned char*>(bytes_.data()));
  payload.set_data_length(static_cast<unsigned int>(bytes_.size()));
  if (memory.socket->transport_dbg(payload) != bytes_.size()) {
    SC_REPORT_ERROR("/sgs/codebooks",
                    "codebook.preloaded: the memory gives nothing to a debug read");
  }
  full_ = true;
}

void CodebookBuffer::run_load() {
  if (full_) return;
  const std::uint64_t base = job_.layout.codebooks.base;
  start_read(memory, load_, base, bytes_.data(), static_cast<std::uint32_t>(bytes_.size()),
             job_.layout.codebooks.region);
  await_all(memory, load_);
  load_.idles();
  counters_.bytes_loaded = bytes_.size();
  counters_.loaded_at_cycle = load_.clock().now_cycles();
  full_ = true;
  filled_.notify(sc_core::SC_ZERO_TIME);
}

void CodebookBuffer::read_entries(std::uint32_t reader, const CodebookIndices& indices,
                                  Activity& activity) {
  if (!full_) {
    activity.waits_for(WaitFor::kLoading, *this);
    while (!full_) sc_core::wait(filled_);
    activity.clock().align();
    activity.works();
  }
  Request& request = requests_[reader];
  request.indices = &indices;
  instant_end_.ask_for(*this);
  sc_core::wait(request.decided);
  activity.work(request.done_cycle - activity.clock().now_cycles());
}

void CodebookBuffer::decide() {
  const std::uint64_t now = load_.clock().now_cycles();
  for (Request& request : requests_) {
    if (request.indices == nullptr) continue;
    request.done_cycle = take_record(*request.indices, now);
    request.indices = nullptr;
    request.decided.notify(sc_core::SC_ZERO_TIME);
  }
}

// All entries of a record, one line a cycle from `cycle` on; returns the cycle behind the last.
std::uint64_t CodebookBuffer::take_record(const CodebookIndices& indices, std::uint64_t cycle) {
  const SecondHalfFormat& format = job_.layout.second_half;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    cycle = take_lines(id, format.entry(static_cast<Codebook>(id), indices[id]), cycle);
  }
  ++counters_.records_decoded;
  return cycle;
}

std::uint64_t CodebookBuffer::take_lines(std::size_t codebook, const EntryRange& entry,
                                         std::uint64_t cycle) {
  if (entry.bytes == 0) return cycle;
  const std::uint32_t first = entry.begin / config_.line_bytes;
  const std::uint32_t last = (entry.begin + entry.bytes - 1) / config_.line_bytes;
  for (std::uint32_t line = first; line <= last; ++line) {
    const std::uint64_t taken = banks_.take(line % config_.banks, cycle);
    counters_.bank_conflict_cycles += taken - cycle;
    ++counters_.lines_read;
    ++counters_.lines_of[codebook];
    cycle = taken + 1;
  }
  return cycle;
}

// Lines of every codebook lie in all banks.
SramUses CodebookBuffer::sram_uses(const CodebookConfig& config, const SecondHalfFormat& format) {
  SramUses uses;
  for (std::size_t id = 0; format.quantised() && id < kCodebookCount; ++id) {
    const std::uint32_t entry = format.entry_bytes(static_cast<Codebook>(id));
    const std::uint64_t bytes = std::uint64_t{format.entries[id]} * entry;
    const auto line = static_cast<std::uint32_t>(
        std::max<std::uint64_t>(1, std::min<std::uint64_t>(config.line_bytes, bytes)));
    // A codebook of fewer lines lies in fewer banks.
    const auto banks = static_cast<std::uint32_t>(
        std::max<std::uint64_t>(1, std::min<std::uint64_t>(config.banks, bytes / line)));
    uses.push_back(sram_use(kCodebookNames[id], kCodebookSram,
                            {{format.entries[id], "entries"}, {entry, "B"}},
                            {8 * line, SramPorts::kOne, banks}, {banks, 0}));
  }
  return uses;
}

// Each reader takes a line from any bank of any codebook, and puts its words where they belong in
// the decoded Gaussian: an entry begins with any word.
void CodebookBuffer::publish_readers(DataSheet& sheet, const SramUses& uses) const {
  std::uint64_t banks = 0;
  for (const SramUse& use : uses) banks += use.shape.banks;
  const double bits = 8.0 * config_.line_bytes;
  const auto readers = static_cast<double>(requests_.size());
  const auto lines = static_cast<double>(counters_.lines_read);
  publish_selection(sheet, "codebooks", {banks, bits, readers}, lines);
  publish_selection(sheet, "codebooks", {config_.line_bytes / sizeof(float), bits, readers}, lines);
}

void CodebookBuffer::publish(DataSheet& sheet) {
  sheet.unit(*this);
  sheet.activity(load_, "codebook_load", "fills the buffer");
  sheet.counters(counters_);
  // An entry's place: its number times its bytes, and the lines from there.
  sheet.part("codebooks", "comparator", static_cast<double>(requests_.size()), 1);
  sheet.operations("codebooks", "comparator", static_cast<double>(counters_.lines_read));
  const SecondHalfFormat& format = job_.layout.second_half;
  const SramUses uses = sram_uses(config_, format);
  sheet.sram(uses);
  publish_readers(sheet, uses);
  for (const SramUse& use : uses) {
    const auto id = static_cast<std::size_t>(
        std::find(std::begin(kCodebookNames), std::end(kCodebookNames), use.name) -
        std::begin(kCodebookNames));
    sheet.accesses(use.name.c_str(), counters_.lines_of[id],
                   counters_.bytes_loaded > 0 ? sram_words(use.bytes, use.shape) : 0);
  }
  sheet.sram(outstanding_table(kSharedSram, built_for_.memory_port));
  sheet.port(memory);
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.signal("full", full_);
}

}  // namespace sgs
