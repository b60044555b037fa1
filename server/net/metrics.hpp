#pragma once
// What the server counts, for /metrics.

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <string>

#include "picture/painter.hpp"
#include "protocol/cpp/error.hpp"
#include "protocol/cpp/request.hpp"

namespace oval4d::net {

/// Every member may be used from any thread.
class Metrics {
    prometheus::Registry registry_;  // first: the members below live in it

  public:
    Metrics();

    prometheus::Gauge& connections;  ///< sockets open, HTTP and WebSocket
    prometheus::Gauge& webSockets;
    prometheus::Gauge& sessions;      ///< kept in the store
    prometheus::Gauge& openSessions;  ///< those with a client
    prometheus::Gauge& jobsWaiting;
    prometheus::Counter& drawingDeaths;  ///< processes that drew, and died of it
    prometheus::Counter& drawingHangs;   ///< those that did not answer, and were killed
    prometheus::Gauge& filesUnderWay;    ///< being made
    prometheus::Histogram& fileTime;     ///< from the start of making one to its end
    prometheus::Gauge& memory;           ///< bytes of this process that are resident
    prometheus::Gauge& polytopes;        ///< bytes of polytopes kept for when they are asked for again
    prometheus::Counter& messagesReceived;
    prometheus::Counter& bytesSent;  ///< over WebSockets
    prometheus::Counter& slowReaders;
    prometheus::Counter& sessionsTaken;  ///< by other servers
    prometheus::Gauge& storeUp;          ///< 1 if the store answers, else 0
    prometheus::Gauge& unsaved;          ///< sessions whose change waits to be written
    prometheus::Gauge& workers;
    prometheus::Counter& workerSeconds;  ///< of work, of all workers together
    prometheus::Histogram& latency;      ///< from a change of a session to its picture in the socket

    void countError(protocol::ErrorCode code);
    void countRequest(unsigned httpStatus);
    void countPicture(protocol::Stream stream);
    void observe(const picture::Times& times);
    void observeStore(const std::string& operation, double seconds, bool worked);

    /// The text exposition format.
    std::string text() const;

  private:
    prometheus::Family<prometheus::Counter>&errors_, &requests_, &pictures_, &storeFailures_;
    prometheus::Family<prometheus::Histogram>&steps_, &store_;
    prometheus::Histogram &slice_, &compose_, &write_, &draw_, &encode_;
};

}  // namespace oval4d::net
