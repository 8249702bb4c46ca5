// Memspecs of DRAMSys.
#include "modules/dram/dramsys_memspec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"

namespace sgs {

namespace {
using Json = nlohmann::ordered_json;
using Names = std::vector<const char*>;

const Names kTypes = {"DDR3", "DDR4", "DDR5", "HBM2", "HBM3", "LPDDR4", "LPDDR5"};

struct TimingName {
  const char* ours;
  Names theirs;  // the first that is stated
};
// 0 is what files have where a value is not known.
const std::vector<TimingName> kStated = {
    {"read_latency", {"RL"}},
    {"write_latency_a", {"WL"}},
    {"dqss", {"DQSS"}},
    {"rcd", {"RCD", "RCDRD", "RCD_L"}},
    {"rcd_write", {"RCDWR"}},
    {"rp_bank", {"RPpb", "RP"}},
    {"rp_all", {"RPab", "RP"}},
    {"ras", {"RAS"}},
    {"rc", {"RC", "RCpb"}},
    {"ccd", {"CCD", "CCD_S", "CCDS", "CCD_S_slr", "BL_n_S_16"}},
    {"rrd", {"RRD", "RRD_S", "RRDS", "RRD_S_slr"}},
    {"faw", {"FAW", "FAW_slr"}},
    {"rtp", {"RTP", "RBTP"}},
    {"wr", {"WR"}},
    {"wtr", {"WTR", "WTR_S", "WTRS"}},
    {"rtw", {"RTW"}},
    {"dqsck_max", {"DQSCK", "WCK2DQO"}},
    {"rfc_all", {"RFCab", "RFC", "RFC1", "RFC1_slr"}},
    {"rfc_bank", {"RFCpb", "RFCSB", "RFCPB", "RFCsb_slr"}},
    {"refi", {"REFI", "REFI1"}},
    {"refi_bank", {"REFIpb", "REFISB", "REFIPB"}},
    {"pbr2pbr", {"pbR2pbR"}},
    {"pbr2act", {"pbR2act", "RREFD", "REFSBRD_slr"}},
    {"xp", {"XP"}},
    {"cke", {"CKE", "PD"}},
    {"cke_self_refresh", {"SR", "CKESR"}},
    {"xsr", {"XSR", "XS"}},
    {"rtrs", {"RTRS", "CCDR"}},
};
const std::vector<TimingName> kStatedOfGroups = {
    {"ccd_l", {"CCD_L", "CCDL", "CCD_L_slr", "BL_n_L_16"}},
    {"ccd_l_write", {"CCD_L_WR_slr"}},
    {"rrd_l", {"RRD_L", "RRDL", "RRD_L_slr"}},
    {"wtr_l", {"WTR_L", "WTRL"}},
};

// First and second rail: VDD1 and VDD2 (of LPDDR5 VDD2H), or VPP and VDD.
struct CurrentName {
  const char* ours;
  Names first, second;
};
const std::vector<CurrentName> kCurrents = {
    {"idd0", {"idd01", "ipp0"}, {"idd02", "idd02h", "idd0"}},
    {"idd2p", {"idd2p1", "ipp2p"}, {"idd2p2", "idd2p2h", "idd2p", "idd2p0"}},
    {"idd2n", {"idd2n1", "ipp2n"}, {"idd2n2", "idd2n2h", "idd2n"}},
    {"idd3p", {"idd3p1", "ipp3p"}, {"idd3p2", "idd3p2h", "idd3p", "idd3p0"}},
    {"idd3n", {"idd3n1", "ipp3n"}, {"idd3n2", "idd3n2h", "idd3n"}},
    {"idd4r", {"idd4r1", "ipp4r"}, {"idd4r2", "idd4r2h", "idd4r"}},
    {"idd4w", {"idd4w1", "ipp4w"}, {"idd4w2", "idd4w2h", "idd4w"}},
    {"idd5", {"idd51", "ipp5B", "ipp5b"}, {"idd52", "idd52h", "idd5B", "idd5b", "idd5"}},
    {"idd6", {"idd61", "ipp6n"}, {"idd62", "idd62h", "idd6n", "idd6"}},
};

// Other keys of ours, and the section and names that they are from.
struct OtherName {
  const char *ours, *section;
  Names theirs;
};
constexpr const char* kArchitecture = "memarchitecturespec";
const std::vector<OtherName> kOthers = {
    {"organisation.width_bits", kArchitecture, {"width"}},
    {"organisation.burst_length", kArchitecture, {"burstLength"}},
    {"organisation.beats_per_clock", kArchitecture, {"dataRate"}},
    {"organisation.pseudo_channels", kArchitecture, {"nbrOfPseudoChannels"}},
    {"organisation.banks", kArchitecture, {"nbrOfBanks"}},
    {"organisation.bank_groups", kArchitecture, {"nbrOfBankGroups"}},
    {"organisation.rows", kArchitecture, {"nbrOfRows"}},
    {"organisation.columns", kArchitecture, {"nbrOfColumns"}},
    {"clock_period_ns", "memtimingspec", {"tCK"}},
    {"command_bus.activate", "memtimingspec", {"cmdMode"}},
    {"command_bus.column", "memtimingspec", {"cmdMode"}},
    {"currents.dramsys.vdd1_v", "mempowerspec", {"vdd1", "vpp"}},
    {"currents.dramsys.vdd2_v", "mempowerspec", {"vdd2", "vdd2h", "vdd"}},
    {"io_pj_per_bit", "mempowerspec", {"idd4rq"}},
};

// The file's key that a key of ours is from; empty where it is from none alone.
std::string dramsys_key(const std::string& ours, const Json& spec) {
  // The name that is stated, or the first.
  const auto named = [&](const char* section, const Names& theirs) {
    const Json in = spec.value(section, Json::object());
    const auto stated = std::find_if(theirs.begin(), theirs.end(),
                                     [&](const char* name) { return in.value(name, 0.0) > 0; });
    return fmt::format("memspec.{}.{}", section, stated == theirs.end() ? theirs[0] : *stated);
  };
  for (const auto& timings : {kStated, kStatedOfGroups})
    for (const TimingName& name : timings)
      if (ours == std::string("timing_cycles.") + name.ours)
        return named("memtimingspec", name.theirs);
  for (const CurrentName& name : kCurrents) {
    const std::string rails = "currents.dramsys.vdd";
    if (ours == rails + "1_ma." + name.ours) return named("mempowerspec", name.first);
    if (ours == rails + "2_ma." + name.ours) return named("mempowerspec", name.second);
  }
  for (const OtherName& name : kOthers)
    if (ours == name.ours) return named(name.section, name.theirs);
  return "";
}

class Conversion {
 public:
  Conversion(const Json& spec, const std::string& origin) : spec_(spec), origin_(origin) {}

  Json run(std::vector<std::string>& notes) {
    const std::string type = text("memoryType");
    if (std::find(kTypes.begin(), kTypes.end(), type) == kTypes.end())
      refuse("memoryType", shown(spec_["memoryType"]), "one of " + join(kTypes));
    organisation(type);
    timing(type);
    power(notes);
    ours_["name"] = text("memoryId");
    ours_["description"] = fmt::format("{} as DRAMSys describes it", type);
    ours_["clock_period_ns"] = std::round(number("memtimingspec", "tCK") * 1e15) / 1e6;
    ours_["refresh_order"] = "any";
    ours_["sources"] = {{"default", "DRAMSys memspec " + origin_}};
    if (!stand_ins_.empty())
      notes.push_back(fmt::format("{}: not stated: {}", origin_, join(stand_ins_)));
    for (const char* key : {"nbrOfChannels", "nbrOfRanks"})
      if (of("memarchitecturespec", key) > 1)
        notes.push_back(fmt::format("{}: {} is {}: dram.{} decides", origin_, key,
                                    of("memarchitecturespec", key),
                                    std::string(key) == "nbrOfRanks" ? "ranks" : "channels"));
    if (const std::vector<std::string> unread = unread_numbers(); !unread.empty())
      notes.push_back(fmt::format("{}: not read: {}", origin_, join(unread)));
    return ours_;
  }

 private:
  [[noreturn]] void refuse(const std::string& key, const std::string& got,
                           const std::string& expected) const {
    throw InputError(
        fmt::format("{}: memspec.{}: got {}, expected {}", origin_, key, got, expected));
  }

  std::string text(const char* key) const {
    if (!spec_.contains(key) || !spec_[key].is_string()) refuse(key, "no text", "a text");
    return spec_[key].get<std::string>();
  }

  // 0 where it is not stated.
  double number(const char* section, const char* key) const {
    if (!spec_.contains(section)) return 0;
    const Json& in = spec_[section];
    if (!in.is_object()) refuse(section, shown(in), "an object");
    read_.insert(key);
    if (!in.contains(key)) return 0;
    if (!in[key].is_number() || in[key].get<double>() < 0)
      refuse(fmt::format("{}.{}", section, key), shown(in[key]), "a number of at least 0");
    return in[key].get<double>();
  }

  // Of organisation and timing: what is named otherwise, or is of a rule that is not kept here.
  std::vector<std::string> unread_numbers() const {
    std::vector<std::string> unread;
    for (const char* section : {"memarchitecturespec", "memtimingspec"})
      if (spec_.contains(section))
        for (const auto& [key, value] : spec_[section].items())
          if (read_.count(key) == 0 && value != 0) unread.push_back(key);
    return unread;
  }

  std::int64_t of(const char* section, const char* key) const {
    constexpr double kMost = 1 << 24;
    const double value = number(section, key);
    if (value > kMost || value != std::floor(value))
      refuse(fmt::format("{}.{}", section, key), fmt::format("{}", value), "a whole number");
    return static_cast<std::int64_t>(value);
  }

  double first_of(const char* section, const Names& names) const {
    for (const char* name : names)
      if (const double value = number(section, name); value > 0) return value;
    return 0;
  }

  void stand_in(const char* key, std::int64_t value) {
    ours_["timing_cycles"][key] = value;
    stand_ins_.push_back(fmt::format("{} {}", key, value));
  }

  void organisation(const std::string& type) {
    const auto count = [this](const char* key) { return of("memarchitecturespec", key); };
    const auto at_least_one = [&](const char* key) {
      return std::max<std::int64_t>(1, count(key));
    };
    if (count("RefMode") > 1) refuse("memarchitecturespec.RefMode", "not 1", "1");
    // Columns of HBM are whole bursts.
    const bool hbm = type == "HBM2" || type == "HBM3";
    groups_ = at_least_one("nbrOfBankGroups");
    banks_ = count("nbrOfBanks");
    std::int64_t together = 1;
    if (type == "DDR5") together = groups_;
    if (type == "LPDDR5" && count("per2BankOffset") > 0) together = 2;
    if (first_of("memtimingspec", {"RFCpb", "RFCSB", "RFCPB", "RFCsb_slr"}) == 0) together = banks_;
    ours_["organisation"] = {{"width_bits", count("width") * at_least_one("nbrOfDevices")},
                             {"burst_length", count("burstLength")},
                             {"beats_per_clock", count("dataRate")},
                             {"pseudo_channels", at_least_one("nbrOfPseudoChannels")},
                             {"banks", banks_},
                             {"bank_groups", groups_},
                             {"banks_per_refresh", together},
                             {"rows", count("nbrOfRows")},
                             {"columns", count("nbrOfColumns") * (hbm ? count("burstLength") : 1)}};
    refreshes_alone_ = together < banks_;
    command_bus(type);
  }

  // What their checkers of the type have.
  void command_bus(const std::string& type) {
    Json& bus = ours_["command_bus"];
    if (type == "LPDDR4") bus = {{"activate", 4}, {"column", 4}, {"row", 2}};
    if (type == "LPDDR5") bus = {{"activate", 2}, {"activate_gap", 1}};
    if (type == "DDR5") {
      const std::int64_t cycles = std::max<std::int64_t>(1, of("memtimingspec", "cmdMode"));
      bus = {{"activate", 2 * cycles}, {"column", 2 * cycles}, {"row", cycles}};
    }
    if (type == "HBM2" || type == "HBM3") bus = {{"activate", 2}, {"buses", 2}};
    if (bus.is_null()) ours_.erase("command_bus");
  }

  void timing(const std::string& type) {
    Json& t = ours_["timing_cycles"];
    const auto take = [&](const std::vector<TimingName>& names) {
      for (const TimingName& name : names)
        for (const char* theirs : name.theirs)
          if (const std::int64_t cycles = of("memtimingspec", theirs); cycles > 0) {
            t[name.ours] = cycles;
            break;
          }
    };
    take(kStated);
    if (groups_ > 1) take(kStatedOfGroups);
    const auto got = [&](const char* key) {
      return t.contains(key) ? t[key].get<std::int64_t>() : 0;
    };
    const auto missing = [&](const char* key, std::int64_t value) {
      if (!t.contains(key)) stand_in(key, value);
    };
    if (!t.contains("dqss")) t["dqss"] = 0;
    if (!t.contains("dqsck_max")) t["dqsck_max"] = 0;
    missing("write_latency_b", got("write_latency_a"));
    missing("dqsck_min", got("dqsck_max"));
    missing("rc", got("ras") + got("rp_bank"));
    if (!refreshes_alone_) {
      missing("rfc_bank", got("rfc_all"));
      missing("refi_bank", got("refi"));
    }
    if (groups_ > 1)
      for (const auto& [key, other] :
           {std::pair("ccd_l", "ccd"), std::pair("rrd_l", "rrd"), std::pair("wtr_l", "wtr")})
        missing(key, got(other));
    missing("cke_self_refresh", got("cke"));
    missing("xsr", got("rfc_all") + got("xp"));
    missing("rtrs", 1);
    missing("ras_max", 9 * got("refi"));
    if (type == "DDR5") ours_["refresh_postpone_limit"] = 4;
  }

  void power(std::vector<std::string>& notes) {
    const double devices = std::max<double>(1, number("memarchitecturespec", "nbrOfDevices"));
    Json set;
    bool any = false;
    // What is not stated of a rail that has some current costs nothing, or stands at 1 V.
    const auto take_rail = [&](const char* volts, const Names& theirs, const char* ma,
                               Names CurrentName::*names) {
      const double stated_v = first_of("mempowerspec", theirs);
      set[volts] = stated_v > 0 ? stated_v : 1.0;
      std::vector<std::string> without;
      for (const CurrentName& current : kCurrents) {
        const double ampere = first_of("mempowerspec", current.*names);
        set[ma][current.ours] = 1000 * devices * ampere;
        if (ampere == 0) without.push_back(fmt::format("{}.{} 0", ma, current.ours));
      }
      if (without.size() == kCurrents.size()) return;
      any = true;
      stand_ins_.insert(stand_ins_.end(), without.begin(), without.end());
      if (stated_v == 0) stand_ins_.push_back(fmt::format("{} 1", volts));
    };
    take_rail("vdd1_v", {"vdd1", "vpp"}, "vdd1_ma", &CurrentName::first);
    take_rail("vdd2_v", {"vdd2", "vdd2h", "vdd"}, "vdd2_ma", &CurrentName::second);
    if (!any)
      notes.push_back(fmt::format("{}: no currents: the memory's energy is not known", origin_));
    if (first_of("mempowerspec", {"idd02l", "idd4r2l", "idd3n2l"}) > 0)
      notes.push_back(fmt::format("{}: currents of VDD2L are not counted", origin_));
    ours_["currents"]["dramsys"] = set;
    ours_["default_currents"] = "dramsys";
    const double io_watt = number("mempowerspec", "idd4rq") * number("mempowerspec", "vddq");
    const double tck = number("memtimingspec", "tCK");
    const double bits_per_s = number("memarchitecturespec", "width") *
                              number("memarchitecturespec", "dataRate") / (tck > 0 ? tck : 1);
    const double pj = bits_per_s > 0 ? 1e12 * io_watt / bits_per_s : 0;
    ours_["io_pj_per_bit"] = pj;
    if (pj == 0)
      stand_ins_.push_back("io_pj_per_bit 0");
    else
      notes.push_back(
          fmt::format("{}: io_pj_per_bit {:.2f} is idd4rq x vddq over the data rate", origin_, pj));
  }

  const Json& spec_;
  const std::string& origin_;
  Json ours_;
  mutable std::set<std::string> read_;  // names that were looked for
  std::int64_t groups_ = 1, banks_ = 0;
  bool refreshes_alone_ = false;  // a per-bank refresh leaves other banks alone
  std::vector<std::string> stand_ins_;
};

}  // namespace

bool is_dramsys_memspec(const Json& json) {
  return json.is_object() && json.contains("memspec") && json["memspec"].is_object();
}

Json converted_from_dramsys(const Json& json, const std::string& origin,
                            std::vector<std::string>& notes) {
  return Conversion(json["memspec"], origin).run(notes);
}

std::string in_dramsys_keys(const std::string& refusal, const std::string& origin,
                            const Json& json) {
  const std::size_t key = origin.size() + 2, end = refusal.find(": ", key);
  if (refusal.rfind(origin + ": ", 0) != 0 || end == std::string::npos) return refusal;
  const std::string theirs = dramsys_key(refusal.substr(key, end - key), json["memspec"]);
  return theirs.empty() ? refusal : origin + ": " + theirs + refusal.substr(end);
}

}  // namespace sgs
