#pragma once
// Messages between the server and its child processes, over a socket pair.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stop_token>
#include <string>
#include <string_view>

namespace oval4d::process {

/// The type of a message, each with a comment on its body. A child first sends `ready` or `failed`. A child that draws
/// answers an `order` with `drawn` or `failed`; if it lacks the object, it first sends `object_missing`, and the server
/// sends `object`. A child that reads files answers a `file` with `outcome`.
enum class MessageType : std::uint32_t {
    ready,           ///< empty
    draw,            ///< raster::DrawRequest, with the file of SharedPixels to draw into
    object,          ///< written by slicing::encodeObject
    object_missing,  ///< empty
    drawn,           ///< raster::Times
    failed,          ///< the reason, as text
    file,            ///< reading::File
    outcome,         ///< the object that was read, or an error
};

/// When to stop waiting for the other end; by default, never.
struct Deadline {
    using Clock = std::chrono::steady_clock;
    Clock::time_point until = Clock::time_point::max();
    std::stop_token stop;  ///< a request takes effect within 0.1 s
};

/// The result of sending or receiving a message.
enum class Transfer {
    complete,
    closed,     ///< the other end is closed
    timed_out,  ///< or a stop was requested; the channel can no longer be used
};

/// One end of a socket pair. The destructor closes it.
class Channel {
  public:
    explicit Channel(int socket) : socket_(socket) {}
    ~Channel();
    Channel(const Channel&) = delete;
    Channel& operator=(const Channel&) = delete;

    static constexpr int kNoFile = -1;
    static constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

    /// Sends a message, with a duplicate of the file descriptor `file` if there is one.
    Transfer send(MessageType type, std::string_view body = {}, int file = kNoFile,
                  const Deadline& deadline = {}) const;
    /// Receives a message. If `file` is not null, it is set to the file descriptor that came along, which the caller
    /// must close, or to kNoFile. Throws std::runtime_error if the body has more than `maxBytes` bytes.
    Transfer receive(MessageType& type, std::string& body, int* file = nullptr, const Deadline& deadline = {},
                     std::size_t maxBytes = kNoLimit) const;

    /// Waits until there is something to receive or the other end is closed; returns false if neither happens in time.
    bool wait(const Deadline& deadline) const;

  private:
    int socket_;
};

}  // namespace oval4d::process
