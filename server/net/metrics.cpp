#include "net/metrics.hpp"

#include <prometheus/text_serializer.h>

#include <sstream>

namespace oval4d::net {

namespace {

using prometheus::Histogram;

// The upper bounds of the histogram buckets, in seconds, for all times but the time to make a file.
const Histogram::BucketBoundaries kBuckets{1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.3, 1, 3};

// The upper bounds of the histogram buckets, in seconds, for the time to make a file.
const Histogram::BucketBoundaries kFileBuckets{1e-3, 1e-2, 0.1, 0.3, 1, 3, 10, 20, 60};

prometheus::Gauge& registerGauge(prometheus::Registry& registry, const char* name, const char* help) {
    return prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add({});
}

prometheus::Family<prometheus::Counter>& registerCounters(prometheus::Registry& registry, const char* name,
                                                          const char* help) {
    return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

prometheus::Family<Histogram>& registerHistograms(prometheus::Registry& registry, const char* name, const char* help) {
    return prometheus::BuildHistogram().Name(name).Help(help).Register(registry);
}

prometheus::Counter& rasterizerLossCounter(prometheus::Registry& registry, const char* cause) {
    return registerCounters(registry, "oval4d_drawing_losses_total", "Rasterizer processes that were lost and replaced")
        .Add({{"cause", cause}});
}

prometheus::Counter& fileReaderLosses(prometheus::Registry& registry, const char* cause) {
    return registerCounters(registry, "oval4d_reading_losses_total",
                            "File reader processes that were lost and replaced")
        .Add({{"cause", cause}});
}

}  // namespace

Metrics::Metrics()
    : connections(registerGauge(registry_, "oval4d_connections", "Open sockets")),
      webSockets(registerGauge(registry_, "oval4d_websockets", "Open WebSocket connections")),
      sessions(registerGauge(registry_, "oval4d_sessions", "Sessions stored, with or without a client")),
      openSessions(registerGauge(registry_, "oval4d_open_sessions", "Sessions with a client")),
      jobsWaiting(registerGauge(registry_, "oval4d_jobs_waiting", "Jobs waiting for a worker")),
      rasterizerDeaths(rasterizerLossCounter(registry_, "died")),
      rasterizerHangs(rasterizerLossCounter(registry_, "hung")),
      fileReaderDeaths(fileReaderLosses(registry_, "died")),
      fileReaderHangs(fileReaderLosses(registry_, "hung")),
      filesUnderWay(registerGauge(registry_, "oval4d_files_under_way", "Files being made")),
      fileTime(registerHistograms(registry_, "oval4d_file_seconds", "Time to make a file").Add({}, kFileBuckets)),
      memory(registerGauge(registry_, "process_resident_memory_bytes", "Resident memory of this process")),
      polytopes(registerGauge(registry_, "oval4d_polytope_cache_bytes", "Memory used by cached polytopes")),
      dataFields(registerGauge(registry_, "oval4d_data_cache_bytes", "Memory used by fields from the data folder")),
      fieldFiles(
          registerGauge(registry_, "oval4d_field_cache_bytes", "Disk space used by fields from the data folder")),
      critical(registerGauge(registry_, "oval4d_critical_cache_bytes",
                             "Memory used by cached results of searches for critical w")),
      bytesHeld(registerGauge(registry_, "oval4d_client_bytes",
                              "Bytes held for clients: unread files and messages, and their own polytopes")),
      clients(registerGauge(registry_, "oval4d_clients", "Known client addresses")),
      messagesReceived(
          registerCounters(registry_, "oval4d_messages_received_total", "Messages received over WebSockets").Add({})),
      bytesSent(
          registerCounters(registry_, "oval4d_bytes_sent_total", "Bytes of messages sent over WebSockets").Add({})),
      droppedSlowClients(registerCounters(registry_, "oval4d_slow_readers_total",
                                          "Clients dropped because they read, or send a body, too slowly")
                             .Add({})),
      sessionsTaken(
          registerCounters(registry_, "oval4d_sessions_taken_total", "Sessions taken over by another server").Add({})),
      storeUp(registerGauge(registry_, "oval4d_store_up", "1 if the session store is available, else 0")),
      unsaved(
          registerGauge(registry_, "oval4d_unsaved_sessions", "Sessions with changes not yet written to the store")),
      workers(registerGauge(registry_, "oval4d_workers", "Threads that slice and draw")),
      workerSeconds(registerCounters(registry_, "oval4d_worker_seconds_total",
                                     "Busy time of the threads that slice and draw, summed")
                        .Add({})),
      latency(registerHistograms(registry_, "oval4d_change_to_picture_seconds",
                                 "Time from a session's change to its picture written to a client's socket")
                  .Add({}, kBuckets)),
      errors_(registerCounters(registry_, "oval4d_errors_total", "Errors sent to clients, by code")),
      requests_(registerCounters(registry_, "oval4d_http_requests_total", "HTTP requests answered, by status")),
      pictures_(registerCounters(registry_, "oval4d_pictures_total", "Pictures sent to clients, by stream")),
      storeFailures_(registerCounters(registry_, "oval4d_store_failures_total", "Store operations that failed")),
      steps_(registerHistograms(registry_, "oval4d_picture_step_seconds", "Time spent on a picture, by step")),
      store_(registerHistograms(registry_, "oval4d_store_seconds", "Time of store operations, by operation")),
      slice_(steps_.Add({{"step", "slice"}}, kBuckets)),
      compose_(steps_.Add({{"step", "compose"}}, kBuckets)),
      write_(steps_.Add({{"step", "write"}}, kBuckets)),
      draw_(steps_.Add({{"step", "draw"}}, kBuckets)),
      encode_(steps_.Add({{"step", "encode"}}, kBuckets)) {}

void Metrics::countError(ErrorCode code) { errors_.Add({{"code", std::string(protocolName(code))}}).Increment(); }

void Metrics::countRequest(unsigned httpStatus) { requests_.Add({{"status", std::to_string(httpStatus)}}).Increment(); }

void Metrics::countPicture(wire::StreamKind stream) {
    pictures_.Add({{"stream", stream == wire::StreamKind::frames ? "frames" : "geometry"}}).Increment();
}

void Metrics::observe(const pipeline::PictureTimes& times) {
    const auto put = [](Histogram& histogram, double seconds) {
        if (seconds > 0) histogram.Observe(seconds);
    };
    put(slice_, times.slice);
    put(compose_, times.compose);
    put(write_, times.write);
    put(draw_, times.draw);
    put(encode_, times.encode);
}

void Metrics::observeStore(const std::string& operation, double seconds, bool succeeded) {
    store_.Add({{"operation", operation}}, kBuckets).Observe(seconds);
    if (!succeeded) storeFailures_.Add({{"operation", operation}}).Increment();
}

std::string Metrics::expositionText() const {
    std::ostringstream out;
    prometheus::TextSerializer().Serialize(out, registry_.Collect());
    return out.str();
}

}  // namespace oval4d::net
