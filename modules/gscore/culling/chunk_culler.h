// Culler ahead of the CCUs: walks the tree of the chunks' boxes and hands out the Gaussians of
// those that may touch the frame, in storage order. Nodes are read and tested ahead of their turn.
// Chunks that lie side by side are joined, and cut into slices for the CCUs where their reads are
// whole bursts.
// Timing: a node's children pass the test's lanes and come out of their pipeline; the walk asks for
// a node, takes one over, or hands out a chunk in a cycle each; a slice leaves a cycle.
// Function: algorithm/order/chunk_descent.h.
#pragma once

#include <cstdint>
#include <optional>
#include <systemc>
#include <vector>

#include "algorithm/order/chunk_descent.h"
#include "modules/chunks/chunk_tester.h"
#include "modules/chunks/node_buffer.h"
#include "modules/gscore/gscore_job.h"
#include "modules/gscore/messages.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs::gscore {

constexpr std::uint32_t kVisibleChunks = 8;  // entries of the FIFO: the children of a node

class ChunkCuller : public sc_core::sc_module {
 public:
  FifoIn<Pass> passes{"passes"};
  FifoOuts<VisibleSlice> slices{"slices"};  // one a CCU, in turn from the first in every pass
  MemoryPort memory;

  SC_HAS_PROCESS(ChunkCuller);
  ChunkCuller(const sc_core::sc_module_name& name, const UnitContext& context);

  struct Counters : CounterSet {
    Counter nodes{*this, "nodes", "nodes", "of the chunk tree read and opened"};
    Counter chunks{*this, "chunks", "chunks", "whose boxes touch the frame"};
    Counter slices{*this, "slices", "slices", "handed out"};
    Counter gaussians{*this, "gaussians", "Gaussians", "in these"};
    std::uint64_t passes = 0;
    std::uint64_t looked_ahead = 0;  // nodes asked for of those that are tested
  };

  static SramUses sram_uses(const GscoreConfig& config);
  void publish(DataSheet& sheet);

 private:
  // A node that is asked for.
  struct AskedNode {
    std::uint32_t at = 0;
  };
  // A node whose children have been tested, until it is its turn.
  struct TestedNode {
    std::uint32_t at;
    ChunkNode record;
    std::uint8_t touching;
    InnerNodes unasked;
  };

  void run_walk();      // thread
  void run_arrivals();  // thread: nodes that come from memory
  void run_tests();     // thread: lanes of the tests
  void run_hand_out();  // thread
  void descend();
  bool step();
  InnerNodes* nodes_to_ask_for();
  bool ask_for_node();
  bool take_tested();
  bool begin_test();
  bool open_next();
  void wait_for_news();
  // Nodes that are asked for and not open yet.
  std::size_t under_way() const { return nodes_.used() + tester_.used() + tested_.size(); }
  // Of the run so far what ends where a slice ends, or all of it.
  void cut_run(bool all);
  void hand_out(const VisibleSlice& slice);
  void end_pass();

  const GscoreConfig config_;
  const GscoreJob& job_;
  std::vector<GroupFrustum> frusta_;  // [frame]
  std::uint32_t frame_ = 0;           // of the pass that is walked
  std::uint32_t frame_handed_out_ = 0;
  Activity walk_, hand_out_;
  ChunkDescent descent_;
  NodeBuffer<AskedNode> nodes_;
  ChunkTester<AskedNode> tester_;
  std::vector<TestedNode> tested_;
  TimedFifo<VisibleChunk> visible_;
  sc_core::sc_event news_;  // for the walk: a node has come, or has been tested
  std::uint32_t run_first_ = 0, run_end_ = 0;
  std::optional<VisibleSlice> held_;  // goes when it is known whether it is the last one
  std::uint64_t turn_ = 0;            // of the CCUs
  Counters counters_;
};

}  // namespace sgs::gscore
