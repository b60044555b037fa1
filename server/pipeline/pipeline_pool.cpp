#include "pipeline/pipeline_pool.hpp"

#include <utility>

namespace oval4d::pipeline {

PipelinePool::PipelinePool(Terms terms, parallel::ForkJoin& forkJoin, process::Heap& heap)
    : pipelines_(terms.threads),
      workers_({.threads = terms.threads,
                .limits = terms.limits,
                .first =
                    [this, terms, &forkJoin](std::size_t worker) {
                        pipelines_[worker] = std::make_unique<Pipeline>(terms.makeRasterizer(workers_.stopToken()),
                                                                        &forkJoin, terms.fillSteps);
                        terms.first(*pipelines_[worker]);
                    },
                .whenIdle =
                    [this, &heap](std::size_t worker) {
                        pipelines_[worker]->freeMemory();
                        heap.returnFreeMemory();
                    },
                .forkJoin = &forkJoin}) {}

bool PipelinePool::post(Job job, parallel::WorkerPool::LanePtr lane, parallel::WorkerPool::Seconds cost) {
    return workers_.post([this, job = std::move(job)](std::size_t worker) { job(*pipelines_[worker]); },
                         std::move(lane), cost);
}

}  // namespace oval4d::pipeline
