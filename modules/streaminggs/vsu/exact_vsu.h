// Voxel sorting unit (VSU), exact order. For each pixel group it walks the chunk tree front to
// back. It hands out the chunks that can touch the group, each with the depth below which nothing
// follows. Nodes are read ahead, several at a time, as long as their children are sure to fit the
// queues; when a group's nodes have all been read the next group's walk begins. A node or chunk
// that reaches finished sub-tiles only, in both eyes where there are two, is left out when it is
// taken from its queue. The numbers of
// a group are made when the registers of the group before the last are free, and its walk waits for
// them.
// Timing: a node's children pass the tests' lanes and come out of their pipeline test_depth_cycles
// later, nodes_in_test nodes at a time, while the walk goes on. Each operation of a queue takes
// cycles_per_queue_operation; a visit leaves a cycle.
// Function: algorithm/order/chunk_walk.h.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <systemc>
#include <vector>

#include "algorithm/order/chunk_walk.h"
#include "modules/chunks/chunk_tester.h"
#include "modules/chunks/node_buffer.h"
#include "modules/datapath/group_numbers.h"
#include "modules/frame_host.h"
#include "modules/streaminggs/finished_groups.h"
#include "modules/streaminggs/finished_subtiles.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/unit_context.h"
#include "modules/streaminggs/vsu/exact_vsu_config.h"
#include "modules/streaminggs/vsu/walk_aside.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {

constexpr std::uint32_t kReadyVisits = 4;  // a cycle there, a cycle back, and some of jitter

class ExactVsu : public sc_core::sc_module {
 public:
  FifoOuts<VisitShare> visits{"visits"};   // one a HFU; visit v goes to v modulo their number
  FinishedGroupsIns finished{"finished"};  // one an eye
  FinishedSubtilesIns masks{"masks"};      // likewise
  FrameHostPort host{"host"};
  MemoryPort memory;

  SC_HAS_PROCESS(ExactVsu);
  // aside: where in DRAM queue entries wait that do not fit.
  ExactVsu(const sc_core::sc_module_name& name, const ExactVsuConfig& config,
           const UnitContext& context, const RegionSpan& aside);

  struct Counters : CounterSet {
    Counter upper_nodes_opened{*this, "upper_nodes_opened", "nodes",
                               "opened that are kept on chip"};
    Counter nodes_read{*this, "nodes_read", "nodes", "read from DRAM"};
    Counter nodes_dropped{*this, "nodes_dropped", "nodes", "not opened: their group had finished"};
    Counter looked_up{*this, "looked_up", "entries",
                      "of the queues, in the mask of finished sub-tiles"};
    Counter nodes_hidden{*this, "nodes_hidden", "nodes",
                         "not opened: all sub-tiles that they reach were finished"};
    Counter chunks_hidden{*this, "chunks_hidden", "chunks", "not handed out, likewise"};
    Counter visits{*this, "visits", "chunks", "handed out, once for each group"};
    Counter visits_dropped{*this, "visits_dropped", "chunks",
                           "that were final when their group had finished"};
    Counter groups_saturated{*this, "groups_saturated", "groups",
                             "finished before their walk ended"};
    Counter groups_empty{*this, "groups_empty", "groups", "that no chunk can touch"};
  };
  const Counters& counters() const { return counters_; }
  static SramUses sram_uses(const ExactVsuConfig& config, const BuiltFor& built_for);
  void publish(DataSheet& sheet);

 private:
  // Place at which the walk waits: for room in one of its queues, for numbers of a group.
  struct WalkPlace : sc_core::sc_object {
    explicit WalkPlace(const char* name) : sc_object(name) {}
    const char* kind() const override { return "sgs::WalkPlace"; }
  };

  void run_walk();      // thread: queues
  void run_arrivals();  // thread: nodes that come from memory
  void run_tests();     // thread: lanes of the tests
  void run_hand_out();  // thread: visits to the HFUs
  void load_upper_nodes();
  bool step();
  bool may_begin_group() const;
  bool begin_group();
  bool waits_for_pose() const;
  bool read_node();
  bool give_chunk();
  bool hidden(const WalkEntry& entry);
  bool enter_children();
  bool test_node();
  void drop(std::size_t nodes) { counters_.nodes_dropped += nodes; }
  void give(const WalkEntry& chunk, float release_below);
  void make_numbers(std::uint32_t first);
  void end_group(bool saturated);
  void mark_saturated(std::uint32_t group);
  void say_what_is_missing();
  void wait_for_news();
  bool work_on_queues(std::uint64_t other_cycles);

  const ExactVsuConfig config_;
  const BuiltFor built_for_;
  const StreamingJob& job_;
  Activity walk_, hand_out_;
  std::vector<ChunkNode> upper_;  // the tree's first nodes
  NodeBuffer<WalkEntry> nodes_;
  ChunkTester<WalkEntry> tester_;
  const WalkPlace node_room_{"node_queue"}, chunk_room_{"chunk_queue"};
  const WalkPlace numbers_{"group_numbers"};
  GroupNumbersInTurn numbers_in_turn_;
  // [group modulo the walks under way] from this cycle on its numbers stand; it may be given the
  // registers of the group two before
  std::array<std::uint64_t, ChunkWalk<WalkAside>::kWalks> numbers_stand_{}, registers_free_{};
  std::uint32_t made_groups_ = 0;  // that numbers were made for
  WalkAside aside_;                // entries that the queues have no room for
  ChunkWalk<WalkAside> chunk_walk_;
  TimedFifo<VisitShare> ready_;         // final visits
  TimedFifo<std::uint32_t> taken_;      // places of ready_ that hand_out has given back
  sc_core::sc_event news_;              // for the walk: a node has come, or room
  std::uint32_t room_;                  // in ready_, as the walk knows it
  std::uint32_t group_ = 0;             // whose chunks are given out
  std::uint32_t next_group_ = 0;        // whose walk has not begun
  std::optional<WalkEntry> held_;       // goes when what follows it is known
  bool any_chunk_ = false;              // a chunk of group_ was found
  std::uint64_t queue_operations_ = 0;  // operations that have taken their time
  std::vector<bool> saturated_;         // [group]
  Counters counters_;
  std::uint32_t next_visit_ = 0;
  std::uint32_t current_chunk_ = 0;  // for the waveform
};

}  // namespace sgs
