#include "file_reading/file_reader_pool.hpp"

#include <spdlog/spdlog.h>

#include <stdexcept>
#include <utility>

#include "file_reading/file_reader_messages.hpp"
#include "file_reading/file_reader_service.hpp"
#include "text/message_text.hpp"

namespace oval4d::file_reading {

using process::Channel;
using process::ChildProcess;
using process::Deadline;
using process::MessageType;
using process::TransferResult;

namespace {

// Drawing has priority: a reader that shares a core with a process that draws gets a quarter of the CPU time.
constexpr int kNiceness = 5;

}  // namespace

FileReaderPool::FileReaderPool(FileReaderOptions options)
    : options_(std::move(options)), replacing_([this](const std::stop_token& stop) { replaceUsed(stop); }) {}

FileReaderPool::~FileReaderPool() {
    replacing_.request_stop();
    replacing_.join();
    for (const Process& process : waiting_) process->kill();  // it reads no file, so there is nothing to finish
}

FileReaderPool::Process FileReaderPool::acquire() {
    {
        const std::lock_guard lock(mutex_);
        if (!waiting_.empty()) {
            Process process = std::move(waiting_.back());
            waiting_.pop_back();
            return process;
        }
    }
    return std::make_unique<ChildProcess>(process::ChildOptions{kFileReaderCommand, options_.environment,
                                                                options_.timeout, false, options_.onLoss, kNiceness});
}

void FileReaderPool::retire(Process used) {
    const std::lock_guard lock(mutex_);
    used_.push_back(std::move(used));
    lastUsed_ = Clock::now();
    wake_.notify_all();
}

/// Kills processes that have read a file, starts new ones in their place, and kills those that have waited for a file
/// for too long. Runs on its own thread, so that no client waits for the replacement.
void FileReaderPool::replaceUsed(const std::stop_token& stop) {
    const auto idle = std::chrono::duration_cast<Clock::duration>(options_.idle);
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        const auto isUsed = [this] { return !used_.empty(); };
        if (waiting_.empty()) {
            wake_.wait(lock, stop, isUsed);
        } else {
            wake_.wait_until(lock, stop, lastUsed_ + idle, isUsed);
        }
        std::vector<Process> used = std::exchange(used_, {});
        std::vector<Process> surplus;
        if (used.empty() && Clock::now() >= lastUsed_ + idle) surplus = std::exchange(waiting_, {});
        // acquire() may have created further processes while none was waiting, so there may now be more than needed.
        while (!used.empty() && waiting_.size() + used.size() > options_.waiting) {
            surplus.push_back(std::move(used.back()));
            used.pop_back();
        }
        lock.unlock();
        for (const Process& process : used) {
            process->kill();
            try {
                if (!stop.stop_requested()) process->start();
            } catch (const std::runtime_error& fault) {
                spdlog::warn("cannot start a process in advance to read files fault=\"{}\"", fault.what());
            }
        }
        for (const Process& process : surplus) process->kill();
        lock.lock();
        for (Process& process : used) waiting_.push_back(std::move(process));
    }
}

Result<session::LoadedObject> FileReaderPool::read(std::string_view format, std::string_view text,
                                                   const std::string& name, const session::Limits& limits,
                                                   const std::stop_token& stop) {
    std::string file, outcome;
    encodeFile(format, text, name, limits, file);
    const std::size_t maxBytes = maxOutcomeBytes(text.size(), limits);
    struct Lease {
        FileReaderPool& readers;
        Process process;
        ~Lease() { readers.retire(std::move(process)); }
    } const lease{*this, acquire()};
    try {
        lease.process->converse(
            [&](const Channel& channel, const Deadline& deadline) {
                const TransferResult sent = channel.send(MessageType::file, file, Channel::kNoFile, deadline);
                if (sent != TransferResult::complete) return sent;
                MessageType answer{};
                const TransferResult received = channel.receive(answer, outcome, nullptr, deadline, maxBytes);
                if (received == TransferResult::complete && answer != MessageType::outcome)
                    throw std::runtime_error("a reader process sent an unexpected message");
                return received;
            },
            stop);
    } catch (const process::ProcessLost& lost) {
        if (!lost.hung()) throw;
        return Error{ErrorCode::too_large, "reading this file takes longer than " +
                                               text::shortestDecimal(options_.timeout.count()) +
                                               " s, the time allowed"};
    }
    file = {};
    return decodeOutcome(outcome, name, limits);
}

}  // namespace oval4d::file_reading
