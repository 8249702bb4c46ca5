// The loop around poll().
#include "testbench/streaminggs/sweep/sweep.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "algorithm/files/input_error.h"

namespace sgs {

namespace {

constexpr int kLookAroundMs = 250;
// Points are planned ahead of the simulations, since an answer may be known already; not more of
// them than this, however fast they come.
constexpr std::uint64_t kMostUnanswered = 1000;
// A second failure is one of the point and not of the day.
constexpr int kMostAttempts = 2;

bool by_what_is_shared(const SweepTask& a, const SweepTask& b) {
  const auto place = [](const SweepTask& t) {
    return std::tie(t.words.scene, t.words.cameras, t.storage, t.words.size, t.view, t.picture);
  };
  return place(a) < place(b);
}

}  // namespace

std::vector<SweepPoint> PointStream::receive() {
  std::array<char, 1U << 16U> block;
  const ssize_t got = ::read(descriptor_, block.data(), block.size());
  std::vector<SweepPoint> points;
  if (got < 0 && errno == EINTR) return points;
  if (got < 0) {
    throw std::runtime_error(
        fmt::format("standard input cannot be read ({})", std::strerror(errno)));
  }
  if (got == 0) {
    ended_ = true;
    end_line(points);
    return points;
  }
  std::string_view left(block.data(), static_cast<std::size_t>(got));
  for (std::size_t end; (end = left.find('\n')) != std::string_view::npos;) {
    take(left.substr(0, end), points);
    end_line(points);
    left.remove_prefix(end + 1);
  }
  take(left, points);
  return points;
}

void PointStream::take(std::string_view piece, std::vector<SweepPoint>& points) {
  if (too_long_) return;
  if (line_.size() + piece.size() <= kLongestLineBytes) {
    line_.append(piece);
    return;
  }
  too_long_ = true;
  line_.clear();
  points.emplace_back().refused =
      fmt::format("{}: got more than {} B, expected KEY=VALUE ..., or a JSON object", place(),
                  kLongestLineBytes);
}

void PointStream::end_line(std::vector<SweepPoint>& points) {
  const std::string content = content_of(line_);
  if (!content.empty()) {
    try {
      points.push_back(parse_point(content, place()));
    } catch (const InputError& error) {
      points.emplace_back().refused = error.what();
    }
  }
  line_.clear();
  too_long_ = false;
  ++number_;
}

std::string PointStream::place() const { return fmt::format("standard input, line {}", number_); }

// True if the point need not be simulated.
bool Sweep::has_result(const std::string& key) const {
  const SweepResults::Facts* known = results_.find(key);
  if (known == nullptr) return false;
  return known->status != kPointFailed || known->attempts >= kMostAttempts ||
         failed_now_.count(key) > 0;
}

void Sweep::add(std::vector<SweepTask> tasks) {
  std::stable_sort(tasks.begin(), tasks.end(), by_what_is_shared);
  counts_.asked += tasks.size();
  for (SweepTask& task : tasks) {
    if (task.key.empty()) {
      tell({task, line_of_refused("", task.words, task.refused), kPointRefused, false});
    } else if (has_result(task.key)) {
      tell({task, results_.line(task.key), results_.find(task.key)->status, true});
    } else if (!task.refused.empty()) {
      keep_refused(task, task.refused);
    } else if (const auto same = same_.find(task.key); same != same_.end()) {
      same->second.push_back(std::move(task));
    } else {
      same_[task.key];
      waiting_.push_back(std::move(task));
    }
  }
}

bool Sweep::run(PointStream* stream,
                const std::function<std::vector<SweepTask>(const SweepPoint&)>& plan) {
  while (true) {
    if (stop()) return false;
    // One at a time: planning takes milliseconds, in which others end.
    if (may_plan()) {
      add(plan(arrived_.front()));
      arrived_.pop_front();
    }
    start_waiting();
    progress(counts_);
    // Points that have arrived are planned before more are read: who sends too many has to wait.
    const bool more = stream != nullptr && !stream->ended();
    if (running_.empty() && waiting_.empty() && arrived_.empty() && !more) return true;
    wait_for_something(more && arrived_.empty() ? stream : nullptr);
  }
}

bool Sweep::may_plan() const {
  return !arrived_.empty() && counts_.asked - counts_.answered() < kMostUnanswered;
}

void Sweep::start_waiting() {
  while (running_.size() < side_by_side_ && !waiting_.empty() && !stop()) {
    SweepTask task = std::move(waiting_.front());
    waiting_.pop_front();
    try {
      std::unique_ptr<ChildProcess> child = simulations_.start(task);
      running_.push_back({std::move(task), std::move(child)});
    } catch (const InputError& error) {
      keep_refused(task, error.what());
    }
  }
}

void Sweep::wait_for_something(PointStream* stream) {
  std::vector<pollfd> watched;
  for (const Running& running : running_) {
    watched.push_back({running.child->descriptor(), POLLIN, 0});
  }
  if (stream != nullptr) watched.push_back({stream->descriptor(), POLLIN, 0});
  const int ready = ::poll(watched.data(), watched.size(), may_plan() ? 0 : kLookAroundMs);
  if (ready < 0 && errno != EINTR) throw std::runtime_error("cannot wait for child processes");
  if (ready <= 0) return;
  if (stream != nullptr && watched.back().revents != 0) {
    for (SweepPoint& point : stream->receive()) arrived_.push_back(std::move(point));
  }
  // From the last to the first: those that have ended go.
  for (std::size_t i = running_.size(); i-- > 0;) {
    if (watched[i].revents == 0 || !running_[i].child->receive()) continue;
    Running ended = std::move(running_[i]);
    running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
    finish(ended);
  }
}

void Sweep::finish(Running& running) {
  ++counts_.simulated;
  try {
    keep(running.task, running.child->result());
  } catch (const InputError& error) {
    keep_refused(running.task, error.what());
  } catch (const ChildFailure& error) {
    keep_failed(running.task, error.what());
  }
}

void Sweep::keep_refused(const SweepTask& task, const std::string& why) {
  keep(task, line_of_refused(task.key, task.words, why));
}

void Sweep::keep_failed(const SweepTask& task, const std::string& why) {
  const SweepResults::Facts* before = results_.find(task.key);
  failed_now_.insert(task.key);
  keep(task,
       line_of_failed(task.key, task.words, why, before == nullptr ? 1 : before->attempts + 1));
}

void Sweep::keep(const SweepTask& task, const std::string& line) {
  results_.add(line);
  const std::string& status = results_.find(task.key)->status;
  tell({task, line, status, false});
  const auto same = same_.find(task.key);
  if (same == same_.end()) return;
  for (const SweepTask& other : same->second) tell({other, line, status, false});
  same_.erase(same);
}

void Sweep::tell(const SweepAnswer& to) {
  if (to.status == kPointDone) ++counts_.done;
  if (to.status == kPointRefused) ++counts_.refused;
  if (to.status == kPointFailed) ++counts_.failed;
  if (to.kept) ++counts_.kept;
  answer(to);
}

}  // namespace sgs
