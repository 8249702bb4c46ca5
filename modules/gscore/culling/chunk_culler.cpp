// The threads of the culler, and what it publishes.
#include "modules/gscore/culling/chunk_culler.h"

#include <algorithm>

#include "modules/gscore/gscore_datapaths.h"

namespace sgs::gscore {
namespace {

constexpr const char *kInFlight = "nodes in flight", *kInTest = "nodes in test",
                     *kTested = "tested nodes", *kCompared = "keys of tested nodes",
                     *kLevels = "levels of the walk", *kVisibleUse = "visible chunks";
constexpr std::uint32_t kNumberBytes = 4;
// Of a node that has been tested: first node, counts, and a bit for each child.
constexpr std::uint32_t kTestedBytes = 4 + 2 * kChunkNodeWidth + 1;
// What is compared of all of them: number, first slot, which inner children are not asked for.
constexpr std::uint32_t kComparedBytes = 4 + 4 + 1;
// Of a level: first node, which ones are left, which ones are not asked for.
constexpr std::uint32_t kLevelBytes = 4 + 1 + 1;
// Beside the tested nodes: whether a chunk joins the run, and where the run is cut.
constexpr std::uint32_t kRunComparators = 2;
constexpr std::uint32_t kRunBits = 2 * 32;

}  // namespace

ChunkCuller::ChunkCuller(const sc_core::sc_module_name& name, const UnitContext& context)
    : sc_module(name),
      memory("memory", context.config.memory_port, context.clock.period()),
      config_(context.config),
      job_(context.job),
      walk_("walk", context.clock),
      hand_out_("hand_out", context.clock),
      nodes_(config_.culling.nodes_in_flight, job_.layout.chunk_table().nodes),
      tester_(context.clock, chunk_test_pipeline(config_), config_.culling.nodes_in_test,
              chunk_test_pipeline(config_).depth_cycles),
      visible_("visible", context.clock, kVisibleChunks) {
  for (std::uint32_t f = 0; f < job_.frames(); ++f) {
    const View<float>& view = job_.picture(f).view;
    frusta_.emplace_back(view, PixelRect{0, 0, view.width, view.height});
  }
  tester_.announce_to(news_);
  for (Activity* a : {&walk_, &tester_.activity(), &hand_out_}) context.phases.projecting.add(*a);
  SC_THREAD(run_walk);
  SC_THREAD(run_arrivals);
  SC_THREAD(run_tests);
  SC_THREAD(run_hand_out);
}

void ChunkCuller::run_walk() {
  for (Pass pass = passes->pop(walk_); !pass.over; pass = passes->pop(walk_)) {
    ++counters_.passes;
    frame_ = job_.frame_of(pass.first);
    descend();
    VisibleChunk end;
    end.frame = frame_;
    end.end_of_pass = true;
    visible_.push(end, walk_);
    walk_.work(1);
  }
  VisibleChunk over;
  over.over = true;
  visible_.push(over, walk_);
  walk_.idles();
}

void ChunkCuller::descend() {
  descent_.begin(job_.layout.chunk_table().nodes.count == 0);
  while (!descent_.done()) {
    if (!step()) wait_for_news();
  }
}

// Reads first: the longest way. Nothing else is done in the same step, so that what comes meanwhile
// is seen.
bool ChunkCuller::step() { return ask_for_node() || open_next() || take_tested() || begin_test(); }

// In storage order, as far as it is known: the node that is opened next is the first to be asked
// for, so that the others leave it a place. Then those below tested nodes, whose slots come first;
// they and what is farther take half of the places, since they keep them for longer.
InnerNodes* ChunkCuller::nodes_to_ask_for() {
  if (InnerNodes* next = descent_.unasked_next()) return next;
  if (2 * under_way() >= config_.culling.nodes_tested) return nullptr;
  TestedNode* first = nullptr;
  for (TestedNode& node : tested_) {
    if (node.unasked.empty()) continue;
    if (first == nullptr || node.record.first_slot < first->record.first_slot) first = &node;
  }
  if (first == nullptr) return descent_.unasked_above();
  ++counters_.looked_ahead;
  return &first->unasked;
}

bool ChunkCuller::ask_for_node() {
  if (nodes_.full() || under_way() == config_.culling.nodes_tested) return false;
  InnerNodes* nodes = nodes_to_ask_for();
  if (nodes == nullptr) return false;
  const AskedNode node{nodes->front()};
  nodes->remove_front();
  walk_.work(1);
  nodes_.ask(node, memory, walk_);
  return true;
}

bool ChunkCuller::open_next() {
  const auto next = std::find_if(tested_.begin(), tested_.end(), [&](const TestedNode& node) {
    return node.at == descent_.next();
  });
  if (next == tested_.end()) return false;
  const TestedNode node = *next;
  tested_.erase(next);
  ++counters_.nodes;
  walk_.work(1);
  descent_.open(node.record, node.touching, node.unasked,
                [&](std::uint32_t first, std::uint32_t count) {
                  ++counters_.chunks;
                  visible_.push({first, count, frame_}, walk_);
                  walk_.work(1);
                });
  return true;
}

bool ChunkCuller::take_tested() {
  if (!tester_.can_take()) return false;
  const NodeInTest<AskedNode> node = tester_.take(walk_);
  const std::uint8_t touching = touching_children(node.record, frusta_[frame_]);
  tested_.push_back({node.entry.at, node.record, touching, touching_inner(node.record, touching)});
  walk_.work(1);
  return true;
}

bool ChunkCuller::begin_test() {
  if (!nodes_.can_take() || tester_.full()) return false;
  const auto [asked, record] = nodes_.take();
  walk_.work(1);
  tester_.put({asked, record}, walk_);
  return true;
}

void ChunkCuller::wait_for_news() {
  if (nodes_.any_arrived() && tester_.full()) {
    walk_.waits_for(WaitFor::kRoom, tester_.slots());
  } else if (nodes_.used() > 0) {
    walk_.waits_for(WaitFor::kReads, memory);
  } else {
    walk_.waits_for(WaitFor::kInput, tester_.pipeline());
  }
  std::optional<sc_core::sc_time> first;
  if (nodes_.any_arrived() && !tester_.full()) first = nodes_.ready_at();
  if (tester_.any_tested())
    first = std::min(first.value_or(tester_.ready_at()), tester_.ready_at());
  if (first) {
    sc_core::wait(*first - sc_core::sc_time_stamp(), news_);
  } else {
    sc_core::wait(news_);
  }
  walk_.clock().jitter();
  walk_.works();
}

void ChunkCuller::run_arrivals() { nodes_.run_arrivals(memory, walk_.clock(), news_); }

void ChunkCuller::run_tests() {
  tester_.run([](const AskedNode&) {});
}

void ChunkCuller::run_hand_out() {
  for (VisibleChunk chunk = visible_.pop(hand_out_); !chunk.over; chunk = visible_.pop(hand_out_)) {
    hand_out_.work(1);
    frame_handed_out_ = chunk.frame;
    if (chunk.end_of_pass) {
      end_pass();
      continue;
    }
    if (chunk.first != run_end_ || run_first_ == run_end_) {
      cut_run(true);
      run_first_ = chunk.first;
    }
    run_end_ = chunk.first + chunk.count;
    cut_run(false);
  }
  VisibleSlice over;
  over.over = true;
  for (int c = 0; c < slices.size(); ++c) slices[c]->push(over, hand_out_);
  hand_out_.idles();
}

void ChunkCuller::cut_run(bool all) {
  const std::uint32_t size = config_.ccu.slice_gaussians;
  while (run_first_ < run_end_) {
    const std::uint32_t whole = (run_first_ / size + 1) * size;
    if (whole > run_end_ && !all) return;
    const std::uint32_t end = std::min(whole, run_end_);
    if (held_) hand_out(*held_);
    held_ = VisibleSlice{run_first_, end - run_first_, frame_handed_out_};
    run_first_ = end;
  }
}

void ChunkCuller::hand_out(const VisibleSlice& slice) {
  ++counters_.slices;
  counters_.gaussians += slice.count;
  in_turn(slices, turn_++).push(slice, hand_out_);
  hand_out_.work(1);
}

// No slice at all is one without a Gaussian; of an empty scene nobody waits for any.
void ChunkCuller::end_pass() {
  cut_run(true);
  VisibleSlice last = held_.value_or(VisibleSlice{0, 0, frame_handed_out_});
  last.end_of_pass = true;
  if (job_.layout.gaussian_count() > 0) hand_out(last);
  held_.reset();
  run_first_ = run_end_ = 0;
  turn_ = 0;
}

SramUses ChunkCuller::sram_uses(const GscoreConfig& config) {
  const CullingConfig& c = config.culling;
  constexpr SramShape kOfPort{8 * kPortBytes};
  return {
      sram_use(kInFlight, kBuffer,
               {{c.nodes_in_flight, "nodes"}, {sizeof(ChunkNode) + kNumberBytes, "B"}}, kOfPort,
               kOneOfEach),
      sram_use(kInTest, kBuffer,
               {{c.nodes_in_test, "nodes"}, {sizeof(ChunkNode) + kNumberBytes, "B"}}, kOfPort,
               kOneOfEach),
      sram_use(kTested, kBuffer, {{c.nodes_tested, "nodes"}, {kTestedBytes, "B"}},
               {8 * kTestedBytes, SramPorts::kReadAndWrite}, kOneOfEach),
      // All are compared with the node that is next, and for the first slot.
      sram_use(kCompared, kBuffer, {{c.nodes_tested, "nodes"}, {kComparedBytes, "B"}},
               {8 * kComparedBytes, SramPorts::kReadAndWrite, c.nodes_tested}, {c.nodes_tested, 1}),
      sram_use(kLevels, kBuffer, {{c.tree_levels, "levels"}, {kLevelBytes, "B"}},
               {8 * kLevelBytes, SramPorts::kReadAndWrite}, kOneOfEach),
      fifo_use<VisibleChunk>(kVisibleUse, kBuffer, kVisibleChunks, "chunks"),
      outstanding_table(kBuffer, config.memory_port)};
}

void ChunkCuller::publish(DataSheet& sheet) {
  const std::uint64_t nodes = counters_.nodes;
  sheet.unit(*this);
  sheet.activity(walk_, "culling", "walks the tree of the chunks' boxes");
  sheet.activity(tester_.activity(), "chunk_tests", "tests boxes against the frame");
  sheet.activity(hand_out_, "slices", "hands out Gaussians of visible chunks");
  sheet.counters(counters_);
  sheet.counter("tests", "children", "of nodes, tested against the frame", tester_.tests());
  sheet.datapath(tester_.lanes(), tester_.tests());
  sheet.left_out("chunks_off_frame", "their boxes cannot touch the frame",
                 counters_.passes * job_.layout.chunk_table().chunk_count - counters_.chunks,
                 "their Gaussians are never fetched");
  sheet.sram(sram_uses(config_));
  // A node comes in and goes out whole.
  constexpr std::uint64_t kWords = sizeof(ChunkNode) / kPortBytes;
  sheet.accesses(kInFlight, kWords * nodes, kWords * nodes);
  sheet.accesses(kInTest, kWords * nodes, kWords * nodes);
  sheet.accesses(kTested, nodes, nodes);
  // Whenever a node is opened, and where the first slot is looked for, whose node is asked for.
  sheet.accesses(kCompared, config_.culling.nodes_tested * (nodes + counters_.looked_ahead),
                 nodes + counters_.looked_ahead);
  // Its parent's level is read and written when a node is asked for and when it is opened, and its
  // own is written.
  sheet.accesses(kLevels, 2 * nodes, 3 * nodes);
  // The number of each with that of the next one, and a tree of them for the first slot.
  const double numbers = config_.culling.nodes_tested;
  sheet.part("culler", "comparator", 2 * numbers - 1 + kRunComparators, 1);
  sheet.operations("culler", "comparator",
                   numbers * static_cast<double>(nodes) +
                       (numbers - 1) * static_cast<double>(counters_.looked_ahead) +
                       kRunComparators * static_cast<double>(counters_.chunks));
  // The run, and the slice that waits until the next one is known.
  constexpr double kHeldBits = 8.0 * VisibleSlice::kSramBytes;
  sheet.part("culler", "register_bit", kRunBits + kHeldBits, 1);
  sheet.operations("culler", "register_bit",
                   kRunBits * static_cast<double>(counters_.chunks) +
                       kHeldBits * static_cast<double>(counters_.slices));
  sheet.queue(visible_, kVisibleUse);
  sheet.port(memory);
  sheet.remedy(tester_.activity(), "culling.test_lanes");
  sheet.remedy(tester_.slots(), WaitFor::kRoom, "culling.nodes_in_test");
  sheet.remedy(memory, WaitFor::kReads, "culling.nodes_in_flight");
  sheet.remedy(memory, WaitFor::kPort, "memory_port.max_outstanding");
}

}  // namespace sgs::gscore
