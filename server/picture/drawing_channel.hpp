#pragma once
// What the server and its drawing processes say to each other, over a pair of sockets.

#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>

#include "geometry/polytope.hpp"
#include "scene/scene.hpp"
#include "session/session.hpp"

namespace oval4d::picture {

/// A drawing process begins with `ready`. It answers an order with `drawn`, or `failed`, or first `polytope_missing`.
enum class Said : std::uint32_t {
    ready,             ///< nothing
    order,             ///< an Order, with the file of SharedPixels to draw into
    polytope,          ///< the polytope
    polytope_missing,  ///< nothing
    drawn,             ///< Times
    failed,            ///< why
};

struct DrawingLimits {
    std::size_t fillSteps = 0;      ///< of a picture, as geometry::Filler counts them
    std::size_t polytopeBytes = 0;  ///< of polytopes kept for the next picture
};

/// All that a picture is made from.
struct Order {
    std::uint64_t polytope = 0;  ///< its serial; the polytope itself is sent where it is missing
    session::State state;        ///< without its polytope, and what no picture depends on
    scene::Viewport viewport;
    DrawingLimits limits;
};

/// `out` is overwritten. Decoding throws std::runtime_error.
void encodeOrder(const session::State& state, scene::Viewport viewport, const DrawingLimits& limits, std::string& out);
void decodeOrder(std::string_view bytes, Order& out);
void encodePolytope(const geometry::Polytope& polytope, std::string& out);
void decodePolytope(std::string_view bytes, geometry::Polytope& out);

/// How long the other end is waited for: for ever, unless something is said here.
struct Patience {
    using Clock = std::chrono::steady_clock;
    Clock::time_point until = Clock::time_point::max();
    std::stop_token stop;  ///< noticed within a tenth of a second
};

/// What became of a message.
enum class Passage {
    whole,   ///< it has passed
    closed,  ///< nobody is at the other end any more
    late,    ///< patience has ended before; the channel is of no more use
};

/// One end of the pair, closed when this is destroyed. Messages are of any length.
class DrawingChannel {
  public:
    explicit DrawingChannel(int socket) : socket_(socket) {}
    ~DrawingChannel();
    DrawingChannel(const DrawingChannel&) = delete;
    DrawingChannel& operator=(const DrawingChannel&) = delete;

    static constexpr int kNoFile = -1;

    /// `file` stays open, and is sent along as another for the same.
    Passage send(Said said, std::string_view body = {}, int file = kNoFile, const Patience& patience = {}) const;
    /// Where a file is wanted, `file` becomes one that is the receiver's to close, or kNoFile.
    Passage receive(Said& said, std::string& body, int* file = nullptr, const Patience& patience = {}) const;

    /// Whether anything, be it the end, came in time.
    bool wait(const Patience& patience) const;

  private:
    int socket_;
};

}  // namespace oval4d::picture
