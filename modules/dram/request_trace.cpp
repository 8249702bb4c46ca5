// Request traces as text.
#include "modules/dram/request_trace.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <sstream>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"

namespace sgs {

namespace {

constexpr std::uint64_t kMostBytes = 65536;
constexpr double kMostNs = 1e12;
constexpr const char* kHeader = "# address R|W nanoseconds bytes";

using Fields = std::vector<std::string>;

bool parse_hex(const std::string& text, std::uint64_t& value) {
  if (text.compare(0, 2, "0x") != 0 || text.size() == 2 ||
      text.find_first_not_of("0123456789abcdefABCDEF", 2) != std::string::npos)
    return false;
  errno = 0;
  value = std::strtoull(text.c_str() + 2, nullptr, 16);
  return errno == 0;
}

bool parse_decimal(const std::string& text, std::uint64_t& value) {
  if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos) return false;
  errno = 0;
  value = std::strtoull(text.c_str(), nullptr, 10);
  return errno == 0;
}

bool parse_bytes(const std::string& text, std::uint32_t& bytes) {
  std::uint64_t count = 0;
  if (!parse_decimal(text, count) || count < 1 || count > kMostBytes) return false;
  bytes = static_cast<std::uint32_t>(count);
  return true;
}

bool parse_time(const std::string& text, double& ns) {
  if (text.empty() || text.find_first_not_of("0123456789.eE+-") != std::string::npos) return false;
  char* end = nullptr;
  ns = std::strtod(text.c_str(), &end);
  return *end == '\0' && ns >= 0 && ns < kMostNs;
}

// Reads a line's fields. Null: done; else what was expected, nothing where it is not of the form.
using Read = const char* (*)(const Fields&, double cycle_ns, MemoryRequest&);
constexpr const char* kOtherForm = "";
constexpr const char* kTime = "a time in ns that does not decrease";
constexpr const char* kBytes = "1 to 65536 bytes";
struct Form {
  const char* name;
  const char* line;
  Read read;
};

const char* read_ours(const Fields& f, double, MemoryRequest& r) {
  if (f.size() < 2 || f.size() > 4 || (f[1] != "R" && f[1] != "W")) return kOtherForm;
  r.write = f[1] == "W";
  if (!parse_hex(f[0], r.address) && !parse_decimal(f[0], r.address)) return kOtherForm;
  if (f.size() > 2 && !parse_time(f[2], r.not_before_ns)) return kTime;
  return f.size() > 3 && !parse_bytes(f[3], r.bytes) ? kBytes : nullptr;
}

const char* read_dramsys(const Fields& f, double cycle_ns, MemoryRequest& r) {
  std::size_t at = 0;
  const auto next = [&] { return at < f.size() ? f[at++] : std::string(); };
  std::string field = next();
  std::uint64_t cycle = 0;
  if (!field.empty() && field.back() == ':') field.pop_back();
  if (!parse_decimal(field, cycle)) return kOtherForm;
  r.not_before_ns = static_cast<double>(cycle) * cycle_ns;
  field = next();
  if (field.size() > 2 && field.front() == '(' && field.back() == ')') {
    if (!parse_bytes(field.substr(1, field.size() - 2), r.bytes)) return kBytes;
    field = next();
  }
  r.write = field == "write";
  if ((field != "read" && !r.write) || !parse_hex(next(), r.address)) return kOtherForm;
  if (f.size() > at + 1) return kOtherForm;
  return r.not_before_ns < kMostNs ? nullptr : kTime;
}

const char* read_dramsim3(const Fields& f, double cycle_ns, MemoryRequest& r) {
  std::uint64_t cycle = 0;
  if (f.size() != 3 || !parse_hex(f[0], r.address) || !parse_decimal(f[2], cycle))
    return kOtherForm;
  r.write = f[1] == "WRITE" || f[1] == "write" || f[1] == "P_MEM_WR";
  r.not_before_ns = static_cast<double>(cycle) * cycle_ns;
  const bool read = f[1] == "READ" || f[1] == "read" || f[1] == "P_MEM_RD";
  if (!read && !r.write) return kOtherForm;
  return r.not_before_ns < kMostNs ? nullptr : kTime;
}

constexpr Form kForms[] = {
    {"", "ADDRESS R|W [NANOSECONDS [BYTES]]", read_ours},
    {"DRAMSys", "CYCLE: [(BYTES)] read|write 0xADDRESS [0xDATA]", read_dramsys},
    {"DRAMsim3", "0xADDRESS READ|WRITE CYCLE", read_dramsim3},
};

Fields fields_of(std::string_view line) {
  std::istringstream in{std::string(line)};
  Fields fields;
  for (std::string field; in >> field;) fields.push_back(field);
  return fields;
}

bool names_other_columns(std::string_view comment) {
  bool address = false, direction = false;
  for (const std::string& word : fields_of(comment.substr(1))) {
    address = address || word == "address";
    direction = direction || word == "R|W";
  }
  return address && direction && comment != std::string_view(kHeader).substr(0, comment.size());
}

class Reader {
 public:
  Reader(const std::string& path, double cycle_ns) : lines_(path), cycle_ns_(cycle_ns) {}

  RequestTrace run() {
    RequestTrace trace;
    double last_ns = 0;
    for (std::string_view line; lines_.next(line);) {
      if (line.empty()) continue;
      if (line[0] == '#') {
        if (form_ == nullptr && names_other_columns(line)) refuse(line, quoted(kHeader));
        continue;
      }
      const Fields fields = fields_of(line);
      if (fields.empty()) continue;
      const MemoryRequest request = read(line, fields);
      if (request.not_before_ns < last_ns) refuse(line, kTime);
      last_ns = request.not_before_ns;
      trace.requests.push_back(request);
    }
    if (form_ != nullptr) trace.form = form_->name;
    return trace;
  }

 private:
  static std::string quoted(const std::string& text) { return fmt::format("'{}'", text); }

  [[noreturn]] void refuse(std::string_view line, const std::string& expected) const {
    throw InputError(fmt::format("{}: line {}: got '{}', expected {}", lines_.path(),
                                 lines_.line_number(), line, expected));
  }

  std::string expected() const {
    if (form_ != nullptr)
      return *form_->name == '\0' ? form_->line
                                  : fmt::format("{} as in the lines before, of a {} trace",
                                                form_->line, form_->name);
    std::string all;
    for (const Form& form : kForms)
      all += fmt::format("{}{}{}", all.empty() ? "" : ", or ",
                         *form.name == '\0' ? "" : fmt::format("{}'s ", form.name), form.line);
    return all;
  }

  // The first request decides the form.
  MemoryRequest read(std::string_view line, const Fields& fields) {
    std::string wrong;
    for (const Form& form : kForms) {
      if (form_ != nullptr && form_ != &form) continue;
      MemoryRequest request;
      if (const char* wanted = form.read(fields, cycle_ns_, request)) {
        wrong += wanted;
        continue;
      }
      form_ = &form;
      return request;
    }
    refuse(line, wrong.empty() ? expected() : wrong);
  }

  LineReader lines_;
  const double cycle_ns_;
  const Form* form_ = nullptr;
};

}  // namespace

RequestTrace read_request_trace(const std::string& path, double cycle_ns) {
  constexpr std::string_view kRelative = ".rstl";
  if (path.size() > kRelative.size() &&
      path.compare(path.size() - kRelative.size(), kRelative.size(), kRelative) == 0)
    throw InputError(fmt::format(
        "{}: got a DRAMSys trace of relative times, expected absolute ones (.stl)", path));
  return Reader(path, cycle_ns).run();
}

}  // namespace sgs
