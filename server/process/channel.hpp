#pragma once
// Messages between the server and its child processes, sent over a socket pair.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stop_token>
#include <string>
#include <string_view>

namespace oval4d::process {

/// The types of messages; the comment on each describes the body. A child process starts with `ready`, or with `failed`
/// if it cannot work. Then the server sends requests, one at a time:
/// - To a rasterizer process, the server sends `draw`; the process answers `drawn` or `failed`. If the process does not
///   have the object to draw, it sends `object_missing` before that, and the server sends a `file_descriptor` for each
///   mapped file to which the object refers, then `object`.
/// - To a file reader process, the server sends `file` and, to read a series, a `file_descriptor` for each file of the
///   series; the process answers `outcome`. Before that, the process may ask for files with `new_file` and `find_file`.
///   The server answers each with `file_descriptor`, which carries no file descriptor if there is no such file, or
///   `find_file` with `file_bytes`, if the file cannot be opened where it is.
enum class MessageType : std::uint32_t {
    ready,            ///< empty
    draw,             ///< raster::DrawRequest; carries the file descriptor of the SharedPixels to draw into
    object,           ///< written by slicing::encodeObject()
    object_missing,   ///< empty
    drawn,            ///< raster::DrawTimes
    failed,           ///< the reason, as text
    file,             ///< file_reading::ReadRequest; may carry the file descriptor of the file
    file_descriptor,  ///< empty; carries the descriptor of a mapped file, a new file, or a file of a series or folder
    new_file,         ///< the size in bytes of the new file that the process needs, as std::size_t
    find_file,        ///< written by file_reading::encodeFindRequest()
    file_bytes,       ///< the bytes of the part that `find_file` asked for
    outcome,          ///< the object that was read, or an error
};

/// Limits how long an operation of a Channel waits for the other end: until a point in time, or until a stop is
/// requested. The default is no limit.
struct WaitLimit {
    using Clock = std::chrono::steady_clock;
    Clock::time_point until = Clock::time_point::max();
    std::stop_token stop;  ///< a stop request takes effect within 0.1 s
};

/// The result of sending or receiving a message. After any result but `complete`, the channel can no longer be used.
enum class TransferResult {
    complete,
    closed,     ///< the other end of the channel is closed
    timed_out,  ///< the time limit has passed, or a stop was requested
};

/// One end of a socket pair, which sends and receives messages. Owns the socket: the destructor closes it.
class Channel {
  public:
    explicit Channel(int socket) : socket_(socket) {}
    ~Channel();
    Channel(const Channel&) = delete;
    Channel& operator=(const Channel&) = delete;

    static constexpr int kNoFile = -1;
    static constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

    /// Sends a message. Unless `file` is kNoFile, the receiver gets a duplicate of the file descriptor `file`.
    TransferResult send(MessageType type, std::string_view body = {}, int file = kNoFile,
                        const WaitLimit& limit = {}) const;
    /// Receives a message. If `file` is not null, sets `*file` to the file descriptor that was sent with the message,
    /// which the caller must close, or to kNoFile if there was none. Throws std::runtime_error if the body has more
    /// than `maxBytes` bytes.
    TransferResult receive(MessageType& type, std::string& body, int* file = nullptr, const WaitLimit& limit = {},
                           std::size_t maxBytes = kNoLimit) const;

    /// Waits until a message can be received or the other end is closed. Returns false if `limit` is reached before.
    bool wait(const WaitLimit& limit) const;

  private:
    int socket_;
};

}  // namespace oval4d::process
