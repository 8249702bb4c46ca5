// streaminggs describe: the data sheets of a machine, the keys of its configuration and the entries
// of reports, as tables in Markdown, or the keys of a memspec. The documentation's tables and its
// block diagram are made by it.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "modules/config/strict_json.h"
#include "modules/dram/memspec.h"
#include "testbench/builtin/open_scene.h"
#include "testbench/command_line/config_source.h"
#include "testbench/process/child_process.h"
#include "testbench/result/collect.h"
#include "testbench/result/frame_result.h"
#include "testbench/result/sram_budget.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/report/reported_run.h"
#include "testbench/streaminggs/report/run_report.h"
#include "testbench/streaminggs/run/prepared_scene.h"
#include "tlm/memory_port.h"
#include "tlm/time_resolution.h"

namespace sgs {
namespace {

// Prints each row once.
class Table {
 public:
  explicit Table(const char* head) {
    const auto columns = std::count(head, head + std::char_traits<char>::length(head), '|') - 1;
    fmt::print("\n{}\n|", head);
    for (long c = 0; c < columns; ++c) fmt::print(" --- |");
    fmt::print("\n");
  }
  void row(const std::string& text) {
    if (printed_.insert(text).second) fmt::print("| {} |\n", text);
  }

 private:
  std::set<std::string> printed_;
};

void print_sheets(const MachineResult& machine) {
  Table activities("| unit | activity | resource | what it does |");
  for (const UnitResult& unit : machine.units) {
    for (const ActivityResult& a : unit.activities) {
      activities.row(fmt::format("`{}` | `{}` | {} | {} ", without_numbers(unit.name), a.name,
                                 a.resource, a.meaning));
    }
  }
  Table counters("| unit | counter | unit of measure | meaning |");
  for (const UnitResult& unit : machine.units) {
    for (const CounterResult& c : unit.counters) {
      counters.row(fmt::format("`{}` | `{}` | {} | {} ", without_numbers(unit.name), c.name, c.unit,
                               c.meaning));
    }
  }
  Table parts("| component | part | how many | operations a cycle |");
  for (const Parts& part : machine.parts) {
    parts.row(fmt::format("{} | {} | {:g} | {:g} ", part.component, part.kind, part.count,
                          part.per_cycle));
  }
  Table datapaths(
      "| datapath | component | lanes | multiply-accumulates of an item | beside them | between "
      "them: bits of registers, of multiplexers, set by frame and group |");
  for (const auto& [d, items, busiest] : machine.datapaths) {
    std::string beside;
    for (const BesideLanes& part : d.beside) {
      beside += fmt::format("{}{} on {} {}", beside.empty() ? "" : ", ", part.operations,
                            d.parts(part), part.kind);
    }
    datapaths.row(fmt::format("{} | {} | {} {} | {} | {} | {}, {}, {} ", d.name, d.component,
                              d.all_lanes(), d.lane, d.used_macs, beside,
                              d.copies * std::uint64_t{d.between.registers},
                              d.copies * std::uint64_t{d.between.multiplexers}, d.set_bits));
  }
  Table sram(
      "| on-chip memory | use | bytes | built as | arithmetic | memories | ports | bits wide |");
  for (const SramUse& use : machine.sram_uses) {
    sram.row(fmt::format(
        "{} | {} | {} | {} | {} | {} | {} | {} ", use.memory, use.name, use.total_bytes(),
        use.in_registers() ? "registers" : "SRAM", use.product(), use.count * use.shape.banks,
        use.shape.ports == SramPorts::kOne ? "one" : "read and write", use.shape.width_bits));
  }
}

void print_memory(const DramConfig& dram) {
  const Memspec memspec = load_memspec(dram.memspec);
  const std::uint32_t buses = dram.buses(memspec);
  Table memory("| memory | channels | bits of a channel | most GB/s | a port's bytes a cycle |");
  memory.row(fmt::format("{} | {} | {} | {:.4g} | {} ", memspec.name, buses,
                         memspec.organisation.width_bits, buses * memspec.peak_gb_per_s(),
                         kPortBytes));
}

void print_entries(const char* head, const std::vector<ReportEntry>& entries) {
  Table table(head);
  for (const ReportEntry& entry : entries) {
    table.row(fmt::format("`{}` | {} | {} ", entry.path, entry.unit, entry.meaning));
  }
}

// Data sheets do not depend on the scene but for whether there is anything to decode.
MachineResult sheets_of(RunConfig& config) {
  Scene scene = open_scene("builtin:object?n=64");
  const Camera camera = scene.cameras.front();
  config.storage.vq.iterations = 1;
  const PreparedScene prepared = prepare(std::move(scene), config, {camera});
  const FrameJob job = config.design->job(prepared.stored, camera);
  const std::string bytes = in_child([&] {
    use_femtosecond_resolution();
    FrameResult result;
    const std::unique_ptr<Machine> machine = config.design->build("accelerator", job, {});
    check_sram_budget(*machine);
    result.machine = collect(*machine);
    return to_wire(result);
  });
  return from_wire(bytes).machine;
}

struct DescribeArguments : ConfigSource {
  std::string memspec;  // name or path; empty: the machine is described
};

}  // namespace

SubCommand add_describe_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<DescribeArguments>();
  arguments->config = kinds.front().name;
  arguments->add_to(line);
  arguments->add_fitting_to(line);
  line.text("--memspec", arguments->memspec,
            "print a memspec with a comment for each key instead: a template for another");
  for (const char* of_machine : {"--config", "--set", "--fit-memories"}) {
    line.excludes("--memspec", of_machine);
  }
  return [arguments, &kinds] {
    if (!arguments->memspec.empty()) {
      fmt::print("{}", config_to_commented_json(load_memspec(arguments->memspec)));
      return 0;
    }
    RunConfig config = read_run_config(*arguments, kinds);
    const std::unique_ptr<ConfigWriter> keys = make_listing_writer();
    visit(static_cast<ConfigVisitor&>(*keys), config);
    resolve(config);
    fmt::print("{}", keys->text());
    print_sheets(sheets_of(config));
    print_memory(config.dram);
    print_entries("| entry of a view's report.json | unit | meaning |", entries_of_view());
    print_entries("| entry of report.json of all views | unit | meaning |", entries_of_all_views());
    return 0;
  };
}

}  // namespace sgs
