#include "net/metrics.hpp"

#include <prometheus/text_serializer.h>

#include <sstream>

namespace oval4d::net {

namespace {

using prometheus::Histogram;

// From 100 µs to 3 s, each bucket about twice the one before.
const Histogram::BucketBoundaries kBuckets{1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.3, 1, 3};

// From 1 ms to a minute.
const Histogram::BucketBoundaries kFileBuckets{1e-3, 1e-2, 0.1, 0.3, 1, 3, 10, 20, 60};

prometheus::Gauge& gauge(prometheus::Registry& registry, const char* name, const char* help) {
    return prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add({});
}

prometheus::Family<prometheus::Counter>& counters(prometheus::Registry& registry, const char* name, const char* help) {
    return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

prometheus::Family<Histogram>& histograms(prometheus::Registry& registry, const char* name, const char* help) {
    return prometheus::BuildHistogram().Name(name).Help(help).Register(registry);
}

prometheus::Counter& drawingLosses(prometheus::Registry& registry, const char* cause) {
    return counters(registry, "oval4d_drawing_losses_total", "Processes that drew, were lost, and replaced")
        .Add({{"cause", cause}});
}

}  // namespace

Metrics::Metrics()
    : connections(gauge(registry_, "oval4d_connections", "Sockets open")),
      webSockets(gauge(registry_, "oval4d_websockets", "WebSocket connections open")),
      sessions(gauge(registry_, "oval4d_sessions", "Sessions kept, with or without a client")),
      openSessions(gauge(registry_, "oval4d_open_sessions", "Sessions with a client")),
      jobsWaiting(gauge(registry_, "oval4d_jobs_waiting", "Jobs waiting for a worker")),
      drawingDeaths(drawingLosses(registry_, "died")),
      drawingHangs(drawingLosses(registry_, "hung")),
      filesUnderWay(gauge(registry_, "oval4d_files_under_way", "Files being made")),
      fileTime(histograms(registry_, "oval4d_file_seconds", "Time to make a file").Add({}, kFileBuckets)),
      memory(gauge(registry_, "process_resident_memory_bytes", "Memory of this process that is resident")),
      polytopes(gauge(registry_, "oval4d_polytope_cache_bytes",
                      "Memory of polytopes kept for when they are asked for again")),
      messagesReceived(
          counters(registry_, "oval4d_messages_received_total", "Messages received over WebSockets").Add({})),
      bytesSent(counters(registry_, "oval4d_bytes_sent_total", "Bytes of messages sent over WebSockets").Add({})),
      slowReaders(
          counters(registry_, "oval4d_slow_readers_total", "Clients dropped because they did not read").Add({})),
      sessionsTaken(
          counters(registry_, "oval4d_sessions_taken_total", "Sessions with which another server went on").Add({})),
      storeUp(gauge(registry_, "oval4d_store_up", "1 if the store of sessions answers, 0 if it fails")),
      unsaved(gauge(registry_, "oval4d_unsaved_sessions", "Sessions whose last change is not yet in the store")),
      workers(gauge(registry_, "oval4d_workers", "Threads that slice and draw")),
      workerSeconds(
          counters(registry_, "oval4d_worker_seconds_total", "Time that these threads worked, all together").Add({})),
      latency(histograms(registry_, "oval4d_change_to_picture_seconds",
                         "Time from a session's change to its picture written to a client's socket")
                  .Add({}, kBuckets)),
      errors_(counters(registry_, "oval4d_errors_total", "Errors told to clients, by code")),
      requests_(counters(registry_, "oval4d_http_requests_total", "HTTP requests answered, by status")),
      pictures_(counters(registry_, "oval4d_pictures_total", "Pictures sent to clients, by stream")),
      storeFailures_(counters(registry_, "oval4d_store_failures_total", "Questions that the store failed to answer")),
      steps_(histograms(registry_, "oval4d_picture_step_seconds", "Time spent on a picture, by step")),
      store_(histograms(registry_, "oval4d_store_seconds", "Time for the store's answers, by what it was asked")),
      slice_(steps_.Add({{"step", "slice"}}, kBuckets)),
      compose_(steps_.Add({{"step", "compose"}}, kBuckets)),
      write_(steps_.Add({{"step", "write"}}, kBuckets)),
      draw_(steps_.Add({{"step", "draw"}}, kBuckets)),
      encode_(steps_.Add({{"step", "encode"}}, kBuckets)) {}

void Metrics::countError(protocol::ErrorCode code) {
    errors_.Add({{"code", std::string(protocol::wireName(code))}}).Increment();
}

void Metrics::countRequest(unsigned httpStatus) { requests_.Add({{"status", std::to_string(httpStatus)}}).Increment(); }

void Metrics::countPicture(protocol::Stream stream) {
    pictures_.Add({{"stream", stream == protocol::Stream::frames ? "frames" : "geometry"}}).Increment();
}

void Metrics::observe(const picture::Times& times) {
    const auto put = [](Histogram& histogram, double seconds) {
        if (seconds > 0) histogram.Observe(seconds);
    };
    put(slice_, times.slice);
    put(compose_, times.compose);
    put(write_, times.write);
    put(draw_, times.draw);
    put(encode_, times.encode);
}

void Metrics::observeStore(const std::string& operation, double seconds, bool worked) {
    store_.Add({{"operation", operation}}, kBuckets).Observe(seconds);
    if (!worked) storeFailures_.Add({{"operation", operation}}).Increment();
}

std::string Metrics::text() const {
    std::ostringstream out;
    prometheus::TextSerializer().Serialize(out, registry_.Collect());
    return out.str();
}

}  // namespace oval4d::net
