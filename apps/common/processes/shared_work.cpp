#include "common/processes/shared_work.h"

#include <atomic>
#include <cstdlib>
#include <exception>
#include <mutex>

#ifdef PCL_SYMMETRY_MPI
#include <boost/mpi.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>
#include <chrono>
#include <optional>
#include <thread>
#endif

namespace pcl_symmetry::apps {

#ifdef PCL_SYMMETRY_MPI

namespace {

constexpr int kAsk = 1, kItem = 2;  // tags of messages. chosen: any two
constexpr std::int64_t kNone = -1;  // no item. derived: no index
// Pause between two looks for messages. chosen: a model takes tens of milliseconds; half and twice take the same time.
constexpr std::chrono::milliseconds kPause(1);

/// OpenMPI, MPICH and its relatives, and srun set a variable for each process.
bool isStartedByMPI() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMI_SIZE") || std::getenv("PMIX_RANK");
}

}  // namespace

struct SharedWork::Processes {
  boost::mpi::environment environment{boost::mpi::threading::serialized, false};
  boost::mpi::communicator world;
  std::atomic<std::size_t> next{0};  // of the first process: the next item
  std::mutex taking;
};

SharedWork::SharedWork() {
  if (!isStartedByMPI()) return;
  processes_ = std::make_unique<Processes>();
  rank_ = processes_->world.rank();
  size_ = processes_->world.size();
}

void SharedWork::broadcast(std::string& text) {
  if (isShared()) boost::mpi::broadcast(processes_->world, text, 0);
}

/// Gives items to the other processes and takes their results until all are done.
void SharedWork::answer(std::size_t count, const Take& take) {
  for (int working = size_ - 1; working > 0;) {
    const auto status = processes_->world.iprobe(boost::mpi::any_source, kAsk);
    if (!status) {
      std::this_thread::sleep_for(kPause);
      continue;
    }
    std::pair<std::int64_t, std::string> done;
    processes_->world.recv(status->source(), kAsk, done);
    const std::size_t next = processes_->next++;
    processes_->world.send(status->source(), kItem, next < count ? static_cast<std::int64_t>(next) : kNone);
    if (next >= count) --working;
    if (done.first == kNone) continue;
    const std::lock_guard<std::mutex> lock(processes_->taking);
    take(static_cast<std::size_t>(done.first), done.second);
  }
}

void SharedWork::ask(const Work& work) {
  std::pair<std::int64_t, std::string> done(kNone, "");
  while (true) {
    processes_->world.send(0, kAsk, done);
    processes_->world.recv(0, kItem, done.first);
    if (done.first == kNone) return;
    done.second = work(static_cast<std::size_t>(done.first));
  }
}

void SharedWork::run(std::size_t count, const Work& work, const Take& take) {
  if (!isShared()) {
    for (std::size_t i = 0; i < count; ++i) take(i, work(i));
  } else if (!isFirst()) {
    ask(work);
  } else {
    processes_->next = 0;
    std::exception_ptr error;
    std::thread answering([&] {
      try {
        answer(count, take);
      } catch (...) {
        error = std::current_exception();
        processes_->next = count;
      }
    });
    std::exception_ptr own;
    try {
      for (std::size_t i = processes_->next++; i < count; i = processes_->next++) {
        const std::string result = work(i);
        const std::lock_guard<std::mutex> lock(processes_->taking);
        take(i, result);
      }
    } catch (...) {
      own = std::current_exception();
      processes_->next = count;
    }
    answering.join();
    for (const std::exception_ptr& thrown : {own, error})
      if (thrown) std::rethrow_exception(thrown);
  }
  ran_ = true;
}

int SharedWork::end(int code) {
  if (isShared() && code != 0 && !ran_) boost::mpi::environment::abort(code);
  return code;
}

#else

struct SharedWork::Processes {};

SharedWork::SharedWork() = default;

void SharedWork::broadcast(std::string&) {}

void SharedWork::run(std::size_t count, const Work& work, const Take& take) {
  for (std::size_t i = 0; i < count; ++i) take(i, work(i));
  ran_ = true;
}

int SharedWork::end(int code) {
  return code;
}

#endif

SharedWork::~SharedWork() = default;

}  // namespace pcl_symmetry::apps
