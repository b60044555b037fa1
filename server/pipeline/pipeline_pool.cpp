#include "pipeline/pipeline_pool.hpp"

#include <utility>

namespace oval4d::pipeline {

PipelinePool::PipelinePool(PoolOptions options, parallel::ForkJoin& forkJoin, process::ProcessHeap& heap)
    : pipelines_(options.threads),
      workers_({.threads = options.threads,
                .limits = options.limits,
                .onThreadStart =
                    [this, options, &forkJoin](std::size_t worker) {
                        pipelines_[worker] = std::make_unique<Pipeline>(options.makeRasterizer(workers_.stopToken()),
                                                                        &forkJoin, options.pictures);
                        options.onThreadStart(*pipelines_[worker]);
                    },
                .whenIdle =
                    [this, &heap](std::size_t worker) {
                        pipelines_[worker]->freeMemory();
                        heap.returnFreeMemory();
                    },
                .forkJoin = &forkJoin}) {}

bool PipelinePool::post(Job job, parallel::WorkerPool::JobQueuePtr jobQueue, parallel::WorkerPool::Seconds cost) {
    return workers_.post([this, job = std::move(job)](std::size_t worker) { job(*pipelines_[worker]); },
                         std::move(jobQueue), cost);
}

}  // namespace oval4d::pipeline
