#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <vector>

#include "parallel/worker_pool.hpp"
#include "pipeline/pipeline.hpp"
#include "process/process_heap.hpp"

namespace oval4d::pipeline {

/// A pool of worker threads, each with its own Pipeline, which makes messages and pictures. A job receives the pipeline
/// of the worker that runs the job. Thread-safe.
class PipelinePool {
  public:
    using JobArgument = Pipeline&;  ///< the type of the parameter of a job
    using Job = std::function<void(Pipeline&)>;

    struct PoolOptions {
        std::size_t threads = 1;                   ///< the number of worker threads
        parallel::WorkerPool::Limits limits = {};  ///< the maximum numbers of waiting jobs
        PictureWorkLimits pictures = {};
        /// Called once by each worker, to make the rasterizer of its pipeline. `stop` is the token through which
        /// WorkerPool::stop() requests a stop.
        std::function<std::unique_ptr<raster::Rasterizer>(std::stop_token stop)> makeRasterizer;
        Job onThreadStart = [](Pipeline&) {};  ///< each worker runs this job once, before any other job
    };

    /// Starts the workers. Their pipelines use `forkJoin`. Idle workers free the memory of their pipelines, and return
    /// it to the operating system through `heap`. `forkJoin` and `heap` must outlive the pool.
    PipelinePool(PoolOptions options, parallel::ForkJoin& forkJoin, process::ProcessHeap& heap);

    /// Queues a job. Returns false, and drops the job, if a limit on waiting jobs is reached. See WorkerPool::post().
    [[nodiscard]] bool post(Job job, parallel::WorkerPool::JobQueuePtr jobQueue, parallel::WorkerPool::Seconds cost);

    const parallel::WorkerPool& workers() const { return workers_; }
    parallel::WorkerPool& workers() { return workers_; }

  private:
    std::vector<std::unique_ptr<Pipeline>> pipelines_;  // one pipeline for each worker
    parallel::WorkerPool workers_;                      // declared last, because its threads use the other members
};

}  // namespace oval4d::pipeline
