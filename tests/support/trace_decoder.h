// A Perfetto trace taken apart, by the wire format alone.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sgs::test {

struct TraceSlice {
  std::string name;
  std::uint64_t begin = 0, end = 0;
  std::size_t depth = 0;  // 0: in no other slice of its track
};

struct TraceTrack {
  std::string name;
  std::uint64_t parent = 0;
  bool counter = false;
  std::string unit;
  std::vector<TraceSlice> slices;  // by begin, outer ones before those in them
  std::vector<std::pair<std::uint64_t, double>> values;  // time and value
};

struct DecodedTrace {
  std::map<std::uint64_t, TraceTrack> tracks;  // by uuid
  std::size_t packets = 0;
};

// Throws std::runtime_error for what is no trace: cut short, an event of no track, of a counter
// where slices are or the other way round, times of a track that go back, a name that is not known,
// an end without a begin, a slice without an end.
DecodedTrace decode_trace(const std::string& bytes);

}  // namespace sgs::test
