// Reading and checking a DRAM device's description.
#include "modules/dram/memspec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "algorithm/files/data_files.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "modules/config/strict_json.h"
#include "modules/dram/command_bus.h"
#include "modules/dram/dramsys_memspec.h"

namespace sgs {

namespace {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool power_of_two(std::uint64_t n) { return n != 0 && (n & (n - 1)) == 0; }
}  // namespace

static void visit(ConfigVisitor& v, Memspec::Organisation& o) {
  v("width_bits", o.width_bits, in_range(8, 128),
    "data bus of a channel, or of a pseudo-channel; a power of two");
  v("burst_length", o.burst_length, in_range(2, 64), "beats a burst, a power of two");
  v("beats_per_clock", o.beats_per_clock, in_range(1, 16),
    "data rate: beats of the data bus in a clock cycle, a power of two");
  v("pseudo_channels", o.pseudo_channels, in_range(1, 4),
    "pseudo-channels a channel, each with a data bus and banks of its own; a power of two");
  v("banks", o.banks, in_range(1, 64), "banks a rank, a power of two");
  v("bank_groups", o.bank_groups, in_range(1, 16), "bank groups a rank, a power of two; 1: none");
  v("banks_per_refresh", o.banks_per_refresh, in_range(1, 64),
    "banks that one per-bank refresh takes, of different groups; a power of two");
  v("rows", o.rows, in_range(1, 1 << 20), "rows a bank, a power of two");
  v("columns", o.columns, in_range(1, 1 << 16),
    "columns a row, each width_bits wide; a power of two and a multiple of burst_length");
}

static void visit(ConfigVisitor& v, Memspec::CommandBus& b) {
  const ConfigRange cycles = in_range(1, 8);
  v("activate", b.activate, cycles, "cycles that an activate takes");
  v("activate_gap", b.activate_gap, in_range(0, 8),
    "cycles between the two commands of an activate, in which others may come; 0: none");
  v("column", b.column, cycles, "cycles that a read or write takes, at most ccd");
  v("row", b.row, cycles, "cycles that a precharge, refresh or self-refresh command takes");
  v("buses", b.buses, in_range(1, 2), "2: reads and writes have a command bus of their own");
}

static void visit(ConfigVisitor& v, Memspec::Timing& t) {
  const ConfigRange cycles = in_range(1, 1000000), or_zero = in_range(0, 1000000);
  v("read_latency", t.read_latency, cycles, "RL: read command to the first datum, without tDQSCK");
  v("write_latency_a", t.write_latency_a, cycles,
    "WL: write command to the first datum, mode-register set A");
  v("write_latency_b", t.write_latency_b, cycles, "WL of mode-register set B; equal where one is");
  v("dqss", t.dqss, in_range(0, 1000), "tDQSS: added to WL for the first datum of a write");
  v("rcd", t.rcd, cycles, "tRCD: activate to read, and to write");
  v("rcd_write", t.rcd_write, or_zero, "tRCDWR: activate to write, at most ras; 0: rcd");
  v("rp_bank", t.rp_bank, cycles, "tRPpb: precharge of one bank to its next activate");
  v("rp_all", t.rp_all, cycles, "tRPab: precharge of all banks, at least rp_bank");
  v("ras", t.ras, cycles, "tRAS: activate to precharge, at least rcd");
  v("rc", t.rc, cycles, "tRC: activate to activate of one bank, at least ras");
  v("ccd", t.ccd, cycles,
    "tCCD, tCCD_S: column to column command, at least burst_length / beats_per_clock");
  v("rrd", t.rrd, cycles, "tRRD, tRRD_S: activate to activate of another bank");
  v("faw", t.faw, cycles, "tFAW: window of at most four activates, at least rrd");
  v("rtp", t.rtp, cycles, "tRTP: read to precharge");
  v("wr", t.wr, cycles, "tWR: end of write data to precharge");
  v("wtr", t.wtr, cycles, "tWTR, tWTR_S: end of write data to read");
  v("ccd_l", t.ccd_l, or_zero, "tCCD_L: ccd within a bank group, at least ccd; 0: no groups");
  v("ccd_l_write", t.ccd_l_write, or_zero, "tCCD_L_WR: likewise of writes; 0: ccd_l");
  v("rrd_l", t.rrd_l, or_zero, "tRRD_L: rrd within a bank group, at least rrd; 0: no groups");
  v("wtr_l", t.wtr_l, or_zero, "tWTR_L: wtr within a bank group, at least wtr; 0: no groups");
  v("rtw", t.rtw, or_zero,
    "tRTW: read to write command; 0: RL + tDQSCK + burst_length / beats_per_clock + 1 - WL");
  v("dqsck_min", t.dqsck_min, in_range(0, 1000), "tDQSCK: clock to strobe of a read, shortest");
  v("dqsck_max", t.dqsck_max, in_range(0, 1000), "tDQSCK, longest");
  v("rfc_all", t.rfc_all, cycles, "tRFCab: all-bank refresh");
  v("rfc_bank", t.rfc_bank, cycles, "tRFCpb: per-bank refresh");
  v("refi", t.refi, cycles, "tREFI: interval of all-bank refreshes, more than rfc_all + rcd");
  v("refi_bank", t.refi_bank, cycles,
    "tREFIpb: interval of per-bank refreshes, more than pbr2pbr or rfc_bank; as a rule refi x "
    "banks_per_refresh / banks, of DDR5 half of it");
  v("pbr2pbr", t.pbr2pbr, or_zero,
    "tpbR2pbR: per-bank refresh to that of another bank, at most rfc_bank; 0: rfc_bank");
  v("pbr2act", t.pbr2act, or_zero,
    "tpbR2act, tRREFD: per-bank refresh to activate of another bank; 0: rrd");
  v("xp", t.xp, cycles, "tXP: power-down exit to the next command");
  v("cke", t.cke, cycles, "tCKE: shortest power-down");
  v("cke_self_refresh", t.cke_self_refresh, cycles, "tCKESR: shortest self-refresh");
  v("xsr", t.xsr, cycles, "tXSR: self-refresh exit to the next command");
  v("rtrs", t.rtrs, in_range(0, 1000), "tRTRS: data bus hand-over between ranks");
  v("ras_max", t.ras_max, cycles, "longest time that a row may stay open, more than refi");
}

static void visit(ConfigVisitor& v, Memspec::Hot& h) {
  v("refresh_divisor", h.refresh_divisor, in_range(1, 8), "refi and refi_bank are divided by it");
  v("derating_ns", h.derating_ns, in_range(0.0, 10.0), "added to tRCD, tRP, tRAS, tRC and tRRD");
  v("pbr2pbr_ns", h.pbr2pbr_ns, in_range(0.0, 1000.0), "pbr2pbr when hot; 0: as it is");
}

static void visit(ConfigVisitor& v, Memspec::Rail& r) {
  const ConfigRange ma = in_range(0.0, 10000.0);
  v("idd0", r.idd0, ma, "activate and precharge, one each tRC");
  v("idd2p", r.idd2p, ma, "precharged power-down");
  v("idd2n", r.idd2n, ma, "precharged standby");
  v("idd3p", r.idd3p, ma, "active power-down");
  v("idd3n", r.idd3n, ma, "active standby");
  v("idd4r", r.idd4r, ma, "read bursts without gaps");
  v("idd4w", r.idd4w, ma, "write bursts without gaps");
  v("idd5", r.idd5, ma, "all-bank refreshes without gaps");
  v("idd6", r.idd6, ma, "self-refresh");
}

static void visit(ConfigVisitor& v, Memspec::Currents& c) {
  v("vdd1_v", c.vdd1_v, in_range(0.1, 5.0), "first rail");
  v("vdd2_v", c.vdd2_v, in_range(0.1, 5.0), "second rail");
  v.section("vdd1_ma", c.vdd1_ma, "first rail of one rank");
  v.section("vdd2_ma", c.vdd2_ma, "second rail of one rank");
}

void visit(ConfigVisitor& v, Memspec& m) {
  v("name", m.name, "what it is called");
  v("description", m.description, "what device it is");
  v.section("organisation", m.organisation, "sizes");
  v.section("command_bus", m.command_bus,
            "cycles of the command bus that a command takes; timings count from the last");
  v("clock_period_ns", m.clock_period_ns, in_range(0.1, 100.0), "tCK");
  v.section("timing_cycles", m.timing_cycles, "constraints in clock cycles, named as by JESD209-3");
  v("refresh_order", m.refresh_order,
    names<RefreshOrder>({{"in_turn", RefreshOrder::kInTurn}, {"any", RefreshOrder::kAny}}),
    "banks of per-bank refresh: in_turn: the device's counter names them (LPDDR3); any: the "
    "command does, each once before any twice (LPDDR4)");
  v("refresh_postpone_limit", m.refresh_postpone_limit, in_range(0, 8),
    "refreshes that may be owed beyond the one that is due");
  v.section("hot", m.hot, "rule for dram.memspec=NAME:hot, above 85 degrees Celsius");
  v("io_pj_per_bit", m.io_pj_per_bit, in_range(0.0, 100.0),
    "I/O energy of a transferred bit, which no set of currents has");
  v("io_pj_per_bit_low", m.io_pj_per_bit_low, in_range(0.0, 100.0),
    "least that its sources allow, at most io_pj_per_bit; 0: two thirds of it, as of LPDDR3");
  v("io_pj_per_bit_high", m.io_pj_per_bit_high, in_range(0.0, 100.0),
    "most, at least io_pj_per_bit; 0: four thirds of it");
  v("current_spread", m.current_spread, in_range(0.0, 10.0),
    "factor, both ways, within which the currents of a set are known, at least 1; 0: 1.4 where "
    "there is one set, else 1");
  v("default_currents", m.default_currents, "the set that is used where none is asked for");
  v.sections("currents", m.currents, "published sets of currents, each under a name");
  v.strings("sources", m.sources,
            "where each number comes from, by its key without timing_cycles; organisation, "
            "command_bus and currents.NAME as a whole; default: of all others");
}

std::vector<std::string> shipped_memspecs() {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(data_file("memspecs")))
    if (entry.path().extension() == ".json") found.push_back(entry.path().stem().string());
  std::sort(found.begin(), found.end());
  return found;
}

namespace {

bool is_hot(const std::string& name) {
  const std::string suffix = kHotSuffix;
  return name.size() > suffix.size() &&
         name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0;
}

void heat(Memspec& m) {
  constexpr double kRounding = 1e-9;
  const auto cycles_of = [&](double ns) {
    return static_cast<std::uint32_t>(std::ceil(ns / m.clock_period_ns - kRounding));
  };
  const std::uint32_t more = cycles_of(m.hot.derating_ns);
  Memspec::Timing& t = m.timing_cycles;
  if (m.hot.pbr2pbr_ns > 0) t.pbr2pbr = cycles_of(m.hot.pbr2pbr_ns);
  for (std::uint32_t* cycles :
       {&t.rcd, &t.rp_bank, &t.rp_all, &t.ras, &t.rc, &t.rrd, &t.rrd_l, &t.rcd_write, &t.pbr2act}) {
    if (*cycles > 0) *cycles += more;
  }
  t.faw = std::max(t.faw, t.rrd);
  t.refi /= m.hot.refresh_divisor;
  t.refi_bank /= m.hot.refresh_divisor;
  m.name += kHotSuffix;
}

}  // namespace

std::string memspec_path(const std::string& name_or_path) {
  const std::string name =
      is_hot(name_or_path) ? name_or_path.substr(0, name_or_path.rfind(kHotSuffix)) : name_or_path;
  const std::string shipped = data_file("memspecs") + "/" + name + ".json";
  std::error_code missing;
  return fs::exists(shipped, missing) ? shipped : name;
}

namespace {

Memspec read_checked(const ConfigDocument& document, const std::string& path, bool hot) {
  Memspec memspec;
  document.read_into(memspec);
  check_memspec(memspec, path);
  if (!hot) return memspec;
  heat(memspec);
  check_memspec(memspec, path + kHotSuffix);
  return memspec;
}

Memspec read_dramsys(const Json& json, const std::string& path, bool hot) {
  std::vector<std::string> notes;
  ConfigDocument document;
  document.add_text(converted_from_dramsys(json, path, notes)
                        .dump(-1, ' ', false, Json::error_handler_t::replace),
                    path);
  try {
    Memspec memspec = read_checked(document, path, hot);
    memspec.notes = std::move(notes);
    return memspec;
  } catch (const InputError& error) {
    const std::string said = in_dramsys_keys(error.what(), path, json);
    throw InputError(in_dramsys_keys(said, path + kHotSuffix, json));
  }
}

}  // namespace

Memspec load_memspec(const std::string& name_or_path) {
  const std::string path = memspec_path(name_or_path);
  std::error_code missing;
  if (!fs::exists(path, missing))
    throw InputError(fmt::format("dram.memspec: got '{}', expected a JSON file or one of {}",
                                 name_or_path, join(shipped_memspecs())));
  const bool hot = is_hot(name_or_path);
  if (const Json json = read_json(path); is_dramsys_memspec(json))
    return read_dramsys(json, path, hot);
  ConfigDocument document;
  document.add_file(path);
  return read_checked(document, path, hot);
}

namespace {

// Timing keys and their values, gathered by the same description that reads them.
class KeyCollector : public ConfigVisitor {
 public:
  std::vector<std::pair<std::string, std::int64_t>> values;
  std::vector<std::string> zero_keys;

 protected:
  void on_bool(const char*, bool&, const char*) override {}
  void on_string(const char*, std::string&, const char*) override {}
  void on_real(const char*, double&, ConfigRange, const char*) override {}
  void on_open_real(const char*, std::optional<double>&, ConfigRange, const char*) override {}
  void on_reals(const char*, std::vector<double>&, ConfigRange, const char*) override {}
  void on_integer(const char* key, std::int64_t& value, ConfigRange range, const char*) override {
    values.emplace_back(key, value);
    if (static_cast<long double>(value) < range.lo) zero_keys.push_back(key);
  }
  void on_choice(const char*, std::size_t&, const std::vector<const char*>&, const char*) override {
  }
  void begin_section(const char*, const char*) override {}
  void end_section() override {}
  std::vector<std::string> free_keys(const std::vector<std::string>& present) override {
    return present;
  }
};

class MemspecCheck {
 public:
  MemspecCheck(const Memspec& memspec, const std::string& origin) : m_(memspec), origin_(origin) {}

  void require(bool holds, const char* key, double got, const std::string& expected) const {
    if (!holds)
      throw InputError(fmt::format("{}: {}: got {}, expected {}", origin_, key, got, expected));
  }

  void organisation() const {
    const Memspec::Organisation& o = m_.organisation;
    require(power_of_two(o.width_bits), "organisation.width_bits", o.width_bits, "a power of two");
    require(power_of_two(o.burst_length), "organisation.burst_length", o.burst_length,
            "a power of two");
    require(power_of_two(o.beats_per_clock) && o.beats_per_clock <= o.burst_length,
            "organisation.beats_per_clock", o.beats_per_clock,
            fmt::format("a power of two, at most burst_length {}", o.burst_length));
    require(power_of_two(o.pseudo_channels) && o.pseudo_channels <= m_.burst_cycles(),
            "organisation.pseudo_channels", o.pseudo_channels,
            fmt::format("a power of two, at most burst_length / beats_per_clock = {}: they share "
                        "the channel's column commands",
                        m_.burst_cycles()));
    require(power_of_two(o.banks), "organisation.banks", o.banks, "a power of two");
    require(power_of_two(o.bank_groups) && o.bank_groups <= o.banks, "organisation.bank_groups",
            o.bank_groups, fmt::format("a power of two, at most banks {}", o.banks));
    require(power_of_two(o.banks_per_refresh) && o.banks_per_refresh <= o.banks,
            "organisation.banks_per_refresh", o.banks_per_refresh,
            fmt::format("a power of two, at most banks {}", o.banks));
    require(power_of_two(o.rows), "organisation.rows", o.rows, "a power of two");
    require(power_of_two(o.columns), "organisation.columns", o.columns, "a power of two");
    require(o.columns >= o.burst_length && o.columns % o.burst_length == 0, "organisation.columns",
            o.columns, fmt::format("a multiple of burst_length {}", o.burst_length));
    require(m_.clock_period_ns > 0, "clock_period_ns", m_.clock_period_ns, "more than 0");
    if (m_.io_pj_per_bit < 0)
      throw InputError(fmt::format(
          "{}: io_pj_per_bit: got nothing, expected picojoules of a transferred bit", origin_));
  }

  void energy_bounds() const {
    const std::string io = fmt::format("io_pj_per_bit {}", m_.io_pj_per_bit);
    require(m_.io_pj_per_bit_low <= m_.io_pj_per_bit, "io_pj_per_bit_low", m_.io_pj_per_bit_low,
            "at most " + io);
    require(m_.io_pj_per_bit_high == 0 || m_.io_pj_per_bit_high >= m_.io_pj_per_bit,
            "io_pj_per_bit_high", m_.io_pj_per_bit_high, "at least " + io);
    require(m_.current_spread == 0 || m_.current_spread >= 1, "current_spread", m_.current_spread,
            "at least 1, or 0");
  }

  void timing() const {
    const Memspec::Timing& t = m_.timing_cycles;
    require(t.ccd >= m_.burst_cycles(), "timing_cycles.ccd", t.ccd,
            fmt::format("at least burst_length / beats_per_clock = {}", m_.burst_cycles()));
    const Memspec::CommandBus& bus = m_.command_bus;
    require(bus.column <= t.ccd, "command_bus.column", bus.column,
            fmt::format("at most ccd {}", t.ccd));
    require(bus.activate_gap == 0 || bus.activate == 2, "command_bus.activate", bus.activate,
            "2: activate_gap parts two commands");
    require(t.ras >= t.rcd, "timing_cycles.ras", t.ras, fmt::format("at least rcd {}", t.rcd));
    require(t.rc >= t.ras, "timing_cycles.rc", t.rc, fmt::format("at least ras {}", t.ras));
    require(t.rp_all >= t.rp_bank, "timing_cycles.rp_all", t.rp_all,
            fmt::format("at least rp_bank {}", t.rp_bank));
    require(t.faw >= t.rrd, "timing_cycles.faw", t.faw, fmt::format("at least rrd {}", t.rrd));
    require(t.dqsck_max >= t.dqsck_min, "timing_cycles.dqsck_max", t.dqsck_max,
            fmt::format("at least dqsck_min {}", t.dqsck_min));
    require(t.ras_max > t.refi, "timing_cycles.ras_max", t.ras_max,
            fmt::format("more than refi {}: a refresh closes every row in time", t.refi));
    require(t.read_latency + t.dqsck_max + m_.burst_cycles() + 1 >
                std::max(t.write_latency_a, t.write_latency_b),
            "timing_cycles.write_latency_b", t.write_latency_b, "less than RL + DQSCK + BL/2 + 1");
    require(t.rcd_write <= t.ras, "timing_cycles.rcd_write", t.rcd_write,
            fmt::format("at most ras {}", t.ras));
    require(t.pbr2pbr <= t.rfc_bank, "timing_cycles.pbr2pbr", t.pbr2pbr,
            fmt::format("at most rfc_bank {}", t.rfc_bank));
  }

  void bank_groups() const {
    const Memspec::Timing& t = m_.timing_cycles;
    const auto within = [&](const char* key, std::uint32_t cycles, const char* other,
                            std::uint32_t least) {
      if (m_.organisation.bank_groups == 1)
        require(cycles == 0, key, cycles, "0: organisation.bank_groups is 1");
      else
        require(cycles >= least, key, cycles, fmt::format("at least {} {}", other, least));
    };
    within("timing_cycles.ccd_l", t.ccd_l, "ccd", t.ccd);
    within("timing_cycles.rrd_l", t.rrd_l, "rrd", t.rrd);
    within("timing_cycles.wtr_l", t.wtr_l, "wtr", t.wtr);
    if (t.ccd_l_write > 0) within("timing_cycles.ccd_l_write", t.ccd_l_write, "ccd", t.ccd);
  }

  // Refresh goes before requests. Where one of these does not hold it leaves no request room, and
  // a simulation would never end.
  void refresh() const {
    const Memspec::Timing& t = m_.timing_cycles;
    // What a refresh and an activate take of the command bus beyond a cycle each.
    const CommandShapes shapes = command_shapes(m_.command_bus);
    const std::uint32_t bus = shapes[static_cast<std::size_t>(Command::kRefreshBank)].lead +
                              shapes[static_cast<std::size_t>(Command::kActivate)].lead;
    const std::string with = bus == 0 ? "" : fmt::format(" + {} of the command bus", bus);
    const std::string without = bus == 0 ? "" : fmt::format(" - {} of the command bus", bus);
    require(t.refi > t.rfc_all + t.rcd + bus, "timing_cycles.refi", t.refi,
            fmt::format("more than rfc_all {} + rcd {}{}: room for an activate between refreshes",
                        t.rfc_all, t.rcd, with));
    if (t.pbr2pbr == 0)
      require(t.refi_bank > t.rfc_bank + bus, "timing_cycles.refi_bank", t.refi_bank,
              fmt::format("more than rfc_bank {}{}", t.rfc_bank, with));
    else
      require(t.refi_bank > t.pbr2pbr + bus, "timing_cycles.refi_bank", t.refi_bank,
              fmt::format("more than pbr2pbr {}{}", t.pbr2pbr, with));
    if (t.pbr2act > 0)
      require(
          t.pbr2act >= t.rrd && t.pbr2act + bus < t.refi_bank, "timing_cycles.pbr2act", t.pbr2act,
          fmt::format("at least rrd {}, less than refi_bank {}{}", t.rrd, t.refi_bank, without));
    // A per-bank refresh counts as an activate.
    require(t.rrd + bus < t.refi_bank, "timing_cycles.rrd", t.rrd,
            fmt::format("less than refi_bank {}{}: room for an activate between refreshes",
                        t.refi_bank, without));
    require(t.faw < 4 * (t.refi_bank - bus), "timing_cycles.faw", t.faw,
            fmt::format("less than 4 x refi_bank {}{}: room for an activate among four refreshes",
                        t.refi_bank, without));
    const std::uint32_t banks = m_.refresh_sets();
    const std::uint32_t row_cycle = t.rfc_bank + t.rrd + t.ras + t.rp_bank + bus;
    require(banks * t.refi_bank > row_cycle, "timing_cycles.refi_bank", t.refi_bank,
            fmt::format("{} banks x refi_bank above {}, which is rfc_bank {} + rrd {} + ras {} + "
                        "rp_bank {}{}: room for a row between a bank's refreshes",
                        banks, row_cycle, t.rfc_bank, t.rrd, t.ras, t.rp_bank, with));
  }

  // A number that its key has by itself needs no source.
  void sources(const KeyCollector& timing, const KeyCollector& without) const {
    std::vector<std::string> known;
    std::vector<std::string> may_have = {kDefaultSource, "refresh_postpone_limit", "hot",
                                         "current_spread", "command_bus"};
    for (std::size_t i = 0; i < timing.values.size(); ++i) {
      const auto& [key, value] = timing.values[i];
      const std::vector<std::string>& none = without.zero_keys;
      const bool needs = value != without.values[i].second ||
                         std::find(none.begin(), none.end(), key) != none.end();
      (needs ? known : may_have).push_back(key);
    }
    known.insert(known.end(),
                 {"organisation", "clock_period_ns", "refresh_order", "io_pj_per_bit"});
    for (const auto& set : m_.currents) known.push_back("currents." + set.first);
    const auto stated = [&](const std::string& key) {
      return m_.sources.count(key) > 0 && !m_.sources.at(key).empty();
    };
    for (const std::string& key : known)
      if (!stated(key) && !stated(kDefaultSource))
        throw InputError(fmt::format(
            "{}: sources.{}: got nothing, expected where '{}' comes from, or sources.{}", origin_,
            key, key, kDefaultSource));
    known.insert(known.end(), may_have.begin(), may_have.end());
    for (const auto& source : m_.sources)
      if (std::find(known.begin(), known.end(), source.first) == known.end())
        throw InputError(fmt::format("{}: sources.{}: unknown key, expected the name of a number",
                                     origin_, source.first));
  }

  std::vector<std::string> warnings() const {
    const Memspec::Timing& t = m_.timing_cycles;
    std::vector<std::string> found = m_.notes;
    if (t.rc != t.ras + t.rp_bank)
      found.push_back(fmt::format(
          "{}: rc is {} but ras + rp_bank is {}: an explicit precharge always costs the latter",
          m_.name, t.rc, t.ras + t.rp_bank));
    if (t.write_latency_a != t.write_latency_b)
      found.push_back(fmt::format("{}: WL is {} (set A) or {} (set B): write_latency_set decides",
                                  m_.name, t.write_latency_a, t.write_latency_b));
    const std::uint32_t rounds = m_.refreshes_of_set(),
                        all_sets = rounds * t.refi_bank * m_.refresh_sets();
    if (all_sets != t.refi)
      found.push_back(fmt::format(
          "{}: refi is {} but {}refi_bank x {} is {}", m_.name, t.refi,
          rounds == 1 ? "" : fmt::format("{} x ", rounds),
          m_.organisation.banks_per_refresh == 1 ? "banks" : "banks / banks_per_refresh",
          all_sets));
    return found;
  }

 private:
  const Memspec& m_;
  const std::string& origin_;
};

}  // namespace

std::vector<std::string> check_memspec(const Memspec& memspec, const std::string& origin) {
  KeyCollector timing_keys, without;
  Memspec::Timing timing = memspec.timing_cycles, unset;
  visit(timing_keys, timing);
  visit(without, unset);
  if (!timing_keys.zero_keys.empty())
    throw InputError(fmt::format("{}: timing_cycles.{}: got 0 or nothing, expected at least 1",
                                 origin, timing_keys.zero_keys.front()));
  const MemspecCheck check(memspec, origin);
  check.organisation();
  check.energy_bounds();
  check.timing();
  check.bank_groups();
  check.refresh();
  if (memspec.currents.count(memspec.default_currents) == 0)
    throw InputError(fmt::format("{}: default_currents: got '{}', expected the name of a set",
                                 origin, memspec.default_currents));
  check.sources(timing_keys, without);
  return check.warnings();
}

}  // namespace sgs
