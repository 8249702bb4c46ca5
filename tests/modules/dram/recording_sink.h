// Keeps the commands of a channel for a test to look at.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "modules/dram/command.h"

namespace sgs::test {

struct RecordingSink : CommandSink {
  std::vector<CommandRecord> records;

  void on_command(const CommandRecord& record) override { records.push_back(record); }

  // "ACT@100 RD@115"
  std::string text() const {
    std::string all;
    for (const CommandRecord& r : records) {
      if (!all.empty()) all += ' ';
      all += kCommandNames[static_cast<std::size_t>(r.command)];
      all += '@' + std::to_string(r.cycle);
    }
    return all;
  }

  std::size_t count(Command command) const {
    return static_cast<std::size_t>(
        std::count_if(records.begin(), records.end(),
                      [&](const CommandRecord& r) { return r.command == command; }));
  }
};

}  // namespace sgs::test
