#include "net/file_job.hpp"

#include <chrono>
#include <utility>

namespace oval4d::net {

namespace {

class Watched {
  public:
    explicit Watched(Metrics& metrics) : metrics_(metrics) { metrics_.filesUnderWay.Increment(); }
    ~Watched() {
        metrics_.filesUnderWay.Decrement();
        metrics_.fileTime.Observe(Seconds(std::chrono::steady_clock::now() - start_).count());
    }
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;

  private:
    Metrics& metrics_;
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

std::function<MadeFile(picture::Painter&)> fileJob(Services services, const session::State& state,
                                                   const exports::Wish& wish) {
    return [services, state, wish](picture::Painter& /*unused*/) -> MadeFile {
        const Watched watched(services.metrics);
        auto made = picture::fileOf(state, wish, services.options.file, services.files.stopToken());
        if (!made) return protocol::Result<Bytes>(made.error());
        return protocol::Result<Bytes>(Bytes(std::move(*made)));
    };
}

}  // namespace oval4d::net
