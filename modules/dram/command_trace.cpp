// Command traces as text.
#include "modules/dram/command_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <sstream>

#include "algorithm/input_error.h"
#include "modules/config/join.h"

namespace sgs {

namespace {
constexpr const char* kFirstLine = "# streaminggs dram command trace, version 1";
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

CommandTraceWriter::CommandTraceWriter(const std::string& path, const CommandTraceHeader& header)
    : path_(path), file_(std::fopen((path + ".part").c_str(), "wb")) {
  if (file_ == nullptr)
    throw InputError(fmt::format("{}: cannot be written, expected a writable path", path));
  fmt::print(file_,
             "{}\n# memspec {}\n# channels {}\n# ranks {}\n# write_latency_set {}\n# refresh {}\n",
             kFirstLine, header.memspec, header.channels, header.ranks,
             name_of(kSets, header.write_latency_set), name_of(kModes, header.refresh));
}

CommandTraceWriter::~CommandTraceWriter() {
  if (file_ != nullptr) std::fclose(file_);
}

void CommandTraceWriter::on_command(const CommandRecord& r) {
  const std::uint32_t argument = r.command == Command::kActivate ? r.row : r.burst;
  std::fprintf(file_, "%llu %u %s %u %u %u\n", static_cast<unsigned long long>(r.cycle),
               static_cast<unsigned>(r.channel), kCommandNames[static_cast<std::size_t>(r.command)],
               static_cast<unsigned>(r.rank), static_cast<unsigned>(r.bank),
               static_cast<unsigned>(argument));
}

void CommandTraceWriter::close() {
  const bool failed = std::ferror(file_) != 0;
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  if (failed || !closed || std::rename((path_ + ".part").c_str(), path_.c_str()) != 0)
    throw InputError(fmt::format("{}: could not be written completely", path_));
}

CommandTraceReader::CommandTraceReader(const std::string& path) : path_(path), file_(path) {
  if (!file_) throw InputError(fmt::format("{}: cannot be read, expected a command trace", path));
  read_header();
}

void CommandTraceReader::refuse(const std::string& got, const std::string& expected) const {
  throw InputError(fmt::format("{}: line {}: got '{}', expected {}", path_, line_, got, expected));
}

void CommandTraceReader::read_header() {
  std::string text;
  const auto next_line = [&] {
    text.clear();
    std::getline(file_, text);
    ++line_;
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

bool CommandTraceReader::next(CommandRecord& record) {
  std::string text;
  if (!std::getline(file_, text)) return false;
  ++line_;
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
  return true;
}

}  // namespace sgs
