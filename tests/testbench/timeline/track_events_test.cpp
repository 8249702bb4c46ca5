// A trace is what was put into it, in Perfetto's own bytes.
#include "testbench/timeline/track_events.h"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <string>

#include "tests/support/scratch_folder.h"
#include "tests/support/trace_decoder.h"

namespace sgs::test {
namespace {

TEST_CASE("track events: the bytes of an event, by hand from the schema") {
  const ScratchFolder scratch;
  OutputFile to(scratch.path("trace"));
  TrackEvents events(to);
  events.process("p");
  const TrackEvents::Track track = events.track(1, "t");
  events.begin(track, 299, events.name("busy"));
  const std::uint64_t before = events.bytes();
  events.end(track, 300);
  to.commit();
  const std::string bytes = bytes_of(scratch.path("trace"));
  CHECK(events.bytes() == bytes.size());
  const std::string end =
      "\x0a\x0d"                  // Trace.packet, 13 bytes
      "\x40\xac\x02"              // TracePacket.timestamp 300
      "\x68\x02"                  // .sequence_flags: needs incremental state
      "\x5a\x04\x48\x02\x58\x02"  // .track_event {type: slice end, track_uuid: 2}
      "\x50\x01";                 // .trusted_packet_sequence_id 1
  CHECK(bytes.substr(before) == end);
}

TEST_CASE("track events: decoded again") {
  const ScratchFolder scratch;
  OutputFile to(scratch.path("trace"));
  TrackEvents events(to);
  const auto process = events.process("machine");
  const auto unit = events.track(process, "unit");
  const auto work = events.track(unit, "work");
  const auto fill = events.counter(process, "fill", "entries");
  const auto plain = events.counter(process, "plain", "");
  const auto busy = events.name("busy"), waits = events.name(std::string(300, 'w'));
  events.begin(work, 0, "group 0");
  events.begin(work, 0, busy);
  events.value(fill, 1, std::uint64_t{1} << 63U);
  events.end(work, 200);
  events.begin(work, 200, waits);
  events.value(plain, 128, 0.125);
  events.end(work, 70000);
  events.end(work, 70000);
  to.commit();
  const DecodedTrace trace = decode_trace(bytes_of(scratch.path("trace")));
  CHECK(trace.tracks.at(work).parent == unit);
  CHECK(trace.tracks.at(unit).parent == process);
  CHECK(trace.tracks.at(work).name == "work");
  CHECK(trace.tracks.at(fill).unit == "entries");
  CHECK(trace.tracks.at(fill).values.at(0) == std::pair<std::uint64_t, double>(1, 0x1p63));
  CHECK(trace.tracks.at(plain).values.at(0).second == 0.125);
  const auto& slices = trace.tracks.at(work).slices;
  REQUIRE(slices.size() == 3);
  CHECK((slices[0].name == "group 0" && slices[0].end == 70000 && slices[0].depth == 0));
  CHECK((slices[1].name == "busy" && slices[1].end == 200 && slices[1].depth == 1));
  CHECK((slices[2].name.size() == 300 && slices[2].begin == 200));
  CHECK(events.slices() == 3);
  CHECK(events.values() == 2);
}

TEST_CASE("track events: the decoder takes nothing that is wrong") {
  const ScratchFolder scratch;
  const auto decoded = [&](const auto& write) {
    {
      OutputFile to(scratch.path("trace"));
      TrackEvents events(to);
      events.process("p");
      events.track(1, "t");
      events.counter(1, "c", "");
      write(events);
      to.commit();
    }
    return decode_trace(bytes_of(scratch.path("trace")));
  };
  CHECK_NOTHROW(decoded([](TrackEvents&) {}));
  CHECK_THROWS(decoded([](TrackEvents& e) { e.begin(2, 0, "open"); }));
  CHECK_THROWS(decoded([](TrackEvents& e) { e.end(2, 0); }));
  CHECK_THROWS(decoded([](TrackEvents& e) { e.begin(2, 0, TrackEvents::Name{7}); }));
  CHECK_THROWS(decoded([](TrackEvents& e) { e.begin(3, 0, "on a counter"); }));
  CHECK_THROWS(decoded([](TrackEvents& e) { e.value(2, 0, 1.0); }));
  CHECK_THROWS(decoded([](TrackEvents& e) { e.value(9, 0, 1.0); }));
  CHECK_THROWS(decoded([](TrackEvents& e) {
    e.value(3, 5, 1.0);
    e.value(3, 4, 1.0);
  }));
  const std::string whole = bytes_of(scratch.path("trace"));
  CHECK_THROWS(decode_trace(whole.substr(0, whole.size() - 1)));
}

TEST_CASE("track events: on a disk that is full it is an error, and no file") {
  const ScratchFolder scratch;
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{10000, RLIM_INFINITY};
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
  {
    OutputFile to(scratch.path("trace"));
    TrackEvents events(to);
    events.process("p");
    events.counter(1, "c", "");
    for (std::uint64_t i = 0; i < 5000; ++i) events.value(2, i, i);
    CHECK_THROWS_WITH(to.commit(), Catch::Contains("trace: cannot be written completely"));
  }
  CHECK(scratch.file_count() == 0);
}

}  // namespace
}  // namespace sgs::test
