#include "net/jobs/export_job.hpp"

#include <chrono>
#include <utility>

#include "net/jobs/spool.hpp"

namespace oval4d::net {

namespace {

/// Counts an exported file in Metrics::filesUnderWay while this object exists. If markSucceeded() was called, the
/// destructor records how long this object existed as the time to make the file.
class ScopedExportMetrics {
  public:
    explicit ScopedExportMetrics(Metrics& metrics) : metrics_(metrics) { metrics_.filesUnderWay.Increment(); }
    ~ScopedExportMetrics() {
        metrics_.filesUnderWay.Decrement();
        if (succeeded_) metrics_.fileTime.Observe(Seconds(std::chrono::steady_clock::now() - start_).count());
    }
    void markSucceeded() { succeeded_ = true; }
    ScopedExportMetrics(const ScopedExportMetrics&) = delete;
    ScopedExportMetrics& operator=(const ScopedExportMetrics&) = delete;

  private:
    Metrics& metrics_;
    bool succeeded_ = false;
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

std::function<ExportResult(std::size_t worker)> exportJob(Services services, const scene::PictureRequest& picture,
                                                          const exports::ExportRequest& request,
                                                          const ClientAccountPtr& client) {
    return [services, picture, request, client](std::size_t /*worker*/) -> ExportResult {
        ScopedExportMetrics fileMetrics(services.metrics);
        auto held = client->byteAccount().forceReserve(0);
        exports::ExportLimits limits = services.options.file;
        limits.slices = services.options.session.maxSlices;
        limits.sliceEdges = services.options.picture.sliceEdges;
        limits.occlusionSteps = services.options.picture.occlusionSteps;
        limits.grantTotalBytes = [&held](std::size_t bytes) { return bytes <= held.size() || held.growTo(bytes); };
        auto made = pipeline::exportFile(picture, request, limits, services.exportWorkers.stopToken());
        if (!made) {
            const bool overBudget = made.error().code == ErrorCode::too_many;
            return Result<FinishedExport>(overBudget ? kTooManyBytes : made.error());
        }
        fileMetrics.markSucceeded();
        held.forceResize(made->bytes.size());
        SharedBytes bytes = spool(std::move(made->bytes), services.options.spool)
                                .keepingAlive(std::make_shared<ByteBudget::Reservation>(std::move(held)));
        return Result<FinishedExport>(FinishedExport{std::move(bytes), std::move(made->warnings)});
    };
}

}  // namespace oval4d::net
