#include "tests/support/trace_decoder.h"

#include <cstring>
#include <stdexcept>
#include <string_view>

namespace sgs::test {
namespace {

// One field of a message: a number, or bytes.
struct Field {
  std::uint64_t number = 0, value = 0;
  std::string_view bytes;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  bool next(Field& field) {
    if (bytes_.empty()) return false;
    const std::uint64_t key = varint();
    field = {key >> 3U, 0, {}};
    switch (key & 7U) {
      case 0:
        field.value = varint();
        break;
      case 1:
        std::memcpy(&field.value, take(8).data(), 8);
        break;
      case 2:
        field.bytes = take(varint());
        break;
      default:
        throw std::runtime_error("wire type " + std::to_string(key & 7U));
    }
    return true;
  }

 private:
  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size()) throw std::runtime_error("cut short");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const auto byte = static_cast<unsigned char>(take(1)[0]);
      value |= std::uint64_t{byte & 0x7fU} << shift;
      if (byte < 0x80) return value;
    }
    throw std::runtime_error("a number of more than 64 bits");
  }

  std::string_view bytes_;
};

using Fields = std::multimap<std::uint64_t, Field>;

Fields fields_of(std::string_view bytes) {
  Fields fields;
  Reader reader(bytes);
  for (Field field; reader.next(field);) fields.emplace(field.number, field);
  return fields;
}

std::uint64_t number_in(const Fields& fields, std::uint64_t number) {
  const auto found = fields.find(number);
  return found == fields.end() ? 0 : found->second.value;
}

std::string text_in(const Fields& fields, std::uint64_t number) {
  const auto found = fields.find(number);
  return found == fields.end() ? "" : std::string(found->second.bytes);
}

class Decoder {
 public:
  void packet(std::string_view bytes) {
    const Fields fields = fields_of(bytes);
    ++trace.packets;
    if (number_in(fields, 10) != 1) throw std::runtime_error("a packet of no sequence");
    if (trace.packets == 1 && number_in(fields, 13) != 1) {
      throw std::runtime_error("the first packet does not begin a sequence");
    }
    for (const auto& [number, field] : fields) {
      if (number == 12) intern(field.bytes);
      if (number == 60) describe(field.bytes);
      if (number == 11) event(number_in(fields, 8), fields_of(field.bytes));
    }
  }

  void finish() const {
    for (const auto& [uuid, open] : open_) {
      if (!open.empty()) throw std::runtime_error("a slice without an end");
    }
  }

  DecodedTrace trace;

 private:
  void intern(std::string_view bytes) {
    for (const auto& [number, entry] : fields_of(bytes)) {
      const Fields fields = fields_of(entry.bytes);
      if (number == 2) names_[number_in(fields, 1)] = text_in(fields, 2);
    }
  }

  void describe(std::string_view bytes) {
    const Fields fields = fields_of(bytes);
    TraceTrack& track = trace.tracks[number_in(fields, 1)];
    track.name = text_in(fields, 2);
    track.parent = number_in(fields, 5);
    track.counter = fields.count(8) > 0;
    if (track.parent != 0 && trace.tracks.count(track.parent) == 0) {
      throw std::runtime_error("a track before its parent");
    }
    if (track.counter) track.unit = text_in(fields_of(fields.find(8)->second.bytes), 6);
  }

  void event(std::uint64_t time, const Fields& fields) {
    const std::uint64_t uuid = number_in(fields, 11), type = number_in(fields, 9);
    const auto found = trace.tracks.find(uuid);
    if (found == trace.tracks.end()) throw std::runtime_error("an event of no track");
    TraceTrack& track = found->second;
    if (track.counter != (type == 4)) throw std::runtime_error("not an event for its track");
    std::uint64_t& last = last_[uuid];
    if (time < last) throw std::runtime_error("time goes back on " + track.name);
    last = time;
    std::vector<std::size_t>& open = open_[uuid];
    if (type == 4) {
      double value = static_cast<double>(number_in(fields, 30));
      if (fields.count(44) > 0) std::memcpy(&value, &fields.find(44)->second.value, sizeof value);
      track.values.emplace_back(time, value);
    } else if (type == 1) {
      std::string name = text_in(fields, 23);
      if (name.empty()) name = names_.at(number_in(fields, 10));
      open.push_back(track.slices.size());
      track.slices.push_back({name, time, 0, open.size() - 1});
    } else if (type == 2) {
      if (open.empty()) throw std::runtime_error("an end without a begin");
      track.slices[open.back()].end = time;
      open.pop_back();
    } else {
      throw std::runtime_error("an event of type " + std::to_string(type));
    }
  }

  std::map<std::uint64_t, std::string> names_;
  std::map<std::uint64_t, std::uint64_t> last_;
  std::map<std::uint64_t, std::vector<std::size_t>> open_;  // slices, by track
};

}  // namespace

DecodedTrace decode_trace(const std::string& bytes) {
  Decoder decoder;
  Reader reader(bytes);
  for (Field field; reader.next(field);) {
    if (field.number != 1) throw std::runtime_error("no packet of a trace");
    decoder.packet(field.bytes);
  }
  decoder.finish();
  return std::move(decoder.trace);
}

}  // namespace sgs::test
