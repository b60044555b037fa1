#pragma once
// Replaces a coarse level of a multiscale image by finer levels, in the background, while a session shows the image.

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

#include "errors/error.hpp"
#include "net/live/metered_session.hpp"
#include "session/command.hpp"
#include "session/session.hpp"

namespace oval4d::net {

/// Reads the finer levels of the image that a session shows, one after another (see
/// fields::MultiscaleImageLevel::finer). Each level replaces the one before it (see session::replaceField()). Reading
/// ends when the session shows another object, when its last client leaves, or when a level cannot be read; the session
/// then keeps the level that it has. Reading begins again when the image is shown again or a client comes. Every
/// function runs on the session's strand.
class FieldRefinement : public std::enable_shared_from_this<FieldRefinement> {
  public:
    /// A function that reads the object that `load` describes. It may throw parallel::Canceled after `stop` has
    /// requested a stop.
    using Reader =
        std::function<boost::asio::awaitable<Result<slicing::Object>>(session::LoadObject load, std::stop_token stop)>;

    /// `metered` is the session, and `strand` is its strand. `hasClients` tells whether clients are connected to the
    /// session. `read` reads the levels. `refined` is called each time that a finer level has replaced a coarser one.
    FieldRefinement(boost::asio::any_io_executor strand, std::shared_ptr<MeteredSession> metered,
                    std::function<bool()> hasClients, Reader read, std::function<void()> refined);

    /// Begins or ends the reading of finer levels, as needed for the shown object and the present clients. Must be
    /// called when the object or the clients may have changed.
    void startOrStopAsNeeded();

  private:
    static boost::asio::awaitable<void> refine(std::shared_ptr<FieldRefinement> self);
    std::optional<session::LoadObject> nextLoadCommand() const;

    const boost::asio::any_io_executor strand_;
    const std::shared_ptr<MeteredSession> metered_;
    const std::function<bool()> hasClients_;
    const Reader read_;
    const std::function<void()> refined_;
    bool isRunning_ = false;   // whether refine() is running
    slicing::Object coarser_;  // the field that the level being read will replace; null while no level is being read
    std::stop_source stop_;    // stops the reading of a level
};

}  // namespace oval4d::net
