#include "file_reading/file_reader_service.hpp"

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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

int receiveDescriptor(const Channel& channel) {
    MessageType type{};
    std::string body;
    int descriptor = Channel::kNoFile;
    if (channel.receive(type, body, &descriptor) != TransferResult::complete) throw std::runtime_error("no file");
    return descriptor;
}

// Receives and maps the `count` files of a series. Closes each descriptor after it has mapped the file, because the
// process may have only few open descriptors.
Result<std::vector<fields::FileContents>> receiveSeries(const Channel& channel, std::size_t count) {
    std::vector<fields::FileContents> files;
    std::optional<Error> fault;  // the first error; after it, the remaining files are still received
    while (count-- > 0) {
        const fields::FileHandle part(receiveDescriptor(channel));
        auto file = fields::FileContents::map(part.descriptor());
        if (file) files.push_back(std::move(*file));
        if (!file && !fault) fault = file.error();
    }
    if (fault) return std::move(*fault);
    return files;
}

const Error kLost{ErrorCode::bad_field, "the file was shortened, or cannot be read any more, while it was being read"};

// Reads the file, the series or the folder of one request. Requests further files from the server.
class RequestedObjectReader {
  public:
    RequestedObjectReader(const Channel& channel, FileReadRequest request)
        : channel_(channel), request_(std::move(request)) {}

    // Reads the requested object, and writes the encoded outcome to `body`.
    void readAndEncode(std::string& body) {
        auto outcome = readRequestedObject();
        if (outcome && std::ranges::any_of(sources_, [](const auto& each) { return each.file && each.file->isLost(); }))
            outcome = kLost;
        encodeOutcome(outcome, body, mapped_,
                      request_.mayMap ? request_.limits.maxFieldBytes / sizeof(float) : fields::kMaxSamples);
    }

  private:
    Result<session::ObjectWithWarnings> readRequestedObject() {
        const session::LoadObject& load = request_.load;
        if (request_.seriesLength == 0 && !load.file && !request_.isFolder)
            return session::readObject(load, request_.limits);
        fields::MappedFileMaker newFile;
        if (request_.mayMap) newFile = [this](std::size_t bytes) { return requestNewFile(bytes); };
        const fields::FieldReadOptions options =
            session::fieldReadOptionsFor(load, request_.limits, std::move(newFile));
        if (request_.isFolder) {
            const auto find = [this](const std::string& path, const fields::FilePart& part) {
                return findFile(path, part);
            };
            return session::readZarr(find, load.name, options, {load.secondFormula, load.secondVariable});
        }
        if (request_.seriesLength > 0) {
            auto files = receiveSeries(channel_, request_.seriesLength);
            if (!files) return files.error();
            sources_ = std::move(*files);
            return session::readSeries(sources_, load, options);
        }
        auto contents = fields::FileContents::map(load.file->descriptor());
        if (!contents) return contents.error();
        sources_.push_back(*contents);
        mapped_.push_back(contents->file);
        return session::readArray(*contents, load.name, options, {load.secondFormula, load.secondVariable});
    }

    // Requests a new file of `bytes` bytes from the server. If there is no room for the file, the server kills this
    // process and does not answer.
    Result<std::shared_ptr<fields::MappedFile>> requestNewFile(std::size_t bytes) {
        channel_.send(MessageType::new_file, {reinterpret_cast<const char*>(&bytes), sizeof bytes});
        auto file =
            fields::MappedFile::mapForWriting(std::make_shared<const fields::FileHandle>(receiveDescriptor(channel_)));
        if (file) mapped_.push_back(*file);
        return file;
    }

    // Returns a part of a file in the requested folder, or an empty optional if there is no such file. `path` is
    // relative to the folder. The server sends the bytes, or a descriptor of the file. The last file that came as a
    // descriptor stays mapped, so that a shard (a file with many chunks) is requested only once.
    Result<std::optional<fields::FileContents>> findFile(const std::string& path, const fields::FilePart& part) {
        if (lastFile_ && lastPath_ == path) return std::optional(lastFile_->partialContents(part));
        std::string body;
        encodeFindRequest({path, part}, body);
        channel_.send(MessageType::find_file, body);
        MessageType type{};
        int descriptor = Channel::kNoFile;
        if (channel_.receive(type, body, &descriptor) != TransferResult::complete) throw std::runtime_error("no file");
        if (type == MessageType::file_bytes) return std::optional(fields::FileContents::ofString(std::move(body)));
        const fields::FileHandle file(descriptor);
        if (file.descriptor() < 0) return std::optional<fields::FileContents>();
        auto contents = fields::FileContents::map(file.descriptor());
        if (!contents) return Error{contents.error().code, path + ": " + contents.error().message};
        lastPath_ = path;
        lastFile_ = std::move(*contents);
        return std::optional(lastFile_->partialContents(part));
    }

    const Channel& channel_;
    const FileReadRequest request_;
    std::vector<fields::FileContents> sources_;
    slicing::MappedFiles mapped_;  // the mapped files, in the order in which FileReaderPool::read() maps the same files
    std::string lastPath_;         // the path of lastFile_ in the folder
    std::optional<fields::FileContents> lastFile_;  // the last file of the folder that findFile() has mapped
};

// Executes the request in `body`, the body of a message MessageType::file. Replaces `body` by the body of the answer, a
// message MessageType::outcome. `descriptor` is the open file that came with the request, or kNoFile.
void replaceRequestByOutcome(const Channel& channel, std::string& body, int descriptor) {
    try {
        FileReadRequest request;
        decodeReadRequest(body, request);
        body = {};
        if (descriptor != Channel::kNoFile) request.load.file = std::make_shared<const fields::FileHandle>(descriptor);
        RequestedObjectReader(channel, std::move(request)).readAndEncode(body);
        return;
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {
    }
    encodeOutcome(kNoMemory, body);  // there is memory for this: the exception has destroyed the object that was being
                                     // read
}

}  // namespace

void runFileReader(int socket, const process::Confinement& confinement) {
    process::initializeChild();
    const Channel channel(socket);
    try {
        process::confine(process::SandboxRole::parse_file, confinement);
    } catch (const std::exception& fault) {
        channel.send(MessageType::failed, fault.what());
        return;
    }
    channel.send(MessageType::ready);
    MessageType type{};
    std::string body;
    int descriptor = Channel::kNoFile;
    if (channel.receive(type, body, &descriptor) != TransferResult::complete) return;
    replaceRequestByOutcome(channel, body, descriptor);
    channel.send(MessageType::outcome, body);
}

}  // namespace oval4d::file_reading
