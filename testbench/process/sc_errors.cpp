// The handler of SystemC's reports.
#include "testbench/process/sc_errors.h"

#include <string>
#include <systemc>

#include "testbench/process/child_process.h"

namespace sgs {
namespace {

void handle(const sc_core::sc_report& report, const sc_core::sc_actions& actions) {
  if (report.get_severity() < sc_core::SC_ERROR) {
    sc_core::sc_report_handler::default_handler(report, actions);
    return;
  }
  fail_child(std::string(report.get_msg_type()) + ": " + report.get_msg());
}

}  // namespace

void fail_child_on_sc_error() { sc_core::sc_report_handler::set_handler(handle); }

}  // namespace sgs
