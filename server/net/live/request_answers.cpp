#include "net/live/request_answers.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/co_spawn.hpp>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "net/jobs/data_names.hpp"
#include "net/jobs/export_job.hpp"
#include "net/jobs/run_on_pool.hpp"
#include "net/live/errors.hpp"
#include "pipeline/cost.hpp"
#include "session/picture.hpp"
#include "session/query.hpp"
#include "session/settings.hpp"
#include "slicing/element.hpp"
#include "slicing/field_sample.hpp"
#include "wire/messages.hpp"

namespace oval4d::net {

namespace asio = boost::asio;
using wire::StreamKind;

namespace {

/// A completion handler for a coroutine of RequestAnswerer. Keeps the RequestAnswerer alive until the coroutine has
/// ended.
struct AnswersLifetimeGuard {
    std::shared_ptr<RequestAnswerer> answers;
    void operator()(const std::exception_ptr& /*failure*/) const {}
};

}  // namespace

RequestAnswerer::RequestAnswerer(Services services, SessionPublisher::Strand strand, std::string sessionId,
                                 std::shared_ptr<MeteredSession> metered, std::shared_ptr<SessionPublisher> publisher,
                                 std::shared_ptr<ObjectLoading> loading)
    : services_(services),
      strand_(std::move(strand)),
      sessionId_(std::move(sessionId)),
      metered_(std::move(metered)),
      session_(metered_->value),
      publisher_(std::move(publisher)),
      loading_(std::move(loading)) {}

asio::awaitable<void> RequestAnswerer::answerGet(std::shared_ptr<Peer> peer, wire::Get get, RequestId id) {
    const PictureStreamKey* const stream = publisher_->streamOf(*peer);
    if (stream == nullptr) co_return;
    PictureStreamKey key = *stream;
    if (get.viewport) key.viewport = *get.viewport;
    key.background = get.background;
    key.highlight = get.highlight;
    if (const auto element = get.highlight.value_or(std::nullopt)) {
        if (const auto exists = session::checkElement(session_.current.object, *element); !exists) {
            sendError(*peer, services_.metrics, exists.error(), id);
            co_return;
        }
    }
    switch (get.what) {
        case wire::GetTarget::state:
            co_await answerWithState(peer, key.scheme, id);
            break;
        case wire::GetTarget::catalogue: {
            const std::vector<std::string> names = co_await dataFolderNames(services_, peer->client());
            std::vector<slicing::Object> loaded;
            for (const auto& [name, object] : session_.loaded) loaded.push_back(object);
            peer->send(textMessage(wire::catalogueMessage(id, loaded, names)));
            break;
        }
        case wire::GetTarget::keymap:
            peer->send(textMessage(wire::keymapMessage(id)));
            break;
        case wire::GetTarget::address:
            answerWithViewLink(*peer, id);
            break;
        case wire::GetTarget::slices:
            key.stream = StreamKind::geometry;
            co_await answerWithPicture(peer, key, id);
            break;
        case wire::GetTarget::frame:
            key.stream = StreamKind::frames;
            co_await answerWithPicture(peer, key, id);
            break;
        case wire::GetTarget::at:
            key.stream = StreamKind::geometry;
            if (get.fieldPoint) {
                co_await answerWithSample(peer, *get.fieldPoint, id);
            } else {
                co_await answerWithPicture(peer, key, id, get.point);
            }
            break;
        case wire::GetTarget::file:
            co_await answerWithFile(peer, get.file, id);
            break;
        case wire::GetTarget::critical:
            // The search may take long, so further messages of the client do not wait for this answer.
            asio::co_spawn(strand_, answerWithCriticalValues(peer, id), AnswersLifetimeGuard{shared_from_this()});
            break;
    }
}

void RequestAnswerer::answer(Peer& peer, const wire::Measure& measure, RequestId id) {
    // Measures State::source, which has the coordinates of the object's file. State::object is State::source after the
    // transformation to the frame of reference.
    const slicing::Object& object = session_.current.source;
    const slicing::Element element{measure.element, measure.number};
    if (const auto exists = session::checkElement(object, element); !exists) {
        sendError(peer, services_.metrics, exists.error(), id);
        return;
    }
    const slicing::ElementMeasurements found = slicing::measureElement(object, element);
    wire::Measured measured{revision(), found.length, found.area, found.volume, found.center};
    if (element.kind == slicing::ElementKind::cell) measured.kind = slicing::typesOfCells(object)[element.index];
    if (element.kind == slicing::ElementKind::face) measured.name = slicing::nameOfFace(object, element.index);
    if (!found.unit.empty()) measured.unit = found.unit;
    if (measure.highlight) {
        const slicing::Object& shown = session_.current.object;
        slicing::findPartsShowing(shown, element, measured.highlight.emplace());
        const auto [least, most] = slicing::rangeOfW(shown, session_.current.orientation, element);
        measured.range = slicing::infoOf(shown).originInFile.w + glm::dvec2(least, most);
    }
    peer.send(textAnswer(measured, id));
}

void RequestAnswerer::answer(Peer& peer, const wire::Ping& /*ping*/, RequestId id) {
    const parallel::WorkerPool& workers = services_.pictureWorkers.workers();
    peer.send(textAnswer(wire::Pong{workers.size(), workers.waitingJobCount(), workers.busyTime().count(),
                                    Seconds(services_.clock.now().time_since_epoch()).count()},
                         id));
}

asio::awaitable<void> RequestAnswerer::answerWithState(std::shared_ptr<Peer> peer, scene::ColorScheme scheme,
                                                       RequestId id) {
    SessionSnapshotPtr state = publisher_->currentState();
    std::optional<Error> failed;
    try {
        if (!state) {
            state = co_await runOnPool<SessionSnapshotPtr>(services_.pictureWorkers, publisher_->currentStateJob(),
                                                           publisher_->jobQueuesOf(peer->client()).pictures,
                                                           pipeline::focusSectionCost(session_.current.object));
            publisher_->storeStateIfCurrent(state);
        }
        peer->send({state->stateTextFor(scheme, id), false});
    } catch (const parallel::QueueFull&) {
        failed = kTooManyJobs;
    } catch (const std::exception& fault) {
        spdlog::error("state failed session={} fault=\"{}\"", sessionId_, fault.what());
        failed = kInternalError;
    }
    if (failed) sendError(*peer, services_.metrics, *failed, id);
}

void RequestAnswerer::answerWithViewLink(Peer& peer, RequestId id) {
    session::ObjectLoader loader = loading_->makeLoader();
    const auto query = session::queryFromState(session_.current, loader);
    if (query) {
        peer.send(textAnswer(session::ShowLinkedView{session::queryText(*query)}, id));
    } else {
        sendError(peer, services_.metrics, query.error(), id);
    }
}

asio::awaitable<void> RequestAnswerer::answerWithFile(std::shared_ptr<Peer> peer, exports::ExportRequest request,
                                                      RequestId id) {
    const std::uint64_t askedRevision = revision();
    ExportResult made;
    try {
        const scene::PictureRequest picture = session::pictureRequestOf(session_.current);
        made = co_await runOnPool<ExportResult>(
            services_.exportWorkers, exportJob(services_, picture, request, peer->client()),
            publisher_->jobQueuesOf(peer->client()).exports, pipeline::exportCost(picture, request));
    } catch (const parallel::QueueFull&) {
        made = kTooManyJobs;
    } catch (const std::exception& fault) {
        made = logAndClassifyFailure(session_.current, sessionId_, askedRevision, fault, kInternalError);
    }
    if (!made || !*made) {
        sendError(*peer, services_.metrics, made ? made->error() : kInternalError, id);
        co_return;
    }
    const FinishedExport& finished = **made;
    OutgoingMessage message;
    message.bytes = finished.bytes;
    message.binary = true;
    peer->send(std::move(message));
    peer->send(textAnswer(wire::Done{askedRevision, finished.warnings}, id));
}

asio::awaitable<void> RequestAnswerer::answerWithCriticalValues(std::shared_ptr<Peer> peer, RequestId id) {
    const std::uint64_t askedRevision = revision();
    const double originW = slicing::infoOf(session_.current.object).originInFile.w;
    Result<slicing::CriticalSectionsPtr> found = kInternalError;
    try {
        found = co_await findCriticalValues(peer);
    } catch (const parallel::QueueFull&) {
        found = kTooManyJobs;
    } catch (const std::exception& fault) {
        found = logAndClassifyFailure(session_.current, sessionId_, askedRevision, fault, kInternalError);
    }
    if (!found) {
        sendError(*peer, services_.metrics, found.error(), id);
        co_return;
    }
    peer->send(textMessage(wire::criticalMessage(**found, originW, askedRevision, id)));
}

/// Finds the critical values of w of the current object. If they are not known yet, an export worker searches for them.
asio::awaitable<Result<slicing::CriticalSectionsPtr>> RequestAnswerer::findCriticalValues(std::shared_ptr<Peer> peer) {
    session::ObjectLoader loader = loading_->makeLoader();
    const session::State asked = session_.current;
    auto found = loader.criticalSections(asked);
    if (!loader.isPending()) co_return found;
    if (auto refused = co_await loading_->completePending(peer->client(), peer, loader)) co_return *refused;
    co_return loader.criticalSections(asked);
}

asio::awaitable<void> RequestAnswerer::answerWithPicture(std::shared_ptr<Peer> peer, PictureStreamKey key, RequestId id,
                                                         std::optional<glm::dvec2> point) {
    const std::uint64_t askedRevision = revision();
    std::optional<Error> failed;
    try {
        const Seconds cost =
            point ? pipeline::pointDescriptionCost(session::pictureRequestOf(session_.current, key.viewport))
                  : pictureCost(session_.current, key, slicing::Quality::full);
        OutgoingMessage picture =
            co_await runOnPool<OutgoingMessage>(services_.pictureWorkers, requestedPictureJob(key, id, point),
                                                publisher_->jobQueuesOf(peer->client()).pictures, cost);
        peer->send(std::move(picture));
        if (key.stream == StreamKind::frames) peer->send(textAnswer(wire::Done{askedRevision}, id));
    } catch (const parallel::QueueFull&) {
        failed = kTooManyJobs;
    } catch (const std::exception& fault) {
        failed = logAndClassifyFailure(session_.current, sessionId_, askedRevision, fault, kInternalError);
    }
    if (failed) sendError(*peer, services_.metrics, *failed, id);
}

asio::awaitable<void> RequestAnswerer::answerWithSample(std::shared_ptr<Peer> peer, glm::dvec4 point, RequestId id) {
    const std::uint64_t askedRevision = revision();
    std::optional<Error> failed;
    if (slicing::fieldIn(session_.current.object) == nullptr) {
        failed = Error{ErrorCode::out_of_range,
                       "the " + slicing::infoOf(session_.current.object).name + " is not a field, so it has no values"};
    } else {
        try {
            peer->send(co_await runOnPool<OutgoingMessage>(services_.pictureWorkers, sampleJob(point, id),
                                                           publisher_->jobQueuesOf(peer->client()).pictures,
                                                           pipeline::sampleCost(session_.current.object)));
        } catch (const parallel::QueueFull&) {
            failed = kTooManyJobs;
        } catch (const std::exception& fault) {
            failed = logAndClassifyFailure(session_.current, sessionId_, askedRevision, fault, kInternalError);
        }
    }
    if (failed) sendError(*peer, services_.metrics, *failed, id);
}

/// Returns a job that finds the values of the current field at `point`. This is a point of the rotated field. Its
/// coordinates are measured from the origin of the object's file, not from that of the object.
std::function<OutgoingMessage(pipeline::Pipeline&)> RequestAnswerer::sampleJob(const glm::dvec4& point,
                                                                               RequestId id) const {
    return [state = session_.current, point, askedRevision = revision(), id](pipeline::Pipeline& /*pipeline*/) {
        const glm::dvec4 fromOrigin = point - slicing::infoOf(state.object).originInFile;
        return textMessage(wire::sampleMessage(
            slicing::sampleField(*slicing::fieldIn(state.object), state.orientation, fromOrigin), askedRevision, id));
    };
}

/// Returns a job that makes a picture of the current state. If `point`, a point of the picture in pixels, is given, the
/// job instead makes the message that tells what the picture shows there.
std::function<OutgoingMessage(pipeline::Pipeline&)> RequestAnswerer::requestedPictureJob(
    const PictureStreamKey& key, RequestId id, std::optional<glm::dvec2> point) const {
    const SessionSnapshotPtr known = publisher_->currentFullSnapshot();
    return
        [known, state = session_.current, askedRevision = revision(), changed = publisher_->lastChangeTime(), key, id,
         point, section = publisher_->lastNamedSection(), &metrics = services_.metrics](pipeline::Pipeline& pipeline) {
            if (section) pipeline.reuseFocusSectionNames(*section);
            if (point) {
                const scene::PictureRequest picture = session::pictureRequestOf(state, key.viewport);
                return textMessage(pipeline.describePoint(picture, askedRevision, id, *point));
            }
            const SessionSnapshotPtr snapshot =
                isSufficientFor(known, key)
                    ? known
                    : makeSnapshot(pipeline, state, askedRevision, changed, key, slicing::Quality::full);
            OutgoingMessage picture = makePicture(pipeline, *snapshot, key, id);
            metrics.observe(pipeline.times());
            return picture;
        };
}

}  // namespace oval4d::net
