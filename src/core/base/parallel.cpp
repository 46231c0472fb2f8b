#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#if !defined(__SANITIZE_THREAD__)
#include <omp.h>
#include <pthread.h>
#endif

namespace pcl_symmetry {

namespace {

/// Starts threads that end with the loop. Loops inside a block run on the thread of the block.
void runOnNewThreads(int num_threads, std::size_t num_blocks, const std::function<void(std::size_t)>& block) {
  thread_local bool is_inside = false;
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    const bool was_inside = is_inside;
    is_inside = true;
    for (std::size_t b; (b = next++) < num_blocks;) block(b);
    is_inside = was_inside;
  };
  std::vector<std::thread> others;
  for (int i = 1; i < num_threads && !is_inside; ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
}

#if defined(__SANITIZE_THREAD__)
// The thread sanitizer does not see how OpenMP's runtime synchronizes, and would report every loop.
int numCores() {
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void runOnThreads(int num_threads, std::size_t num_blocks, const std::function<void(std::size_t)>& block) {
  runOnNewThreads(num_threads, num_blocks, block);
}
#else
int numCores() {
  return std::max(1, omp_get_num_procs());
}

// OpenMP's threads do not survive fork(): its next loop in the child would wait for them forever.
std::atomic<bool> was_forked{false};
[[maybe_unused]] const int is_registered = pthread_atfork(nullptr, nullptr, [] { was_forked = true; });

void runOnThreads(int num_threads, std::size_t num_blocks, const std::function<void(std::size_t)>& block) {
  if (was_forked) {
    runOnNewThreads(num_threads, num_blocks, block);
    return;
  }
  if (omp_in_parallel()) {
    // Threads that have finished their own blocks take over some of these.
#pragma omp taskloop grainsize(1) default(none) shared(num_blocks, block)
    for (std::size_t b = 0; b < num_blocks; ++b) block(b);
    return;
  }
#pragma omp parallel for schedule(dynamic, 1) num_threads(num_threads)
  for (std::size_t b = 0; b < num_blocks; ++b) block(b);
}
#endif

}  // namespace

int resolveNumThreads(int num_threads) {
  return num_threads > 0 ? num_threads : numCores();
}

void parallelBlocks(std::size_t num_blocks, int num_threads, const std::function<void(std::size_t)>& block) {
  const int threads = static_cast<int>(std::min<std::size_t>(resolveNumThreads(num_threads), num_blocks));
  if (threads <= 1) {
    for (std::size_t b = 0; b < num_blocks; ++b) block(b);
    return;
  }
  std::exception_ptr failure;
  std::mutex failure_mutex;
  runOnThreads(threads, num_blocks, [&](std::size_t b) {
    try {
      block(b);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  });
  if (failure) std::rethrow_exception(failure);
}

void parallelRanges(std::size_t size, std::size_t block_size, int num_threads,
                    const std::function<void(std::size_t, std::size_t)>& range) {
  parallelBlocks((size + block_size - 1) / block_size, num_threads,
                 [&](std::size_t b) { range(b * block_size, std::min(size, (b + 1) * block_size)); });
}

}  // namespace pcl_symmetry
