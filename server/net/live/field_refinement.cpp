#include "net/live/field_refinement.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <cstdint>
#include <exception>
#include <utility>

#include "fields/field.hpp"
#include "net/services.hpp"
#include "parallel/canceled.hpp"
#include "session/field_replacement.hpp"

namespace oval4d::net {

namespace asio = boost::asio;

namespace {

// Returns whether the object is the level `level` of a multiscale image. After a file was replaced, an image may have
// other levels.
bool isImageLevel(const slicing::Object& object, std::uint32_t level) {
    const fields::Field* const field = slicing::fieldIn(object);
    return field != nullptr && field->imageLevel.levels > 0 && field->imageLevel.level == level;
}

}  // namespace

FieldRefinement::FieldRefinement(asio::any_io_executor strand, std::shared_ptr<MeteredSession> metered,
                                 std::function<bool()> hasClients, Reader read, std::function<void()> refined)
    : strand_(std::move(strand)),
      metered_(std::move(metered)),
      hasClients_(std::move(hasClients)),
      read_(std::move(read)),
      refined_(std::move(refined)) {}

void FieldRefinement::startOrStopAsNeeded() {
    if (isRunning_) {
        if (!hasClients_() || metered_->value.current.source != coarser_) stop_.request_stop();
        return;
    }
    if (!nextLoadCommand()) return;
    isRunning_ = true;
    asio::co_spawn(strand_, refine(shared_from_this()), asio::detached);
}

/// Returns the command that loads the next finer level. Returns an empty optional if there is no finer level or no
/// client.
std::optional<session::LoadObject> FieldRefinement::nextLoadCommand() const {
    if (!hasClients_()) return {};
    return session::loadCommandForFinerLevel(metered_->value.current);
}

asio::awaitable<void> FieldRefinement::refine(std::shared_ptr<FieldRefinement> self) {
    session::Session& value = self->metered_->value;
    for (;;) {
        const std::optional<session::LoadObject> load = self->nextLoadCommand();
        if (!load) break;
        self->coarser_ = value.current.source;
        self->stop_ = std::stop_source();
        Result<slicing::Object> finer = kInternalError;
        bool isCanceled = false;
        try {
            finer = co_await self->read_(*load, self->stop_.get_token());
        } catch (const parallel::Canceled&) {
            isCanceled = true;
        } catch (const std::exception& fault) {
            spdlog::warn("finer level not read data=\"{}\" fault=\"{}\"", load->dataName, fault.what());
        }
        if (self->stop_.stop_requested()) continue;  // nobody needs this level anymore
        if (isCanceled) break;                       // the server stops
        const bool isNext = finer && isImageLevel(*finer, load->finer->level);
        session::replaceField(value, self->coarser_, isNext ? *finer : session::withoutFinerLevels(self->coarser_),
                              session::FieldReplacementKind::finer);
        self->metered_->adjustReservationOrTrimUndo(true);
        self->refined_();
    }
    self->coarser_ = slicing::Object();
    self->isRunning_ = false;
}

}  // namespace oval4d::net
