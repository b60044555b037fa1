#pragma once
// The Prometheus metrics of the server, which the path /metrics serves.

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <string>

#include "errors/error.hpp"
#include "pipeline/pipeline.hpp"
#include "wire/request.hpp"

namespace oval4d::net {

/// The metrics of the server. Every member may be used from any thread.
class Metrics {
    prometheus::Registry registry_;  // declared first, because it owns the metrics below

  public:
    Metrics();

    prometheus::Gauge& connections;           ///< open sockets, HTTP and WebSocket
    prometheus::Gauge& webSockets;            ///< open WebSocket connections
    prometheus::Gauge& sessions;              ///< sessions in the store or in memory
    prometheus::Gauge& openSessions;          ///< sessions with at least one client
    prometheus::Gauge& jobsWaiting;           ///< jobs that wait for a picture worker
    prometheus::Counter& rasterizerDeaths;    ///< rasterizer processes that died
    prometheus::Counter& rasterizerHangs;     ///< rasterizer processes that hung and were killed
    prometheus::Counter& fileReaderDeaths;    ///< file reader processes that died
    prometheus::Counter& fileReaderHangs;     ///< file reader processes that hung and were killed
    prometheus::Gauge& filesUnderWay;         ///< exported files being made
    prometheus::Histogram& fileTime;          ///< seconds to make an exported file
    prometheus::Gauge& memory;                ///< resident bytes of this process
    prometheus::Gauge& polytopes;             ///< bytes of cached polytopes
    prometheus::Gauge& dataFields;            ///< bytes in memory of fields from the data folder
    prometheus::Gauge& fieldFiles;            ///< bytes on the disk of fields from the data folder
    prometheus::Gauge& critical;              ///< bytes of cached critical values of w
    prometheus::Gauge& bytesHeld;             ///< bytes held for clients (ByteBudget)
    prometheus::Gauge& clients;               ///< known clients (ClientAccounts::size())
    prometheus::Counter& messagesReceived;    ///< messages received over WebSockets
    prometheus::Counter& bytesSent;           ///< bytes of messages sent over WebSockets
    prometheus::Counter& droppedSlowClients;  ///< clients dropped because they read, or send a body, too slowly
    prometheus::Counter& sessionsTaken;       ///< sessions taken over by other servers
    prometheus::Gauge& storeUp;               ///< 1 if the store is available, else 0
    prometheus::Gauge& unsaved;               ///< sessions with changes not yet written to the store
    prometheus::Gauge& workers;               ///< picture workers: threads that slice and draw
    prometheus::Counter& workerSeconds;       ///< busy seconds, summed over all picture workers
    prometheus::Histogram& latency;  ///< seconds from a session change until its picture is written to the socket

    /// Counts an error that was sent to a client.
    void countError(ErrorCode code);
    /// Counts an HTTP request that was answered with this status.
    void countRequest(unsigned httpStatus);
    /// Counts a picture that was sent to a client over this stream.
    void countPicture(wire::StreamKind stream);
    /// Records how long each step of making a picture took. Ignores steps that took no time.
    void observe(const pipeline::PictureTimes& times);
    /// Records the duration of a store operation in seconds. Counts the operation as failed if `succeeded` is false.
    void observeStore(const std::string& operation, double seconds, bool succeeded);

    /// Returns all metrics in the Prometheus text exposition format.
    std::string expositionText() const;

  private:
    prometheus::Family<prometheus::Counter>&errors_, &requests_, &pictures_, &storeFailures_;
    prometheus::Family<prometheus::Histogram>&steps_, &store_;
    prometheus::Histogram &slice_, &compose_, &write_, &draw_, &encode_;
};

}  // namespace oval4d::net
