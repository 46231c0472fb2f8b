#include "common/processes/message_channel.h"

#include <boost/mpi.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <vector>

namespace pcl_symmetry::apps {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTag = 1;  // of all messages. chosen: any
// Longest time that a message may be on its way. chosen: a model is a megabyte, which takes milliseconds; at half of
// it a machine that swaps is given up, twice waits longer for a process that died.
constexpr std::chrono::seconds kOnTheWay(60);
// Pause between two looks. chosen: an item takes tens of milliseconds; half and twice take the same time.
constexpr std::chrono::microseconds kPause(500);
// Time that mpirun gets to pass on what was written, before all processes end: OpenMPI drops what it has not read yet.
// chosen: it reads within milliseconds; at half, a busy machine may still lose a sentence, twice only waits.
constexpr std::chrono::milliseconds kForwarding(300);

std::vector<char> packed(const Message& message) {
  std::vector<char> bytes(1 + 2 * sizeof(std::int64_t) + message.bytes.size());
  bytes[0] = static_cast<char>(message.word);
  std::memcpy(&bytes[1], &message.run, sizeof(std::int64_t));
  std::memcpy(&bytes[1 + sizeof(std::int64_t)], &message.item, sizeof(std::int64_t));
  std::memcpy(bytes.data() + 1 + 2 * sizeof(std::int64_t), message.bytes.data(), message.bytes.size());
  return bytes;
}

Message unpacked(const std::vector<char>& bytes) {
  Message message;
  message.word = static_cast<Message::Word>(bytes[0]);
  std::memcpy(&message.run, &bytes[1], sizeof(std::int64_t));
  std::memcpy(&message.item, &bytes[1 + sizeof(std::int64_t)], sizeof(std::int64_t));
  message.bytes.assign(bytes.begin() + 1 + 2 * sizeof(std::int64_t), bytes.end());
  return message;
}

/// \return whether it was completed in time.
bool completes(boost::mpi::request& request) {
  const auto deadline = Clock::now() + kOnTheWay;
  while (!request.test()) {
    if (Clock::now() > deadline) return false;
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

}  // namespace

struct MessageChannel::Connection {
  boost::mpi::environment environment{boost::mpi::threading::serialized, false};
  boost::mpi::communicator world;
};

MessageChannel::MessageChannel() : connection_(std::make_unique<Connection>()) {}

MessageChannel::~MessageChannel() = default;

int MessageChannel::rank() const {
  return connection_->world.rank();
}

int MessageChannel::size() const {
  return connection_->world.size();
}

void MessageChannel::send(int to, const Message& message) {
  auto bytes = std::make_unique<std::vector<char>>(packed(message));
  auto request = connection_->world.isend(to, kTag, bytes->data(), static_cast<int>(bytes->size()));
  if (completes(request)) return;
  static_cast<void>(bytes.release());  // MPI may still read it
  throw std::runtime_error("process " + std::to_string(to) + " of the run does not take messages");
}

std::optional<std::pair<int, Message>> MessageChannel::receive() {
  const auto status = connection_->world.iprobe(boost::mpi::any_source, kTag);
  if (!status) return std::nullopt;
  auto bytes = std::make_unique<std::vector<char>>(static_cast<std::size_t>(status->count<char>().value_or(0)));
  auto request = connection_->world.irecv(status->source(), kTag, bytes->data(), static_cast<int>(bytes->size()));
  if (!completes(request)) {
    static_cast<void>(bytes.release());  // MPI may still write to it
    return std::nullopt;
  }
  return std::make_pair(status->source(), unpacked(*bytes));
}

void MessageChannel::abort(int code) {
  std::fflush(nullptr);
  std::this_thread::sleep_for(kForwarding);
  boost::mpi::environment::abort(code);
  std::_Exit(code);
}

}  // namespace pcl_symmetry::apps
