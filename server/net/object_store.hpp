#pragma once
// Reads objects over HTTP: from an S3-compatible store with a public bucket, or from any HTTP server.

#include <chrono>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "errors/error.hpp"
#include "fields/readers/file_contents.hpp"

namespace oval4d::net {

/// The limits on requests to an object store.
struct ObjectStoreLimits {
    std::chrono::duration<double> connectTimeout{5};  ///< maximum time to connect, including the TLS handshake
    std::chrono::duration<double> timeout{15};        ///< maximum time of a request, including the connection
    std::size_t objectBytes = 128U << 20U;            ///< maximum size of an object, or of a part of one, in bytes
};

/// Reads objects whose addresses begin with one base address, which the server's operator chooses. Does not follow
/// redirects, so that no request goes to another address. Keeps as many connections open as there have been requests at
/// the same time. Thread-safe.
class ObjectStore {
  public:
    using Clock = std::chrono::steady_clock;

    /// `address` begins with http:// or https://. Throws std::invalid_argument if the address is not valid, or contains
    /// a user name, a query or a fragment.
    ObjectStore(const std::string& address, const ObjectStoreLimits& limits);
    ~ObjectStore();
    ObjectStore(const ObjectStore&) = delete;
    ObjectStore& operator=(const ObjectStore&) = delete;

    /// Returns whether a value of the option --data is the address of a store rather than the path of a folder.
    static bool isUrl(const std::string& text);

    /// Reads a part of an object; fewer bytes if the object ends before the part does. `path` is relative to the base
    /// address. It consists of names separated by slashes, without percent encoding. Returns an empty optional if there
    /// is no such object (404 or 410), or if a name in `path` is empty, "." or "..". Blocks the calling thread at most
    /// until `until` and for the maximum time of a request. Returns within about a second if a stop is requested.
    ///
    /// Errors: `too_large` if the part exceeds the allowed size; `internal` if the store cannot be reached, does not
    /// answer in time, redirects, answers with an error, sends a whole object instead of a part, or sends another
    /// number of bytes than it states. The log has each error with the address.
    Result<std::optional<std::string>> get(const std::string& path, const fields::FilePart& part,
                                           Clock::time_point until = Clock::time_point::max(),
                                           const std::stop_token& stop = {}) const;

  private:
    struct CurlHandleCloser {
        void operator()(void* handle) const;
    };
    using CurlHandle =
        std::unique_ptr<void, CurlHandleCloser>;  // a libcurl handle (CURL*), which keeps its connection open

    CurlHandle takeHandle() const;

    std::string address_;  // ends with a slash
    const ObjectStoreLimits limits_;
    mutable std::mutex mutex_;
    mutable std::vector<CurlHandle> idle_;  // the handles that no request uses; guarded by mutex_
};

}  // namespace oval4d::net
