#include "raster/rasterizer_process.hpp"

#include <cstring>
#include <stdexcept>
#include <utility>

#include "raster/rasterizer_service.hpp"
#include "slicing/object_bytes.hpp"

namespace oval4d::raster {

using process::Channel;
using process::MessageType;
using process::TransferResult;
using process::WaitLimit;

namespace {

// The maximum length of an answer of a rasterizer process, in bytes. The longest answers are messages that say why a
// picture failed.
constexpr std::size_t kMaxAnswer = 64U << 10U;

process::ChildOptions childOptions(int threads, const RasterizerOptions& options) {
    process::ChildOptions child;
    child.command = kRasterizerCommand;
    child.environment = options.environment;
    child.environment.push_back("LP_NUM_THREADS=" + std::to_string(threads));
    child.timeout = options.timeout;
    child.onLoss = options.onLoss;
    return child;
}

}  // namespace

RasterizerProcess::RasterizerProcess(int threads, const RasterizerOptions& options)
    : limits_(options.limits), process_(childOptions(threads, options)) {}

/// Receives messages until a message of the type `drawn` or `failed` comes. Keeps the type of this message in answer_
/// and its body in body_. Sends the object `source` if the process asks for it.
TransferResult RasterizerProcess::receiveAnswerSendingObject(const slicing::Object& source, const Channel& channel,
                                                             const WaitLimit& limit) {
    for (bool sent = false;; sent = true) {
        TransferResult transfer = channel.receive(answer_, body_, nullptr, limit, kMaxAnswer);
        if (transfer != TransferResult::complete || answer_ == MessageType::drawn || answer_ == MessageType::failed)
            return transfer;
        if (answer_ != MessageType::object_missing || sent)
            throw std::runtime_error("a rasterizer process sent an unexpected message");
        std::string object;  // a local variable, so that its memory is freed: the object is large and rarely sent
        slicing::MappedFiles files;
        slicing::encodeObject(source, object, files);
        for (const auto& file : files) {
            transfer = channel.send(MessageType::file_descriptor, {}, file->descriptor(), limit);
            if (transfer != TransferResult::complete) return transfer;
        }
        transfer = channel.send(MessageType::object, object, Channel::kNoFile, limit);
        if (transfer != TransferResult::complete) return transfer;
    }
}

void RasterizerProcess::warmUp(const std::stop_token& stop) {
    process_.converseWithRetry([](const Channel&, const WaitLimit&) { return TransferResult::complete; }, stop);
}

std::span<const std::uint8_t> RasterizerProcess::draw(const scene::PictureRequest& picture, SharedPixels& pixels,
                                                      DrawTimes& times, const std::stop_token& stop) {
    encodeDrawRequest(picture, limits_, request_);
    const auto drawn = pixels.resize(image::byteCount(picture.viewport.width, picture.viewport.height));
    process_.converseWithRetry(
        [&](const Channel& channel, const WaitLimit& limit) {
            const TransferResult sent = channel.send(MessageType::draw, request_, pixels.file(), limit);
            return sent == TransferResult::complete ? receiveAnswerSendingObject(picture.source, channel, limit) : sent;
        },
        stop);
    if (answer_ == MessageType::failed) throw std::runtime_error(body_);
    if (body_.size() != sizeof times) throw std::runtime_error("a rasterizer process sent a truncated message");
    std::memcpy(&times, body_.data(), sizeof times);
    return drawn;
}

}  // namespace oval4d::raster
