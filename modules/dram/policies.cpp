// Policies by configuration.
#include "modules/dram/adaptive_page.h"
#include "modules/dram/closed_page.h"
#include "modules/dram/fcfs.h"
#include "modules/dram/fr_fcfs.h"
#include "modules/dram/open_page.h"
#include "modules/dram/page_policy.h"
#include "modules/dram/scheduling_policy.h"

namespace sgs {

std::unique_ptr<SchedulingPolicy> make_scheduling_policy(const DramConfig& config) {
  if (config.scheduler == SchedulerKind::kFcfs) return std::make_unique<Fcfs>();
  return std::make_unique<FrFcfs>(config.age_cap_cycles);
}

std::unique_ptr<PagePolicy> make_page_policy(const DramConfig& config, std::uint32_t banks) {
  switch (config.page_policy) {
    case PagePolicyKind::kClosed:
      return std::make_unique<ClosedPage>();
    case PagePolicyKind::kAdaptive:
      return std::make_unique<AdaptivePage>(banks);
    case PagePolicyKind::kOpen:
      break;
  }
  return std::make_unique<OpenPage>();
}

}  // namespace sgs
