#include "file_reading/file_reader_pool.hpp"

#include <spdlog/spdlog.h>

#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

#include "file_reading/file_reader_messages.hpp"
#include "file_reading/file_reader_service.hpp"
#include "text/message_text.hpp"

namespace oval4d::file_reading {

using process::Channel;
using process::ChildProcess;
using process::MessageType;
using process::TransferResult;
using process::WaitLimit;

namespace {

// The nice value of reader processes. Drawing has priority: if a reader process shares a core with a process that draws
// pictures, the reader process gets about a quarter of the CPU time.
constexpr int kNiceness = 5;

}  // namespace

FileReaderPool::FileReaderPool(FileReaderOptions options)
    : options_(std::move(options)), replacing_([this](const std::stop_token& stop) { replaceUsedProcesses(stop); }) {}

FileReaderPool::~FileReaderPool() {
    replacing_.request_stop();
    replacing_.join();
    for (const ChildProcessPtr& process : waiting_) process->kill();  // a waiting process has no file to finish
}

FileReaderPool::ChildProcessPtr FileReaderPool::acquireProcess() {
    {
        const std::lock_guard lock(mutex_);
        if (!waiting_.empty()) {
            ChildProcessPtr process = std::move(waiting_.back());
            waiting_.pop_back();
            return process;
        }
    }
    return std::make_unique<ChildProcess>(process::ChildOptions{kFileReaderCommand, options_.environment,
                                                                options_.timeout, false, options_.onLoss, kNiceness});
}

void FileReaderPool::retireProcess(ChildProcessPtr used) {
    const std::lock_guard lock(mutex_);
    used_.push_back(std::move(used));
    lastUsed_ = Clock::now();
    wake_.notify_all();
}

/// Replaces each process that has read a file by a new one, until `stop` is requested. Keeps at most
/// FileReaderOptions::maxWaiting processes, and kills the others. If no file is read for the time
/// FileReaderOptions::idle, kills all waiting processes. Runs on a thread of its own, so that clients do not wait while
/// processes start.
void FileReaderPool::replaceUsedProcesses(const std::stop_token& stop) {
    const auto idle = std::chrono::duration_cast<Clock::duration>(options_.idle);
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        const auto isUsed = [this] { return !used_.empty(); };
        if (waiting_.empty()) {
            wake_.wait(lock, stop, isUsed);
        } else {
            wake_.wait_until(lock, stop, lastUsed_ + idle, isUsed);
        }
        std::vector<ChildProcessPtr> used = std::exchange(used_, {});
        std::vector<ChildProcessPtr> surplus;
        if (used.empty() && Clock::now() >= lastUsed_ + idle) surplus = std::exchange(waiting_, {});
        // Together, there may be more than maxWaiting processes: if none is waiting, acquireProcess() creates a new
        // one.
        while (!used.empty() && waiting_.size() + used.size() > options_.maxWaiting) {
            surplus.push_back(std::move(used.back()));
            used.pop_back();
        }
        lock.unlock();
        for (const ChildProcessPtr& process : used) {
            process->kill();
            try {
                if (!stop.stop_requested()) process->start();
            } catch (const std::runtime_error& fault) {
                spdlog::warn("cannot start a process in advance to read files fault=\"{}\"", fault.what());
            }
        }
        for (const ChildProcessPtr& process : surplus) process->kill();
        lock.lock();
        for (ChildProcessPtr& process : used) waiting_.push_back(std::move(process));
    }
}

namespace {

// The exchange of messages with a reader process about one file. The file may be malicious and control the process.
class FileReadConversation {
  public:
    FileReadConversation(const session::LoadObject& load, const FileAllocator& allocate)
        : load_(load), allocate_(allocate) {}

    TransferResult run(const Channel& channel, const std::string& file, std::size_t maxBytes, WaitLimit limit) {
        TransferResult transfer = channel.send(MessageType::file, file, descriptorOf(load_.file), limit);
        for (const auto& part : load_.series) {
            if (transfer != TransferResult::complete) return transfer;
            transfer = channel.send(MessageType::file_descriptor, {}, part->descriptor(), limit);
        }
        while (transfer == TransferResult::complete) {
            MessageType answer{};
            transfer = channel.receive(answer, outcome, nullptr, limit, maxBytes);
            if (transfer != TransferResult::complete || answer == MessageType::outcome) break;
            if (answer == MessageType::find_file && load_.folder) {
                transfer = sendFoundFile(channel, limit);
                if (refused) break;  // the process will not be used again
                continue;
            }
            if (answer != MessageType::new_file)
                throw std::runtime_error("a reader process sent an unexpected message");
            const int descriptor = createRequestedFile(limit);
            if (refused) break;  // the process will not be used again
            transfer = channel.send(MessageType::file_descriptor, {}, descriptor, limit);
        }
        return transfer;
    }

    // Maps the loaded file and the new files that the process was given, because the samples of large arrays stay in
    // these files. Returns an empty list if there is no allocate_, because then all samples are in the message.
    Result<slicing::MappedFiles> mapFiles() const {
        slicing::MappedFiles mapped;
        if (!allocate_) return mapped;
        std::vector<std::shared_ptr<const fields::FileHandle>> all = made_;
        if (load_.file) all.insert(all.begin(), load_.file);
        for (const auto& each : all) {
            auto file = fields::MappedFile::map(each);
            if (!file) return file.error();
            mapped.push_back(std::move(*file));
        }
        return mapped;
    }

    // The body of the last message that run() received from the process. If run() has returned
    // TransferResult::complete and `refused` is empty, this was the message MessageType::outcome.
    std::string outcome;
    std::optional<Error> refused;  // why a new file or a file of the folder could not be given to the process; empty if
                                   // no request failed

  private:
    static int descriptorOf(const std::shared_ptr<const fields::FileHandle>& file) {
        return file ? file->descriptor() : Channel::kNoFile;
    }

    TransferResult sendFoundFile(const Channel& channel, const WaitLimit& limit) {
        const auto [path, part] = decodeFindRequest(outcome);
        const auto found = load_.folder->findFile(path, part, limit.until, limit.stop);
        if (!found) {
            if (limit.stop.stop_requested()) return TransferResult::timed_out;
            refused = found.error();
            return TransferResult::complete;
        }
        if (*found && !(*found)->file)
            return channel.send(MessageType::file_bytes, (*found)->bytes, Channel::kNoFile, limit);
        const int descriptor = *found ? (*found)->file->descriptor() : Channel::kNoFile;
        return channel.send(MessageType::file_descriptor, {}, descriptor, limit);
    }

    int createRequestedFile(WaitLimit& limit) {
        // The new files that one request needs at most: for each of two arrays, a decompressed and a converted file.
        constexpr std::size_t kMaxFiles = 4;
        std::size_t bytes = 0;
        if (!allocate_ || outcome.size() != sizeof bytes || made_.size() == kMaxFiles)
            throw std::runtime_error("a reader process asked for a file that it does not need");
        std::memcpy(&bytes, outcome.data(), sizeof bytes);
        auto file = allocate_(bytes);
        if (!file) {
            refused = file.error();
            return Channel::kNoFile;
        }
        limit.until += std::chrono::seconds(bytes / FileReaderPool::kBytesPerSecond);
        made_.push_back(*file);
        return (*file)->descriptor();
    }

    const session::LoadObject& load_;
    const FileAllocator& allocate_;
    std::vector<std::shared_ptr<const fields::FileHandle>> made_;
};

}  // namespace

Result<session::ObjectWithWarnings> FileReaderPool::read(const session::LoadObject& load, const session::Limits& limits,
                                                         const std::stop_token& stop, const FileAllocator& allocate) {
    std::string file;
    encodeReadRequest(load, limits, static_cast<bool>(allocate), file);
    const std::size_t maxBytes = maxOutcomeBytes(load, limits);
    std::optional<FileReadConversation> conversation;
    {
        struct Lease {
            FileReaderPool& readers;
            ChildProcessPtr process;
            ~Lease() { readers.retireProcess(std::move(process)); }
        } const lease{*this, acquireProcess()};
        try {
            lease.process->converseWithRetry(
                [&](const Channel& channel, const WaitLimit& limit) {
                    return conversation.emplace(load, allocate).run(channel, file, maxBytes, limit);
                },
                stop);
        } catch (const process::ProcessLostError& lost) {
            if (!lost.hasHung()) throw;
            return Error{ErrorCode::too_large, "reading this file takes longer than " +
                                                   text::shortestDecimal(options_.timeout.count()) +
                                                   " s, the time allowed"};
        }
    }
    if (conversation->refused) return *conversation->refused;
    const auto mapped = conversation->mapFiles();
    if (!mapped) return mapped.error();
    return decodeOutcome(conversation->outcome, load.name, limits, *mapped);
}

}  // namespace oval4d::file_reading
