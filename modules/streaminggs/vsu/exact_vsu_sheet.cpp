// Data sheet of VSU in exact order: its on-chip memories, counters and costs.
#include "modules/streaminggs/heap_ledger.h"
#include "modules/streaminggs/vsu/exact_vsu.h"
#include "modules/streaminggs/vsu/vsu_datapaths.h"

namespace sgs {
namespace {

constexpr HeapLedger kChunkQueue{"chunk queue", "vsu", kWalkEntryBytes, 2};
constexpr HeapLedger kNodeQueue{"node queue", "vsu", kNodeEntryBytes, 2};

// Keys of the nodes that are taken from their queue and not open yet, and of the nearest entry that
// was put aside: depth, node and one of two walks, in registers, since a chunk is compared with all
// of them at once.
constexpr std::uint32_t kOpenNodeBits = 65, kOpenNodeWords = 2;
std::uint32_t open_nodes(const ExactVsuConfig& config) {
  return config.nodes_in_flight + config.nodes_in_test + 1;
}
SramUse open_nodes_use(const ExactVsuConfig& config) {
  const std::uint32_t nodes = open_nodes(config);
  return sram_use("keys of open nodes", kSharedSram, {{(kOpenNodeBits * nodes + 7) / 8, "B"}},
                  {kOpenNodeBits, SramPorts::kReadAndWrite, nodes}, {nodes, 1});
}

}  // namespace

SramUses ExactVsu::sram_uses(const ExactVsuConfig& config, const BuiltFor& built_for) {
  constexpr SramShape kOfPort{8 * kPortBytes};
  SramUses uses = {
      sram_use("upper nodes", kSharedSram,
               {{config.upper_nodes, "nodes"}, {sizeof(ChunkNode), "B"}}, kOfPort, kOneOfEach),
      sram_use("nodes in flight", kSharedSram,
               {{config.nodes_in_flight, "nodes"}, {sizeof(ChunkNode) + kNodeEntryBytes, "B"}},
               kOfPort, kOneOfEach),
      sram_use("nodes in test", kSharedSram,
               {{config.nodes_in_test, "nodes"}, {sizeof(ChunkNode) + kNodeEntryBytes, "B"}},
               kOfPort, kOneOfEach),
      open_nodes_use(config)};
  add(uses, kChunkQueue.sram_uses(config.queue_entries, config.cycles_per_queue_operation));
  add(uses, kNodeQueue.sram_uses(config.node_queue_entries, config.cycles_per_queue_operation));
  add(uses, mask_use(built_for.group), built_for.eyes);
  uses.push_back(fifo_use<VisitShare>("final visits", kSharedSram, kReadyVisits, "visits"));
  uses.push_back(outstanding_table(kSharedSram, built_for.memory_port));
  uses.push_back(WalkAside::sram_use_of_block());
  uses.push_back(
      unanswered_writes("entries put aside", kSharedSram, built_for.memory_port, kWalkEntryBytes));
  return uses;
}

void ExactVsu::publish(DataSheet& sheet) {
  const WalkCounters& walk = chunk_walk_.counters();
  const WalkQueue &node_queue = chunk_walk_.node_queue(), &chunk_queue = chunk_walk_.chunk_queue();
  sheet.unit(*this);
  sheet.activity(walk_, "vsu", "walks the chunk tree, one group after the other");
  sheet.activity(tester_.activity(), "chunk_tests", "tests the children of nodes");
  sheet.activity(hand_out_, "visits", "hands out what is final");
  sheet.counter("nodes", "nodes", "of the chunk tree opened", walk.nodes);
  sheet.counters(counters_);
  sheet.counter("tests", "children", "tested against a group", tester_.tests());
  sheet.counter("chunk_queue_max", "entries", "most in the queue of chunks", chunk_queue.most());
  sheet.counter("node_queue_max", "entries", "most in the queue of nodes", node_queue.most());
  sheet.counter("chunk_queue_operations", "operations", "insertions and removals",
                chunk_queue.work().operations());
  sheet.counter("node_queue_operations", "operations", "insertions and removals",
                node_queue.work().operations());
  sheet.counter("queue_entries_put_aside", "entries", "that went to DRAM: the queue was full",
                walk.put_aside);
  sheet.datapath(tester_.lanes(), tester_.tests());
  numbers_in_turn_.publish(sheet, "vsu");
  sheet.left_out("saturated_groups", "every pixel was finished before the walk ended",
                 counters_.groups_saturated, "the rest of the tree is not walked");
  sheet.left_out("hidden_nodes", "all sub-tiles that they reach were finished",
                 counters_.nodes_hidden, "the part of the tree below them");
  sheet.left_out("hidden_chunks", "all sub-tiles that they reach were finished",
                 counters_.chunks_hidden, "a visit each");
  sheet.left_out("empty_groups", "no block of Gaussians can touch them", counters_.groups_empty,
                 "no visit, no blending");
  sheet.sram(sram_uses(config_, built_for_));
  const double of_mask = built_for_.eyes * mask_comparators(built_for_.group);
  // Whenever one of the queues has changed the nearest chunk is compared with all open nodes.
  const double of_open = kOpenNodeWords * open_nodes(config_);
  const std::uint64_t compared = chunk_walk_.queue_operations();
  sheet.part("vsu", "comparator", of_mask + of_open, 1);
  sheet.operations(
      "vsu", "comparator",
      of_mask * static_cast<double>(counters_.looked_up) + of_open * static_cast<double>(compared));
  sheet.accesses("finished sub-tiles",
                 built_for_.eyes * mask_bits(built_for_.group) * counters_.looked_up, news(masks));
  sheet.accesses("keys of open nodes", open_nodes(config_) * compared,
                 counters_.upper_nodes_opened + counters_.nodes_read + walk.put_aside);
  // A node comes in and goes out whole, eight children and their common numbers.
  constexpr std::uint64_t kWords = sizeof(ChunkNode) / kPortBytes;
  sheet.accesses("upper nodes", kWords * counters_.upper_nodes_opened, kWords * upper_.size());
  sheet.accesses("nodes in flight", kWords * counters_.nodes_read, kWords * counters_.nodes_read);
  // A node goes in and its children come out as entries of the queues, in the same slot.
  const std::uint64_t in_test = 2 * kWords * tester_.nodes();
  sheet.accesses("nodes in test", in_test, in_test);
  kChunkQueue.publish(sheet, config_.queue_entries, config_.cycles_per_queue_operation,
                      chunk_queue.work());
  kNodeQueue.publish(sheet, config_.node_queue_entries, config_.cycles_per_queue_operation,
                     node_queue.work());
  sheet.port(memory, "entries put aside");
  aside_.publish(sheet);
  sheet.queue(ready_, "final visits");
  if (config_.cycles_per_queue_operation > kFewestHeapCycles) {
    sheet.remedy(walk_, {"vsu.cycles_per_queue_operation", Turn::kDown});
  }
  sheet.remedy(tester_.activity(), "vsu.test_lanes");
  sheet.remedy(chunk_room_, WaitFor::kRoom, "vsu.queue_entries");
  sheet.remedy(node_room_, WaitFor::kRoom, "vsu.node_queue_entries");
  sheet.remedy(tester_.slots(), WaitFor::kRoom, "vsu.nodes_in_test");
  sheet.remedy(memory, WaitFor::kReads, "vsu.nodes_in_flight");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
  sheet.signal("group", group_);
  sheet.signal("chunk", current_chunk_);
}

}  // namespace sgs
