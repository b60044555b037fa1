#pragma once
// A channel for messages between the server and a child process, over a pair of Unix sockets.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stop_token>
#include <string>
#include <string_view>

namespace oval4d::process {

/// A message type. The comment on each type describes its body. A child process first sends `ready`, or `failed` if it
/// cannot work. Then the server sends requests, one at a time:
/// - To a rasterizer process (which draws pictures), the server sends `draw`. The process answers `drawn` or `failed`.
///   If the process lacks the object to draw, it first sends `object_missing`. The server then sends a
///   `file_descriptor` for each mapped file of the object, and finally `object`.
/// - To a file reader process (which parses files of clients), the server sends `file`, followed by a
///   `file_descriptor` for each file of a series. The process answers `outcome`. Before the answer, the process may
///   ask for files with `new_file` and `find_file`. The server answers each of them with `file_descriptor`, which
///   carries no descriptor if there is no such file. If the file cannot be opened on this machine, the server instead
///   answers `find_file` with `file_bytes`.
enum class MessageType : std::uint32_t {
    ready,           ///< empty body
    draw,            ///< raster::DrawRequest; carries the file descriptor of the SharedPixels to draw to
    object,          ///< the object, encoded by slicing::encodeObject()
    object_missing,  ///< empty body
    drawn,           ///< raster::DrawTimes, the durations of the parts of drawing
    failed,          ///< the reason for the failure, as text
    file,  ///< the command to read a file (file_reading::FileReadRequest); may carry the file descriptor of the
           ///< file
    /// Empty body. Carries the descriptor of a mapped file, of a new file, or of a file of a series or folder.
    file_descriptor,
    new_file,    ///< the size in bytes of a new file that the process needs, as std::size_t
    find_file,   ///< the wanted file, encoded by file_reading::encodeFindRequest()
    file_bytes,  ///< the bytes of the part that `find_file` has asked for
    outcome,     ///< the object that was read, or an error
};

/// A limit on the time for which an operation of a Channel waits for the other end. The wait ends at a point in time,
/// or when a stop is requested. By default, there is no limit.
struct WaitLimit {
    using Clock = std::chrono::steady_clock;
    Clock::time_point until = Clock::time_point::max();
    std::stop_token stop;  ///< when a stop is requested, the wait ends within 0.1 s
};

/// The result of sending or receiving a message. After any result except `complete`, the channel can no longer be used.
enum class TransferResult {
    complete,
    closed,     ///< the other end of the channel is closed
    timed_out,  ///< the time limit has passed, or a stop was requested
};

/// One end of a socket pair, which sends and receives messages. The destructor closes the socket.
class Channel {
  public:
    explicit Channel(int socket) : socket_(socket) {}
    ~Channel();
    Channel(const Channel&) = delete;
    Channel& operator=(const Channel&) = delete;

    static constexpr int kNoFile = -1;
    static constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

    /// Sends a message. Unless `file` is kNoFile, the receiver also gets a duplicate of the file descriptor `file`.
    TransferResult send(MessageType type, std::string_view body = {}, int file = kNoFile,
                        const WaitLimit& limit = {}) const;
    /// Receives a message. If `file` is not null, sets `*file` to the file descriptor that came with the message, or to
    /// kNoFile if none came; the caller must close the descriptor. Throws std::runtime_error if the body has more than
    /// `maxBytes` bytes.
    TransferResult receive(MessageType& type, std::string& body, int* file = nullptr, const WaitLimit& limit = {},
                           std::size_t maxBytes = kNoLimit) const;

    /// Waits until a message can be received, or the other end is closed. Returns false if `limit` is reached first.
    bool waitForMessage(const WaitLimit& limit) const;

  private:
    int socket_;
};

}  // namespace oval4d::process
