// The display alone, with a machine whose moments the test gives: what is shown when, what a
// machine may do meanwhile, and whether rows come in time.
#include "modules/display/display.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "modules/dram/dram_controller.h"
#include "tlm/time_resolution.h"

namespace sgs::test {
namespace {

using sc_core::SC_MS;
using sc_core::sc_time;
using sc_core::SC_US;

constexpr int kWidth = 40, kHeight = 4;
sc_time a_cycle() { return {1, sc_core::SC_NS}; }

FrameJob job_of(std::uint32_t frames, int width, std::uint32_t eyes) {
  FrameJob job;
  job.eyes = eyes;
  job.view.width = width;
  job.view.height = kHeight;
  job.frame_buffer.bytes = std::uint64_t{pixel_bytes(job.frame_format)} * width * kHeight;
  for (std::uint32_t at = 1; at < frames * eyes; ++at) {
    Picture picture = job;
    picture.frame_buffer.base = (at / eyes % 2 * eyes + at % eyes) * 65536;
    job.following.push_back(picture);
  }
  return job;
}

class Machine : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Machine);
  Machine(const sc_core::sc_module_name& name, std::function<void()> body)
      : sc_module(name), body_(std::move(body)) {
    SC_THREAD(run);
  }

 private:
  void run() { body_(); }
  std::function<void()> body_;
};

struct Resolution {
  Resolution() { use_femtosecond_resolution(); }
};

struct Bench : Resolution {
  Bench(std::uint32_t frames, double rate, const DramConfig& config = {}, int width = kWidth,
        std::uint32_t eyes = 1)
      : job(job_of(frames, width, eyes)),
        memory("memory", config),
        display("display", job, rate, a_cycle()) {
    display.memory.socket.bind(memory.socket);
    display.on_shown = [this](std::uint32_t frame, std::uint32_t eye, const std::byte* bytes) {
      if (bytes != nullptr) shown[frame * job.eyes + eye] = bytes[0];
    };
    display.on_rest = [this](bool rests) { rest.push_back({sc_core::sc_time_stamp(), rests}); };
  }
  // Draws a frame in no time: bytes of its pictures are their number among all plus 1.
  void draw(std::uint32_t frame) {
    for (std::uint32_t eye = 0; eye < job.eyes; ++eye) {
      const std::vector<std::byte> bytes(job.frame_buffer.bytes,
                                         std::byte(frame * job.eyes + eye + 1));
      memory.load(job.picture(frame, eye).frame_buffer.base, bytes.data(), bytes.size());
    }
    display.drawn(frame);
  }
  FrameJob job;
  DramController memory;
  Display display;
  std::map<std::uint32_t, std::byte> shown;  // [frame, eye] first byte, as it was read
  std::vector<std::pair<sc_time, bool>> rest;
};

// Reads or writes as much as the memory takes, until the last frame is shown, for a millisecond at
// most.
class Traffic : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Traffic);
  Traffic(const sc_core::sc_module_name& name, Bench& bench, bool writes)
      : sc_module(name), bench_(bench), writes_(writes), port_("port", MemoryPortConfig{}) {
    port_.socket.bind(bench.memory.socket);
    SC_THREAD(run);
  }

 private:
  void run() {
    constexpr std::uint64_t kBegin = 1 << 20, kBytes = 1 << 20, kStep = 4096 + kRequest;
    const sc_time end(1, SC_MS);
    const auto goes_on = [&] {
      return bench_.display.frames_shown() < bench_.job.frames() && sc_core::sc_time_stamp() < end;
    };
    for (std::uint64_t at = 0; goes_on(); at += kStep) {
      const std::uint64_t address = kBegin + at % kBytes;
      if (writes_) {
        port_.write(address, bytes_.data(), kRequest, 0);
      } else {
        port_.read(address, bytes_.data(), kRequest, 0);
      }
    }
  }
  static constexpr std::uint32_t kRequest = 256;
  Bench& bench_;
  const bool writes_;
  MemoryPort port_;
  std::array<std::byte, kRequest> bytes_{};
};

void wait_until(double ms) { sc_core::wait(sc_time(ms, SC_MS) - sc_core::sc_time_stamp()); }

TEST_CASE("display: a frame that comes too late is shown a picture later, from a buffer held") {
  Bench bench(4, 1000);
  Display& display = bench.display;
  const auto machine = [&] {
    CHECK(display.pose_known(0));
    CHECK_FALSE(display.pose_known(1));
    display.takes_pose(0);
    wait_until(0.5);
    bench.draw(0);
    wait_until(1);
    CHECK(display.pose_known(1));
    display.takes_pose(1);
    wait_until(1.9);
    CHECK_FALSE(display.pose_known(2));
    wait_until(2);
    display.takes_pose(2);
    wait_until(2.5);  // the picture of 2 ms is over: frame 0 again
    bench.draw(1);
    wait_until(2.9);
    CHECK_FALSE(display.buffer_free(2));  // frame 0 is shown until 3 ms
    wait_until(3);
    CHECK_FALSE(display.buffer_free(2));
    sc_core::wait(a_cycle());
    CHECK(display.buffer_free(2));
    CHECK(display.pose_known(3));  // frame 1 is drawn
    wait_until(3.5);
    bench.draw(2);
    wait_until(4);  // is due: not before it
    display.takes_pose(3);
    bench.draw(3);
  };
  const Machine thread("machine", machine);
  sc_core::sc_start();
  const double expected[][4] = {
      {0, 0, 0.5, 1}, {1, 1, 2.5, 3}, {2, 2, 3.5, 4}, {3, 4, 4, 5}};  // pose, begun, drawn, shown
  for (std::size_t frame = 0; frame < 4; ++frame) {
    INFO(frame);
    const FrameTimes& times = display.times()[frame];
    CHECK(times.pose == sc_time(expected[frame][0], SC_MS));
    CHECK(times.begun == sc_time(expected[frame][1], SC_MS));
    CHECK(times.drawn == sc_time(expected[frame][2], SC_MS));
    CHECK(times.shown == sc_time(expected[frame][3], SC_MS));
    CHECK(bench.shown.at(static_cast<std::uint32_t>(frame)) == std::byte(frame + 1));
  }
  CHECK(display.counters().pictures == 5);
  CHECK(display.counters().repeated == 1);
  CHECK(display.counters().rows == 5 * kHeight);
  CHECK(display.counters().rows_late == 0);
  // It rests from frame 0 to the pose of frame 1, and behind the last.
  const std::vector<std::pair<sc_time, bool>> rest = {
      {sc_time(0.5, SC_MS), true}, {sc_time(1, SC_MS), false}, {sc_time(4, SC_MS), true}};
  CHECK(bench.rest == rest);
  const sc_time after = sc_core::sc_time_stamp() - sc_time(4, SC_MS);
  CHECK(display.rested() == sc_time(0.5, SC_MS) + after);
}

TEST_CASE("display: without a rate every pose is there, a frame is shown when it is drawn") {
  Bench bench(3, 0);
  Display& display = bench.display;
  const auto machine = [&] {
    for (const std::uint32_t frame : {0U, 1U}) {
      CHECK(display.pose_known(frame));
      display.takes_pose(frame);
    }
    CHECK_FALSE(display.pose_known(2));  // registers for two
    sc_core::wait(1, SC_US);
    bench.draw(0);
    CHECK_FALSE(display.pose_known(2));  // within the cycle nobody sees it
    CHECK_FALSE(display.buffer_free(2));
    sc_core::wait(display.news());
    CHECK(display.pose_known(2));
    CHECK_FALSE(display.buffer_free(2));  // frame 0 is shown until the next is there
    bench.draw(1);
    sc_core::wait(a_cycle());
    CHECK(display.buffer_free(2));
    display.takes_pose(2);
    bench.draw(2);
  };
  const Machine thread("machine", machine);
  sc_core::sc_start();
  CHECK(display.frames_shown() == 3);
  for (const FrameTimes& times : display.times()) CHECK(times.shown == times.drawn);
  CHECK(display.counters().rows == 0);
}

TEST_CASE("display: of two eyes the rows of both are shown at once, from two buffers each") {
  Bench bench(3, 1000, {}, kWidth, 2);
  Display& display = bench.display;
  const auto machine = [&] {
    display.takes_pose(0);
    bench.draw(0);
    for (const std::uint32_t frame : {1U, 2U}) {
      while (!display.pose_known(frame)) sc_core::wait(display.news());
      display.takes_pose(frame);
      while (!display.buffer_free(frame)) sc_core::wait(display.news());
      wait_until(frame + 0.5);
      bench.draw(frame);
    }
  };
  const Machine thread("machine", machine);
  sc_core::sc_start();
  CHECK(display.counters().pictures == 3);
  CHECK(display.counters().rows == 3 * kHeight);
  CHECK(display.counters().rows_late == 0);
  CHECK(display.memory.bytes_read() == 3 * 2 * bench.job.frame_buffer.bytes);
  REQUIRE(bench.shown.size() == 3 * 2);
  for (const auto& [picture, byte] : bench.shown) CHECK(byte == std::byte(picture + 1));
}

// A row of 400 px takes 192 ns of a channel's bus. ports: of others, which ask for all of it.
void check_rows(double rate, bool late, int ports = 0) {
  DramConfig config;
  config.channels = 1;
  Bench bench(2, rate, config, 400);
  std::deque<Traffic> traffic;
  for (int i = 0; i < ports; ++i) {
    traffic.emplace_back(("traffic_" + std::to_string(i)).c_str(), bench, i % 4 == 3);
  }
  const auto machine = [&] {
    for (const std::uint32_t frame : {0U, 1U}) {
      while (!bench.display.pose_known(frame)) sc_core::wait(bench.display.news());
      bench.display.takes_pose(frame);
      bench.draw(frame);
    }
  };
  const Machine thread("machine", machine);
  sc_core::sc_start();
  CHECK(bench.display.frames_shown() == 2);
  const std::uint64_t rows_late = bench.display.counters().rows_late;
  CHECK((rows_late > 0) == late);
  CHECK(rows_late <= bench.display.counters().rows);
  CHECK(bench.shown.at(1) == std::byte(2));
}

TEST_CASE("display: rows that have ten times their bus time come in time") {
  check_rows(1e5, false);
}

TEST_CASE("display: rows that have six times their bus time come in time, whoever else asks") {
  check_rows(1.6e5, false, 12);
}

TEST_CASE("display: rows that have a tenth of their bus time are late, and time goes on") {
  check_rows(1e7, true);
}

}  // namespace
}  // namespace sgs::test
