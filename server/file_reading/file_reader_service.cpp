#include "file_reading/file_reader_service.hpp"

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

#include "file_reading/file_reader_messages.hpp"
#include "process/channel.hpp"
#include "process/child_process.hpp"
#include "session/load.hpp"

namespace oval4d::file_reading {

using process::Channel;
using process::MessageType;
using process::TransferResult;

namespace {

const Error kNoMemory{ErrorCode::too_large, "reading this file takes more memory than is allowed"};

void outcomeOf(std::string& body) {
    try {
        File file;
        decodeFile(body, file);
        body = {};
        encodeOutcome(session::readObject(file.format, file.text, file.name, file.limits), body);
        return;
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {
    }
    encodeOutcome(kNoMemory, body);  // can allocate memory, because stack unwinding has freed that of the file
}

}  // namespace

void serveFileReader(int socket, const process::Confinement& confinement) {
    process::initializeChild();
    const Channel channel(socket);
    try {
        process::confine(process::Role::read, confinement);
    } catch (const std::exception& fault) {
        channel.send(MessageType::failed, fault.what());
        return;
    }
    channel.send(MessageType::ready);
    MessageType type{};
    std::string body;
    if (channel.receive(type, body) != TransferResult::complete) return;
    outcomeOf(body);
    channel.send(MessageType::outcome, body);
}

}  // namespace oval4d::file_reading
