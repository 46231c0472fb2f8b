#include "common/processes/shared_work.h"

#include <cstdlib>
#include <mutex>
#include <optional>

#include "core/base/parallel.h"

#ifdef PCL_SYMMETRY_MPI
#include "common/processes/message_channel.h"
#include "common/processes/work_client.h"
#include "common/processes/work_server.h"
#endif

namespace pcl_symmetry::apps {

namespace {

void runAlone(std::size_t count, const WorkFunctions& functions, int num_threads) {
  std::mutex taking;
  parallelBlocks(count, num_threads, [&](std::size_t i) {
    const std::string result = functions.work(i);
    const std::lock_guard<std::mutex> lock(taking);
    functions.take(i, result);
  });
}

}  // namespace

#ifdef PCL_SYMMETRY_MPI

namespace {

/// OpenMPI, MPICH and its relatives, and srun set a variable for each process.
bool isStartedByMPI() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMI_SIZE") || std::getenv("PMIX_RANK");
}

}  // namespace

struct SharedWork::Processes {
  MessageChannel channel;
  std::optional<WorkServer> server;  // of the first process
  std::optional<WorkClient> client;  // of the others
};

SharedWork::SharedWork() {
  if (!isStartedByMPI()) return;
  processes_ = std::make_unique<Processes>();
  rank_ = processes_->channel.rank();
  size_ = processes_->channel.size();
  if (!isShared()) return;
  if (isFirst())
    processes_->server.emplace(processes_->channel);
  else
    processes_->client.emplace(processes_->channel);
}

void SharedWork::broadcast(std::string& text) {
  if (!isShared()) return;
  if (isFirst())
    processes_->server->tell(text);
  else
    text = processes_->client->hear();
}

void SharedWork::run(std::size_t count, const WorkFunctions& functions, int num_threads) {
  if (!isShared())
    runAlone(count, functions, num_threads);
  else if (isFirst())
    processes_->server->run(count, functions);
  else
    processes_->client->run(functions);
  ran_ = true;
}

int SharedWork::end(int code) {
  if (!isShared()) return code;
  if (code != 0 && !ran_) {
    processes_->server.reset();  // its thread uses the channel
    processes_->channel.abort(code);
  }
  if (!isFirst()) {
    processes_->client->leave();
    return code;
  }
  const int num_left = processes_->server->close();
  processes_->server.reset();
  if (num_left > 0) processes_->channel.abort(code);
  return code;
}

#else

struct SharedWork::Processes {};

SharedWork::SharedWork() = default;

void SharedWork::broadcast(std::string&) {}

void SharedWork::run(std::size_t count, const WorkFunctions& functions, int num_threads) {
  runAlone(count, functions, num_threads);
  ran_ = true;
}

int SharedWork::end(int code) {
  return code;
}

#endif

SharedWork::~SharedWork() = default;

}  // namespace pcl_symmetry::apps
