// streaminggs diff A B: two reports.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/report/frame_noise.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/report/report_diff.h"

namespace sgs {
namespace {

struct QuantityWords {
  const char *name, *unit, *parts;
  double scale;  // factor to `unit`
};

// By Quantity.
constexpr QuantityWords kWords[kQuantities] = {
    {"time", "ms", "", 1e3},
    {"cycles", "", "cycles that an activity works, of the frame's", 1},
    {"waiting cycles", "", "cycles that an activity waits, of the frame's", 1},
    {"bytes", "B", "bytes of the memory", 1},
    {"energy", "mJ", "energy", 1e3},
    {"area", "mm2", "area by kind of part", 1},
    {"area with PHY", "mm2", "area by owner, with PHY and controller of the memory", 1}};

const QuantityWords& words_of(Quantity quantity) {
  return kWords[static_cast<std::size_t>(quantity)];
}

std::string in_words(double value, Quantity quantity) {
  const double scaled = value * words_of(quantity).scale;
  if (*words_of(quantity).unit == 'm') return rounded(scaled);
  return grouped(static_cast<std::uint64_t>(std::llround(scaled)));
}

std::string percent(double share) { return fmt::format("{:+.1f} %", 100 * share); }

std::string change(double a, double b) {
  if (a == b) return "equal";
  return a == 0 ? "new" : percent(b / a - 1);
}

// Behind a change of a frame's cycles or joules, which may be none.
std::string noise_of(double a, double b) {
  return a > 0 && below_noise(b / a - 1) ? fmt::format("   {}", kBelowNoise) : "";
}

std::string change_of(const PartChange& part) {
  const std::string of_value = change(part.a, part.b);
  if (part.copies_a == part.copies_b || part.copies_a == 0 || part.copies_b == 0) return of_value;
  return fmt::format("{}, {} -> {} of them", of_value, part.copies_a, part.copies_b);
}

void print_config(const ReportDiff& diff) {
  const std::size_t keys = diff.config.size() + diff.equal_keys;
  fmt::print("\nconfiguration: {} of {} keys differ\n", diff.config.size(), keys);
  std::size_t width = 0;
  for (const ConfigChange& c : diff.config) width = std::max(width, c.key.size());
  for (const ConfigChange& c : diff.config)
    fmt::print("  {:<{}}  {} -> {}\n", c.key, width, c.a, c.b);
  if (diff.keys_of_a.empty() && diff.keys_of_b.empty()) return;
  fmt::print("  {} other keys only A has, {} only B\n", diff.keys_of_a.size(),
             diff.keys_of_b.size());
}

// Cycles of unlike clocks are no measure of speed.
void print_views(const ReportDiff& diff) {
  const Quantity measure = diff.clocks_differ ? Quantity::kTime : Quantity::kBusy;
  fmt::print("\n{:>6} {:>15} {:>15} {:>10} {:>9} {:>9}   {}\n", "view",
             diff.clocks_differ ? "ms A" : "cycles A", "B", "change", "PSNR dB A", "B", "held by");
  for (const auto& [a, b] : diff.views) {
    const double in_a = a->of(measure).whole, in_b = b->of(measure).whole;
    fmt::print("{:>6} {:>15} {:>15} {:>10} {:>9} {:>9}   {}{}\n",
               diff.streams ? "frames" : fmt::format("{}", a->view), in_words(in_a, measure),
               in_words(in_b, measure), change(in_a, in_b), a->psnr_db, b->psnr_db,
               a->holds == b->holds ? a->holds : a->holds + " -> " + b->holds,
               noise_of(in_a, in_b));
  }
}

// Time and cycles have noise, and joules of frames of unlike cycles.
bool has_noise(Quantity quantity, const ReportDiff& diff) {
  if (diff.views.size() > 1) return false;
  const auto& [a, b] = diff.views[0];
  return quantity == Quantity::kTime || quantity == Quantity::kBusy ||
         (quantity == Quantity::kJoules && a->cycles != b->cycles);
}

void print_wholes(const ReportDiff& diff) {
  fmt::print("\n{:<18} {:>15} {:>15} {:>10}\n", diff.views.size() > 1 ? "mean of a view" : "", "A",
             "B", "change");
  for (const QuantityChange& q : diff.quantities) {
    const QuantityWords& words = words_of(q.quantity);
    fmt::print("{:<18} {:>15} {:>15} {:>10}{}\n", fmt::format("{} {}", words.name, words.unit),
               in_words(q.a, q.quantity), in_words(q.b, q.quantity), change(q.a, q.b),
               has_noise(q.quantity, diff) ? noise_of(q.a, q.b) : "");
  }
  if (diff.without_memory) fmt::print("energy is without the memory's, which is not known\n");
  if (diff.clocks_differ) fmt::print("clocks differ: time compares the runs, cycles do not\n");
}

// least: of the whole; what changes it by less is counted only.
void print_parts(const QuantityChange& q, double least) {
  if (q.parts.empty()) return;
  const auto small = std::find_if(q.parts.begin(), q.parts.end(), [&](const PartChange& part) {
    return std::abs(part.of_whole) < least;
  });
  fmt::print("\n{}\n", words_of(q.quantity).parts);
  std::size_t width = 0;
  for (auto part = q.parts.begin(); part != small; ++part)
    width = std::max(width, part->name.size());
  for (auto part = q.parts.begin(); part != small; ++part) {
    fmt::print("  {:>9}  {:<{}} {:>12} -> {:>12}  {}\n", percent(part->of_whole), part->name, width,
               in_words(part->a, q.quantity), in_words(part->b, q.quantity), change_of(*part));
  }
  const auto rest = q.parts.end() - small;
  if (rest > 0) fmt::print("  {} change it by less than {} % each\n", rest, rounded(100 * least));
  if (q.equal > 0) fmt::print("  {} equal\n", q.equal);
}

void print(const ReportedRun& a, const ReportedRun& b, const ReportDiff& diff, double least) {
  fmt::print("A  {}\nB  {}\n", a.path, b.path);
  if (!diff.unlike.empty()) {
    fmt::print("\nnot of the same (A | B):\n");
    for (const std::string& sentence : diff.unlike) fmt::print("  {}\n", sentence);
  }
  for (const auto& [of_a, of_b] : diff.views) {
    if (!of_a->equals)
      fmt::print("\nview {}: A's frame differs from the streaming renderer's\n", of_a->view);
    if (!of_b->equals)
      fmt::print("\nview {}: B's frame differs from the streaming renderer's\n", of_b->view);
  }
  print_config(diff);
  print_views(diff);
  print_wholes(diff);
  for (const QuantityChange& q : diff.quantities) print_parts(q, least);
}

}  // namespace

SubCommand add_diff_command(CommandLine& line, const Kinds&) {
  struct Arguments {
    std::string a, b;
    double least_percent = 0.1;
  };
  auto arguments = std::make_shared<Arguments>();
  line.text("A", arguments->a, "report.json of simulate, or its folder", Given::kAlways);
  line.text("B", arguments->b, "another", Given::kAlways);
  line.real("--least", arguments->least_percent, 0, 100,
            "per cent of the whole that a part must change it by to have a line; 0.1 if not given");
  return [arguments] {
    const ReportedRun a = read_reported_run(arguments->a), b = read_reported_run(arguments->b);
    print(a, b, diff_runs(a, b), arguments->least_percent / 100);
    return 0;
  };
}

}  // namespace sgs
