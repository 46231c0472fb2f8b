/// Messages between the processes of an MPI run.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace pcl_symmetry::apps {

/// What one process tells another.
struct Message {
  enum class Word : char {
    Next,   ///< to the first process: here is a result, what is next?
    Text,   ///< to the first process: what is text number item? And its answer
    Alive,  ///< to the first process: I am at work; has no answer
    Gone,   ///< to the first process: I need nothing more; has no answer
    Item,   ///< from the first process: do this item
    Wait,   ///< from the first process: ask again
    Over    ///< from the first process: all items of the run are done
  };
  Word word = Word::Next;
  std::int64_t run = 0;    ///< number of the run, from 1
  std::int64_t item = -1;  ///< -1 for none
  std::string bytes = {};
};

/// Sends and receives messages; one thread at a time. A process that dies leaves the others able to go on, where MPI
/// lets them.
class MessageChannel {
public:
  MessageChannel();
  ~MessageChannel();

  int rank() const;
  int size() const;

  /// \throws std::runtime_error where the message was not taken within a minute.
  void send(int to, const Message& message);
  /// \return the sender and the message; none where there is none yet, or its sender died while it came.
  std::optional<std::pair<int, Message>> receive();

  /// Ends all processes.
  [[noreturn]] void abort(int code);

private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace pcl_symmetry::apps
