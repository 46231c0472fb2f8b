#include "core/base/parallel.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace pcl_symmetry {

struct Loop;

namespace {

/// Interval between two progress reports: too short for a user to notice, too long to cost time.
constexpr std::chrono::milliseconds report_interval(50);

using Clock = std::chrono::steady_clock;

thread_local ProgressMonitor* monitor = nullptr;
thread_local Loop* innermost = nullptr;  // the loop whose block this thread runs

struct Cancelled {};  // thrown by a loop inside a cancelled one

}  // namespace

/// One call of parallelBlocks(). Threads take its blocks one by one.
struct Loop {
  Loop(std::size_t num_blocks_of_call, int num_threads, const std::function<void(std::size_t)>& block_of_call)
      : num_blocks(num_blocks_of_call), num_free(num_threads - 1), outer(innermost), block(block_of_call) {}

  void run();
  void work();
  void report(double share);
  void poll();
  void rethrow() const;
  bool isCancelled() const { return cancelled || (outer && outer->isCancelled()); }

  const std::size_t num_blocks;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> cancelled{false};  // set by the progress callback
  int num_free, num_helpers = 0;  // threads that may still join, and that have joined; guarded by the lock of Threads
  Loop* const outer;
  const std::function<void(std::size_t)>& block;
  std::mutex mutex;  // guards failure
  std::exception_ptr failure;
};

namespace {

/// The threads that help with loops. They sleep while there is no loop and leave the cores to other programs.
class Threads {
public:
  void add(Loop& loop) {
    const std::lock_guard<std::mutex> lock(mutex_);
    loops_.push_back(&loop);
    for (; num_threads_ < loop.num_free; ++num_threads_) std::thread([this] { serve(); }).detach();
    for (int i = 0; i < loop.num_free; ++i) wake_.notify_one();
  }

  /// Returns when no thread works on the loop any more.
  void remove(Loop& loop) {
    std::unique_lock<std::mutex> lock(mutex_);
    loops_.erase(std::find(loops_.begin(), loops_.end(), &loop));
    while (!left_.wait_for(lock, report_interval, [&] { return loop.num_helpers == 0; })) {
      lock.unlock();
      loop.report(1.0);
      lock.lock();
    }
  }

private:
  void serve() {
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
      // The last one is the innermost: outer ones wait for it.
      const auto loop = std::find_if(loops_.rbegin(), loops_.rend(), [](const Loop* each) {
        return each->num_free > 0 && each->next < each->num_blocks;
      });
      if (loop == loops_.rend()) {
        wake_.wait(lock);
        continue;
      }
      Loop& helped = **loop;
      --helped.num_free;
      ++helped.num_helpers;
      lock.unlock();
      helped.work();
      lock.lock();
      if (--helped.num_helpers == 0) left_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, left_;
  std::vector<Loop*> loops_;
  int num_threads_ = 0;
};

// Never deleted, as its threads may run until the program ends. The child of a fork has none of them.
Threads* threads = new Threads;
[[maybe_unused]] const int is_registered = pthread_atfork(nullptr, nullptr, [] { threads = new Threads; });

}  // namespace

void Loop::run() {
  ProgressMonitor* const own_monitor = monitor;
  const bool is_shared = num_free > 0;
  if (own_monitor) ++own_monitor->depth_;
  if (is_shared) threads->add(*this);
  work();
  if (is_shared) threads->remove(*this);
  if (own_monitor) --own_monitor->depth_;
  rethrow();
}

void Loop::work() {
  Loop* const former = std::exchange(innermost, this);
  for (std::size_t b; !isCancelled() && (b = next++) < num_blocks;) {
    try {
      block(b);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (!failure) failure = std::current_exception();
    }
    report(static_cast<double>(b + 1) / static_cast<double>(num_blocks));
  }
  innermost = former;
}

void Loop::report(double share) {
  if (!monitor || isCancelled()) return;
  if (monitor->depth_ == 1) monitor->share_ = share;
  if (Clock::now() < monitor->last_ + report_interval) return;
  try {
    monitor->report_(monitor->share_);
  } catch (...) {
    for (Loop* loop = this; loop; loop = loop->outer) {
      const std::lock_guard<std::mutex> lock(loop->mutex);
      loop->failure = std::current_exception();
      loop->cancelled = true;
    }
  }
  monitor->last_ = Clock::now();
}

void checkCancelled() {
  static const std::function<void(std::size_t)> nothing;
  Loop step(0, 1, nothing);
  step.poll();
}

void Loop::poll() {
  if (monitor) report(monitor->share_);
  rethrow();
}

/// Rethrows the exception that ended the loop.
void Loop::rethrow() const {
  if (failure) std::rethrow_exception(failure);
  if (isCancelled()) throw Cancelled();
}

ProgressMonitor::ProgressMonitor(std::function<void(double)> report)
    : report_(std::move(report)), previous_(monitor), last_(Clock::now()) {
  monitor = this;
}

ProgressMonitor::~ProgressMonitor() {
  monitor = previous_;
}

int resolveNumThreads(int num_threads) {
  if (num_threads > 0) return num_threads;
  cpu_set_t cores;
  return sched_getaffinity(0, sizeof(cores), &cores) == 0 ? CPU_COUNT(&cores) : 1;
}

void parallelBlocks(std::size_t num_blocks, int num_threads, const std::function<void(std::size_t)>& block) {
  if (num_blocks == 0) return;
  Loop(num_blocks, static_cast<int>(std::min<std::size_t>(resolveNumThreads(num_threads), num_blocks)), block).run();
}

void parallelRanges(std::size_t size, std::size_t block_size, int num_threads,
                    const std::function<void(std::size_t, std::size_t)>& range) {
  parallelBlocks((size + block_size - 1) / block_size, num_threads,
                 [&](std::size_t b) { range(b * block_size, std::min(size, (b + 1) * block_size)); });
}

void parallelPoints(std::size_t size, int num_threads, const std::function<void(std::size_t, std::size_t)>& range) {
  constexpr std::size_t together = 1024;
  parallelRanges(size, together, num_threads, range);
}

}  // namespace pcl_symmetry
