#include "raster/rasterizer_service.hpp"

#include <algorithm>
#include <list>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "parallel/worker_pool.hpp"
#include "process/channel.hpp"
#include "process/child_process.hpp"
#include "raster/rasterizer.hpp"
#include "raster/rasterizer_messages.hpp"
#include "raster/shared_pixels.hpp"
#include "slicing/object_bytes.hpp"

namespace oval4d::raster {

using process::Channel;
using process::Deadline;
using process::MessageType;
using process::TransferResult;

namespace {

/// A cache of the most recently drawn objects, the latest first.
class RecentObjects {
  public:
    const slicing::Object* find(std::uint64_t serial) {
        const auto found =
            std::ranges::find(kept_, serial, [](const Kept& kept) { return slicing::infoOf(kept.object).serial; });
        if (found == kept_.end()) return nullptr;
        kept_.splice(kept_.begin(), kept_, found);
        return &found->object;
    }
    void add(slicing::Object object, std::size_t bytes) {
        kept_.push_front({std::move(object), bytes});
        bytes_ += bytes;
    }
    void shrink(std::size_t bytes) {
        for (; bytes_ > bytes && kept_.size() > 1; kept_.pop_back()) bytes_ -= kept_.back().bytes;
    }

  private:
    struct Kept {
        slicing::Object object;
        std::size_t bytes;
    };
    std::list<Kept> kept_;
    std::size_t bytes_ = 0;
};

class Service {
  public:
    Service(int socket, parallel::ForkJoin& forkJoin, process::Heap& heap)
        : channel_(socket), rasterizer_(&forkJoin), heap_(heap) {}

    void run(const process::Confinement& confinement) {
        const bool ready = attempt([&] {
            rasterizer_.warmUp();  // before the sandbox, because it reads the font and other files
            process::confine(process::Role::draw, confinement);
        });
        if (!ready) return;
        channel_.send(MessageType::ready);
        for (MessageType type{}; next(type);) {
            if (type == MessageType::draw) decodeRequest(body_, request_);
            if (type == MessageType::object) takeObject();
            if (const slicing::Object* object = recent_.find(request_.object)) {
                request_.state.object = *object;
                attempt([this] { draw(); });
            } else {
                channel_.send(MessageType::object_missing);
            }
        }
    }

  private:
    /// Receives the next message, and frees memory if none comes for a while. Returns false when the connection is
    /// closed.
    bool next(MessageType& type) {
        if (!channel_.wait({Deadline::Clock::now() + parallel::WorkerPool::kIdleDelay, {}})) {
            rasterizer_.freeMemory();
            heap_.returnFreeMemory();
        }
        int file = Channel::kNoFile;
        if (channel_.receive(type, body_, &file) != TransferResult::complete) return false;
        if (type != MessageType::draw) return true;
        // The kernel drops a file descriptor if the process has too many open.
        if (file == Channel::kNoFile)
            throw std::runtime_error("a draw request arrived without the memory to draw into");
        auto pixels = std::make_unique<SharedPixels>(file);
        currentFile_ = pixels->inode();
        pixelFiles_.try_emplace(currentFile_, std::move(pixels));
        return true;
    }

    void takeObject() {
        const std::string bytes = std::exchange(body_, {});
        recent_.add(slicing::decodeObject(bytes), bytes.size());
        recent_.shrink(request_.limits.objectBytes);
    }

    void draw() {
        rasterizer_.limitFill(request_.limits.fillSteps);
        DrawTimes times;
        rasterizer_.draw(request_.state, request_.viewport,
                         pixelFiles_.at(currentFile_)->remap(image::byteCount(request_.viewport)), times);
        channel_.send(MessageType::drawn, {reinterpret_cast<const char*>(&times), sizeof times});
    }

    template <typename Act>
    bool attempt(Act act) {
        try {
            act();
            return true;
        } catch (const std::exception& fault) {
            channel_.send(MessageType::failed, fault.what());
            return false;
        }
    }

    Channel channel_;
    LocalRasterizer rasterizer_;
    process::Heap& heap_;
    RecentObjects recent_;
    DrawRequest request_;
    std::map<std::uint64_t, std::unique_ptr<SharedPixels>> pixelFiles_;  // by inode; one for each worker of the server
    std::uint64_t currentFile_ = 0;                                      // the inode of the file to draw into
    std::string body_;
};

}  // namespace

void serveRasterizer(int socket, const process::Confinement& confinement, parallel::ForkJoin& forkJoin,
                     process::Heap& heap) {
    process::initializeChild();
    Service(socket, forkJoin, heap).run(confinement);
}

}  // namespace oval4d::raster
