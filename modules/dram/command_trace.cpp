// Command traces as text.
#include "modules/dram/command_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>

#include "algorithm/files/input_error.h"

namespace sgs {

namespace {
constexpr std::string_view kEnd = "# commands ";
constexpr const char* kFirstLine = "# streaminggs dram command trace, version 2";
const std::map<std::string, WriteLatencySet> kSets = {{"a", WriteLatencySet::kA},
                                                      {"b", WriteLatencySet::kB}};
const std::map<std::string, RefreshMode> kModes = {{"off", RefreshMode::kOff},
                                                   {"all_bank", RefreshMode::kAllBank},
                                                   {"per_bank", RefreshMode::kPerBank}};

template <class Value>
std::string name_of(const std::map<std::string, Value>& names, Value value) {
  return std::find_if(names.begin(), names.end(),
                      [&](const auto& entry) { return entry.second == value; })
      ->first;
}
}  // namespace

CommandTraceWriter::CommandTraceWriter(OutputFile& to, const CommandTraceHeader& header,
                                       CommandSource& source)
    : to_(to), source_(source) {
  to_.write(fmt::format(
      "{}\n# memspec {}\n# channels {}\n# ranks {}\n# write_latency_set {}\n# refresh {}\n",
      kFirstLine, header.memspec, header.channels, header.ranks,
      name_of(kSets, header.write_latency_set), name_of(kModes, header.refresh)));
  source_.add_command_sink(*this);
}

CommandTraceWriter::~CommandTraceWriter() { source_.remove_command_sink(*this); }

void CommandTraceWriter::on_command(const CommandRecord& r) {
  const std::uint32_t argument = r.command == Command::kActivate ? r.row : r.burst;
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), "{} {} {} {} {} {}\n", r.cycle, r.channel,
                 kCommandNames[static_cast<std::size_t>(r.command)], r.rank, r.bank, argument);
  to_.write(line.data(), line.size());
  ++commands_;
}

void CommandTraceWriter::close() {
  source_.catch_up();
  source_.remove_command_sink(*this);
  to_.write(fmt::format("{}{}\n", kEnd, commands_));
  to_.finish();
}

CommandTraceReader::CommandTraceReader(const std::string& path) : lines_(path) { read_header(); }

void CommandTraceReader::refuse(const std::string& got, const std::string& expected) const {
  throw InputError(fmt::format("{}: line {}: got '{}', expected {}", lines_.path(),
                               lines_.line_number(), got, expected));
}

void CommandTraceReader::read_header() {
  std::string text;
  const auto next_line = [&] {
    std::string_view line;
    text = lines_.next(line) ? line : "";
  };
  const auto value = [&](const std::string& key) {
    next_line();
    const std::string start = "# " + key + " ";
    if (text.compare(0, start.size(), start) != 0) refuse(text, "'" + start + "...'");
    return text.substr(start.size());
  };
  const auto count = [&](const std::string& key, std::uint32_t most) {
    const std::string digits = value(key);
    const bool number = !digits.empty() && digits.size() < 6 &&
                        digits.find_first_not_of("0123456789") == std::string::npos;
    const std::uint32_t n = number ? static_cast<std::uint32_t>(std::stoul(digits)) : 0;
    if (n < 1 || n > most) refuse(digits, fmt::format("1 to {}", most));
    return n;
  };
  next_line();
  if (text != kFirstLine) refuse(text, fmt::format("'{}'", kFirstLine));
  header_.memspec = value("memspec");
  header_.channels = count("channels", 16);
  header_.ranks = count("ranks", 4);
  const std::string set = value("write_latency_set");
  if (kSets.count(set) == 0) refuse(set, "a or b");
  header_.write_latency_set = kSets.at(set);
  const std::string mode = value("refresh");
  if (kModes.count(mode) == 0) refuse(mode, "off, all_bank or per_bank");
  header_.refresh = kModes.at(mode);
}

void CommandTraceReader::check_end(const std::string& line) {
  const std::string expected = fmt::format("{}{}", kEnd, commands_);
  if (line != expected) refuse(line, fmt::format("'{}'", expected));
  std::string_view more;
  if (lines_.next(more)) refuse(std::string(more), fmt::format("nothing behind '{}'", expected));
}

bool CommandTraceReader::next(CommandRecord& record) {
  std::string_view line;
  if (!lines_.next(line))
    refuse("the end of the file", fmt::format("a command or '{}{}'", kEnd, commands_));
  const std::string text(line);
  if (text.compare(0, kEnd.size(), kEnd) == 0) {
    check_end(text);
    return false;
  }
  std::istringstream fields(text);
  std::uint64_t channel = 0, rank = 0, bank = 0, argument = 0;
  std::string command, rest;
  record = CommandRecord{};
  const bool complete =
      text.find('-') == std::string::npos &&
      static_cast<bool>(fields >> record.cycle >> channel >> command >> rank >> bank >> argument) &&
      !(fields >> rest);
  const auto found = std::find(kCommandNames.begin(), kCommandNames.end(), command);
  if (!complete || found == kCommandNames.end() || channel > 255 || rank > 255 || bank > 255 ||
      argument > std::numeric_limits<std::uint32_t>::max())
    refuse(text, fmt::format("cycle channel command rank bank argument; commands are {}",
                             join(kCommandNames)));
  record.command = static_cast<Command>(found - kCommandNames.begin());
  record.channel = static_cast<std::uint8_t>(channel);
  record.rank = static_cast<std::uint8_t>(rank);
  record.bank = static_cast<std::uint8_t>(bank);
  if (record.command == Command::kActivate)
    record.row = static_cast<std::uint32_t>(argument);
  else
    record.burst = static_cast<std::uint32_t>(argument);
  ++commands_;
  return true;
}

}  // namespace sgs
