#pragma once
// Replaces the level of a multiscale image that a session shows by finer ones, in the background.

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

/// Reads the finer levels of the image that a session shows, one after another, as many as follow (see
/// fields::ImageLevel::finer). Each replaces the one before in place: see session::replaceField(). This ends when the
/// session shows another object, when its last client leaves, or when a level cannot be read; the level that is shown
/// then stays. It begins again when the image is shown again, and when a client comes. Every function runs on the
/// session's strand.
class FieldRefinement : public std::enable_shared_from_this<FieldRefinement> {
  public:
    /// Reads what `load` names. May throw parallel::Canceled after a request of `stop`.
    using Reader =
        std::function<boost::asio::awaitable<Result<slicing::Object>>(session::LoadObject load, std::stop_token stop)>;

    /// `hasClients` tells whether clients are connected to the session `metered`. `refined` is called after each change
    /// of the session.
    FieldRefinement(boost::asio::any_io_executor strand, std::shared_ptr<MeteredSession> metered,
                    std::function<bool()> hasClients, Reader read, std::function<void()> refined);

    /// Begins or ends the reading of finer levels, as the object that the session shows and its clients demand. Must be
    /// called when these may have changed.
    void update();

  private:
    static boost::asio::awaitable<void> refine(std::shared_ptr<FieldRefinement> self);
    std::optional<session::LoadObject> nextLoad() const;

    const boost::asio::any_io_executor strand_;
    const std::shared_ptr<MeteredSession> metered_;
    const std::function<bool()> hasClients_;
    const Reader read_;
    const std::function<void()> refined_;
    bool isRunning_ = false;   // whether refine() is running
    slicing::Object coarser_;  // while a level is being read: the field that it will replace; else null
    std::stop_source stop_;    // of the reading
};

}  // namespace oval4d::net
