// A Perfetto trace of slices and counters on tracks, written by hand: of the format a dozen fields
// are needed, and a library for it would bring its compiler and its schema into the build.
//
// Fields by their numbers in protos/perfetto/trace of https://github.com/google/perfetto
// (Apache-2.0): trace_packet.proto, track_event/track_descriptor.proto,
// track_event/counter_descriptor.proto, track_event/process_descriptor.proto,
// track_event/track_event.proto, interned_data/interned_data.proto. Wire format: protobuf's.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "algorithm/files/output_file.h"

namespace sgs {

// Events of a track are to come in the order of their times; of several tracks in any. A time is a
// whole number, which viewers show as nanoseconds.
class TrackEvents {
 public:
  using Track = std::uint64_t;
  using Name = std::uint64_t;

  // Begins the trace. `to`, which whoever made it commits, outlives it.
  explicit TrackEvents(OutputFile& to);

  // Makes a track. Children are shown in the order in which they are made.
  Track process(std::string_view name);
  Track track(Track parent, std::string_view name);
  // unit: of its values; empty for a plain count.
  Track counter(Track parent, std::string_view name, std::string_view unit);

  // For slices that are called alike.
  Name name(std::string_view text);

  void begin(Track track, std::uint64_t time, Name name);
  void begin(Track track, std::uint64_t time, std::string_view name);
  void end(Track track, std::uint64_t time);
  void value(Track track, std::uint64_t time, std::uint64_t value);
  void value(Track track, std::uint64_t time, double value);

  std::uint64_t slices() const { return slices_; }
  std::uint64_t values() const { return values_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  class Message;
  Track describe(Message& descriptor);
  void event(std::uint64_t time, const Message& track_event);
  void packet(const Message& packet);

  OutputFile& to_;
  Track next_track_ = 1;
  Name next_name_ = 1;
  std::uint64_t slices_ = 0, values_ = 0, bytes_ = 0;
};

}  // namespace sgs
