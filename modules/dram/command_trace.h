// Command traces as text: the commands of a simulation, for the checker and for people.
//
//   # streaminggs dram command trace, version 2
//   # memspec lpddr3_1600_4gb
//   # channels 4
//   # ranks 1
//   # write_latency_set a
//   # refresh all_bank
//   0 0 ACT 0 3 17
//   # commands 1
//
// A line is: cycle channel command rank bank argument. Commands are kCommandNames; the argument is
// the row of an ACT, the burst within the row of a RD, RDA, WR or WRA, else 0. Lines of a channel
// are in the order of their cycles; channels are mixed. The last line says how many there are, so
// that a file that was cut is known.
#pragma once

#include <string>

#include "algorithm/files/input_file.h"
#include "algorithm/files/output_file.h"
#include "modules/dram/command.h"
#include "modules/dram/dram_config.h"

namespace sgs {

// Configuration that a checker needs besides the commands.
struct CommandTraceHeader {
  std::string memspec;
  std::uint32_t channels = 1;
  std::uint32_t ranks = 1;
  WriteLatencySet write_latency_set = WriteLatencySet::kA;
  RefreshMode refresh = RefreshMode::kAllBank;

  static CommandTraceHeader of(const DramConfig& config) {
    return {config.memspec, config.channels, config.ranks, config.write_latency_set,
            config.refresh};
  }
};

class CommandTraceWriter : public CommandSink {
 public:
  // Writes the commands of `source` from now on to `to`, which whoever made it commits.
  CommandTraceWriter(OutputFile& to, const CommandTraceHeader& header, CommandSource& source);
  ~CommandTraceWriter() override;
  CommandTraceWriter(const CommandTraceWriter&) = delete;
  CommandTraceWriter& operator=(const CommandTraceWriter&) = delete;

  void on_command(const CommandRecord& record) override;

  // Everything up to now is in the file, and nothing later, whatever the source is asked for then.
  // std::runtime_error when something could not be written.
  void close();

 private:
  OutputFile& to_;
  CommandSource& source_;
  std::uint64_t commands_ = 0;
};

class CommandTraceReader {
 public:
  // InputError: not there, not a trace, a header line missing.
  explicit CommandTraceReader(const std::string& path);

  const CommandTraceHeader& header() const { return header_; }
  std::uint64_t line() const { return lines_.line_number(); }

  // False at the end. InputError with file and line: a line that is no command, an end that is
  // missing or counts others.
  bool next(CommandRecord& record);

 private:
  void read_header();
  void check_end(const std::string& line);
  [[noreturn]] void refuse(const std::string& got, const std::string& expected) const;

  LineReader lines_;
  CommandTraceHeader header_;
  std::uint64_t commands_ = 0;  // so far
};

}  // namespace sgs
