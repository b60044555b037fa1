#include "net/object_store.hpp"

#include <curl/curl.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "text/percent_encoding.hpp"

namespace oval4d::net {

namespace {

using fields::FilePart;

constexpr std::size_t kMaxKey = 1024;  // maximum length of a path in bytes, the limit of S3
// An error page of at most this many bytes is read to its end, so that the connection can be used again. A longer error
// page ends the transfer.
constexpr std::size_t kMaxErrorPage = std::size_t{64} << 10U;
constexpr long kOk = 200, kPartialContent = 206;

// The state of a request in progress, for the functions that libcurl calls.
struct CurlTransfer {
    CURL* handle;
    long wantedStatus;
    std::size_t maxBytes;
    const std::stop_token& stop;
    std::string bytes = {};
    std::size_t ignored = 0;  // number of bytes that were ignored, because the status is not wantedStatus
    bool isTooLarge = false;
};

long statusOf(CURL* handle) {
    long status = 0;
    curl_easy_getinfo(handle, CURLINFO_RESPONSE_CODE, &status);
    return status;
}

// Receives bytes of the answer (a write function of libcurl). Returns a number other than `count` to end the transfer.
std::size_t onAnswerBytes(char* from, std::size_t /*one*/, std::size_t count, void* context) {
    auto& transfer = *static_cast<CurlTransfer*>(context);
    const long status = statusOf(transfer.handle);
    if (status != transfer.wantedStatus) {
        transfer.ignored += count;
        // The status 200 instead of 206 means that the store sends the whole object instead of the requested part.
        return status == kOk || transfer.ignored > kMaxErrorPage ? 0 : count;
    }
    transfer.isTooLarge = count > transfer.maxBytes - transfer.bytes.size();
    if (transfer.isTooLarge) return 0;
    try {
        transfer.bytes.append(from, count);
    } catch (const std::bad_alloc&) {
        transfer.isTooLarge = true;
        return 0;
    }
    return count;
}

// A progress function of libcurl, called at least once a second. Returns a number other than 0 to end the transfer.
int onProgress(void* context, curl_off_t /*total*/, curl_off_t /*now*/, curl_off_t /*uploadTotal*/,
               curl_off_t /*uploadNow*/) {
    return static_cast<const CurlTransfer*>(context)->stop.stop_requested() ? 1 : 0;
}

bool isValidObjectPath(std::string_view path) {
    if (path.size() > kMaxKey) return false;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('/', begin), path.size());
        const std::string_view name = path.substr(begin, end - begin);
        if (name.empty() || name == "." || name == ".." || name.find('\0') != std::string_view::npos) return false;
        begin = end + 1;
    }
    return true;
}

// Returns the value of the request header Range, without its beginning "bytes=".
std::string rangeHeaderOf(const FilePart& part) {
    if (part.fromEnd) return '-' + std::to_string(part.size);
    const bool endsWithFile = part.size > FilePart::kAll - part.offset;
    return std::to_string(part.offset) + '-' + (endsWithFile ? "" : std::to_string(part.offset + part.size - 1));
}

// Removes a number and the character `after`, which must follow it, from the start of `text`. Returns the number, or an
// empty optional if `text` starts in another way. If `after` is '\0', no character need follow.
std::optional<std::uint64_t> takeNumberBefore(std::string_view& text, char after) {
    std::uint64_t number = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (fault != std::errc{}) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (after != '\0' && !text.starts_with(after)) return {};
    text.remove_prefix(after == '\0' ? 0 : 1);
    return number;
}

// Returns whether the answer contains the requested part, or as much of it as the object has. `header` is the answer's
// Content-Range (RFC 9110, section 14.4), and `count` the answer's number of bytes.
bool isContentRangeOf(std::string_view header, const FilePart& part, std::size_t count) {
    constexpr std::string_view kUnit = "bytes ";
    if (!header.starts_with(kUnit)) return false;
    header.remove_prefix(kUnit.size());
    const auto first = takeNumberBefore(header, '-'), last = takeNumberBefore(header, '/');
    const auto whole = takeNumberBefore(header, '\0');
    if (!first || !last || !whole || *first > *last || *last >= *whole) return false;
    const std::uint64_t wanted = part.fromEnd ? *whole - std::min(*whole, part.size) : part.offset;
    return *first == wanted && *last - *first + 1 == std::min(part.size, *whole - wanted) &&
           *last - *first + 1 == count;
}

std::string contentRangeOf(CURL* handle) {
    curl_header* header = nullptr;
    constexpr int kLastAnswer = -1;
    return curl_easy_header(handle, "Content-Range", 0, CURLH_HEADER, kLastAnswer, &header) == CURLHE_OK ? header->value
                                                                                                         : "";
}

// Returns the reason why a transfer failed before its answer was complete.
std::string transferFailureReason(CURLcode code) {
    switch (code) {
        case CURLE_COULDNT_RESOLVE_HOST:
        case CURLE_COULDNT_RESOLVE_PROXY:
            return "the name of its host cannot be resolved";
        case CURLE_COULDNT_CONNECT:
            return "its host cannot be reached";
        case CURLE_OPERATION_TIMEDOUT:
            return "it did not answer in the time allowed (--data-timeout, --data-connect-timeout, --load-timeout)";
        case CURLE_GOT_NOTHING:
        case CURLE_PARTIAL_FILE:
        case CURLE_RECV_ERROR:
            return "the connection ended before the whole answer had arrived";
        case CURLE_PEER_FAILED_VERIFICATION:
            return "its certificate is not valid";
        default:
            return curl_easy_strerror(code);
    }
}

// Returns the reason why an answer with this status is refused.
std::string transferFailureReason(long status, bool isPart) {
    const std::string number = " (status " + std::to_string(status) + ")";
    if (status == kOk && isPart)
        return "it answers a request for a part of an object with the whole object; it must support ranges";
    if (status >= 300 && status < 400)
        return "it redirects to another address" + number + ", and redirects are not followed";
    if (status == 401 || status == 403) {
        return "it refuses access" + number +
               "; objects must be public, and a store must answer 404 for missing ones, as S3 does if all may list the "
               "bucket";
    }
    if (status == 429 || status >= 500) return "it cannot answer now" + number + "; try again later";
    return "its answer is not expected" + number;
}

long curlMilliseconds(std::chrono::duration<double> time) {
    constexpr double kMost = 1e9;  // in milliseconds; fits into a `long` of 32 bits
    return static_cast<long>(std::clamp(time.count() * 1000, 1.0, kMost));
}

// Returns the address of a store with a slash at its end. Throws std::invalid_argument if the address is not valid.
std::string checkedAddress(std::string address) {
    const auto invalid = [](const std::string& why) { return std::invalid_argument("--data: " + why); };
    if (!address.starts_with("http://") && !address.starts_with("https://"))
        throw invalid("the address of an object store must begin with http:// or https://");
    const std::unique_ptr<CURLU, decltype(&curl_url_cleanup)> url(curl_url(), &curl_url_cleanup);
    if (!url) throw std::bad_alloc();
    if (curl_url_set(url.get(), CURLUPART_URL, address.c_str(), CURLU_DISALLOW_USER) != CURLUE_OK)
        throw invalid("this is not a valid address without a user name");
    for (const CURLUPart part : {CURLUPART_QUERY, CURLUPART_FRAGMENT}) {
        char* text = nullptr;
        const bool isPresent = curl_url_get(url.get(), part, &text, 0) == CURLUE_OK;
        curl_free(text);
        if (isPresent) throw invalid("the address of an object store must not have a query or a fragment");
    }
    if (!address.ends_with('/')) address += '/';
    return address;
}

}  // namespace

void ObjectStore::CurlHandleCloser::operator()(void* handle) const { curl_easy_cleanup(handle); }

ObjectStore::ObjectStore(const std::string& address, const ObjectStoreLimits& limits) : limits_(limits) {
    static const CURLcode initialized = curl_global_init(CURL_GLOBAL_DEFAULT);
    if (initialized != CURLE_OK) throw std::runtime_error("libcurl cannot be initialized");
    address_ = checkedAddress(address);
}

ObjectStore::~ObjectStore() = default;

bool ObjectStore::isUrl(const std::string& text) { return text.find("://") != std::string::npos; }

ObjectStore::CurlHandle ObjectStore::takeHandle() const {
    {
        const std::lock_guard lock(mutex_);
        if (!idle_.empty()) {
            CurlHandle handle = std::move(idle_.back());
            idle_.pop_back();
            return handle;
        }
    }
    CurlHandle handle(curl_easy_init());
    if (!handle) throw std::bad_alloc();
    return handle;
}

Result<std::optional<std::string>> ObjectStore::get(const std::string& path, const FilePart& part,
                                                    Clock::time_point until, const std::stop_token& stop) const {
    if (!isValidObjectPath(path)) return std::optional<std::string>();
    if (part.size == 0) return std::optional(std::string());
    const bool isPart = !part.isWhole();
    const std::string url = address_ + text::percentEncoded(path, "/");
    const auto refused = [&](const std::string& why) {
        spdlog::warn("an object was not read address={} reason=\"{}\"", url, why);
        return Error{ErrorCode::internal, "the object store of --data failed: " + why};
    };
    const Error tooLarge{ErrorCode::too_large,
                         "an object or a part of one takes more than " + std::to_string(limits_.objectBytes) +
                             " bytes, which the server may get from the object store (--max-data-object)"};
    if (part.size != FilePart::kAll && part.size > limits_.objectBytes) return tooLarge;
    const auto left = std::chrono::duration<double>(until - Clock::now());
    if (left.count() <= 0) return refused(transferFailureReason(CURLE_OPERATION_TIMEDOUT));

    CurlHandle owned = takeHandle();
    CURL* const handle = owned.get();
    CurlTransfer transfer{handle, isPart ? kPartialContent : kOk, limits_.objectBytes, stop};
    const std::string range = isPart ? rangeHeaderOf(part) : "";
    curl_easy_reset(handle);  // resets all options, but keeps the connection open
    curl_easy_setopt(handle, CURLOPT_URL, url.c_str());
    curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 0L);
    curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(handle, CURLOPT_USERAGENT, "oval4d");
    curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT_MS, curlMilliseconds(std::min(left, limits_.connectTimeout)));
    curl_easy_setopt(handle, CURLOPT_TIMEOUT_MS, curlMilliseconds(std::min(left, limits_.timeout)));
    if (isPart) curl_easy_setopt(handle, CURLOPT_RANGE, range.c_str());
    curl_easy_setopt(handle, CURLOPT_WRITEFUNCTION, onAnswerBytes);
    curl_easy_setopt(handle, CURLOPT_WRITEDATA, &transfer);
    curl_easy_setopt(handle, CURLOPT_NOPROGRESS, 0L);
    curl_easy_setopt(handle, CURLOPT_XFERINFOFUNCTION, onProgress);
    curl_easy_setopt(handle, CURLOPT_XFERINFODATA, &transfer);
    const CURLcode code = curl_easy_perform(handle);
    const long status = statusOf(handle);
    const std::string contentRange = contentRangeOf(handle);
    {
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(owned));
    }
    if (code == CURLE_ABORTED_BY_CALLBACK) return Error{ErrorCode::internal, "the server stops reading this field"};
    if (transfer.isTooLarge) return tooLarge;
    // If onAnswerBytes() has ended the transfer, `status` says more about the reason than `code`.
    if (code != CURLE_OK && (code != CURLE_WRITE_ERROR || status == transfer.wantedStatus))
        return refused(transferFailureReason(code));
    constexpr long kNotFound = 404, kGone = 410, kRangeNotSatisfiable = 416;
    if (status == kNotFound || status == kGone) return std::optional<std::string>();
    if (status == kRangeNotSatisfiable && isPart) return std::optional(std::string());
    if (status != transfer.wantedStatus) return refused(transferFailureReason(status, isPart));
    if (isPart && !isContentRangeOf(contentRange, part, transfer.bytes.size()))
        return refused("it answers a request for a part of an object with other bytes, or with a wrong length");
    return std::optional(std::move(transfer.bytes));
}

}  // namespace oval4d::net
