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
using process::MessageType;
using process::TransferResult;
using process::WaitLimit;

namespace {

/// A cache of the most recently drawn objects, the latest first. The cache keeps two forms of each object: as the
/// object was loaded (`source`), and in the frame of reference in which the object was drawn last (`inFrame`).
class RecentObjectCache {
  public:
    /// Returns the object of a request, in the frame of reference of the request. Returns null if the source object of
    /// the request is not in the cache.
    const slicing::Object* find(const DrawRequest& request) {
        const auto found = std::ranges::find(
            kept_, request.source, [](const KeptObject& kept) { return slicing::infoOf(kept.source).serial; });
        if (found == kept_.end()) return nullptr;
        kept_.splice(kept_.begin(), kept_, found);
        if (slicing::infoOf(found->inFrame).serial != request.object) {
            found->inFrame = slicing::transformedTo(found->source, request.picture.referenceFrame, request.object);
            const std::size_t bytes = found->inFrame == found->source ? 0 : slicing::memoryOf(found->inFrame);
            bytes_ += bytes - std::exchange(found->inFrameBytes, bytes);
            evictToFit(request.limits.objectBytes);
        }
        return &found->inFrame;
    }
    /// Adds an object, in the form in which it was loaded, as the latest object. `bytes` is the memory that the object
    /// takes, in bytes.
    void add(const slicing::Object& source, std::size_t bytes) {
        kept_.push_front({source, source, bytes});
        bytes_ += bytes;
    }
    /// Removes the least recently drawn objects until the cache takes at most `bytes` bytes of memory. Never removes
    /// the latest object.
    void evictToFit(std::size_t bytes) {
        for (; bytes_ > bytes && kept_.size() > 1; kept_.pop_back())
            bytes_ -= kept_.back().bytes + kept_.back().inFrameBytes;
    }

  private:
    struct KeptObject {
        slicing::Object source, inFrame;
        std::size_t bytes, inFrameBytes = 0;
    };
    std::list<KeptObject> kept_;
    std::size_t bytes_ = 0;
};

class RasterizerService {
  public:
    RasterizerService(int socket, parallel::ForkJoin& forkJoin, process::ProcessHeap& heap)
        : channel_(socket), rasterizer_(&forkJoin), heap_(heap) {}

    void run(const process::Confinement& confinement) {
        const bool ready = tryOrReportFailure([&] {
            rasterizer_.warmUp();  // called before confine(), because warmUp() reads the font and other files
            process::confine(process::SandboxRole::draw, confinement);
        });
        if (!ready) return;
        channel_.send(MessageType::ready);
        for (MessageType type{}; receiveNext(type);) {
            if (type == MessageType::draw) decodeDrawRequest(body_, request_);
            // The object that refers to this file follows in a later message.
            if (type == MessageType::file_descriptor) continue;
            if (type == MessageType::object && !tryOrReportFailure([this] { cacheReceivedObject(); })) continue;
            if (const slicing::Object* object = recent_.find(request_)) {
                request_.picture.object = *object;
                tryOrReportFailure([this] { draw(); });
            } else {
                channel_.send(MessageType::object_missing);
            }
        }
    }

  private:
    /// Waits for the next message and receives it. If no message comes for WorkerPool::kIdleDelay, frees memory and
    /// goes on waiting. Returns false when the connection is closed.
    bool receiveNext(MessageType& type) {
        if (!channel_.waitForMessage({WaitLimit::Clock::now() + parallel::WorkerPool::kIdleDelay, {}})) {
            rasterizer_.freeMemory();
            heap_.returnFreeMemory();
        }
        int file = Channel::kNoFile;
        if (channel_.receive(type, body_, &file) != TransferResult::complete) return false;
        if (type == MessageType::file_descriptor) mapReceivedFile(file);
        if (type != MessageType::draw) return true;
        // The descriptor is missing if the kernel has dropped it because this process has too many files open.
        if (file == Channel::kNoFile)
            throw std::runtime_error("a draw request arrived without the memory to draw into");
        auto pixels = std::make_unique<SharedPixels>(file);
        currentFile_ = pixels->inode();
        pixelFiles_.try_emplace(currentFile_, std::move(pixels));
        return true;
    }

    void mapReceivedFile(int descriptor) {
        // `file` closes the descriptor at the end of this function, because a mapping does not need its descriptor.
        const fields::FileHandle file(descriptor);
        auto mapped = fields::MappedFile::map(file.descriptor());
        mapped_.push_back(mapped ? std::move(*mapped) : nullptr);  // if mapping the file fails, the entry is null
    }

    void cacheReceivedObject() {
        const std::string bytes = std::exchange(body_, {});
        const slicing::Object object = slicing::decodeObject(bytes, std::exchange(mapped_, {}));
        recent_.add(object, std::max(bytes.size(), slicing::memoryOf(object)));
        recent_.evictToFit(request_.limits.objectBytes);
    }

    void draw() {
        rasterizer_.limitFaceFilling(request_.limits.fillSteps);
        rasterizer_.limitOcclusion(request_.limits.occlusionSteps);
        DrawTimes times;
        const std::size_t size = image::byteCount(request_.picture.viewport.width, request_.picture.viewport.height);
        rasterizer_.draw(request_.picture, pixelFiles_.at(currentFile_)->remapIfResized(size), times);
        channel_.send(MessageType::drawn, {reinterpret_cast<const char*>(&times), sizeof times});
    }

    template <typename Act>
    bool tryOrReportFailure(Act act) {
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
    process::ProcessHeap& heap_;
    RecentObjectCache recent_;
    DrawRequest request_;
    // The shared memory of each worker of the server. The key is the inode of the memory file.
    std::map<std::uint64_t, std::unique_ptr<SharedPixels>> pixelFiles_;
    std::uint64_t currentFile_ = 0;  // the inode of the file into which the next picture is drawn
    slicing::MappedFiles mapped_;    // the files to which the next object refers
    std::string body_;
};

}  // namespace

void serveRasterizer(int socket, const process::Confinement& confinement, parallel::ForkJoin& forkJoin,
                     process::ProcessHeap& heap) {
    process::initializeChild();
    RasterizerService(socket, forkJoin, heap).run(confinement);
}

}  // namespace oval4d::raster
