#include "net/http/web_files.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/crc.hpp>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <utility>

namespace oval4d::net {

namespace {

constexpr std::string_view kIdentity = "identity";

std::string mediaTypeOf(const std::filesystem::path& path) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kTypes{{
        {".html", "text/html; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".json", "application/json"},
        {".map", "application/json"},
        {".webmanifest", "application/manifest+json"},
        {".svg", "image/svg+xml"},
        {".png", "image/png"},
        {".ico", "image/x-icon"},
        {".woff2", "font/woff2"},
        {".wasm", "application/wasm"},
        {".txt", "text/plain; charset=utf-8"},
    }};
    const std::string extension = path.extension().string();
    for (const auto& [known, type] : kTypes) {
        if (extension == known) return std::string(type);
    }
    return "application/octet-stream";
}

std::string etagOf(const std::string& content) {
    boost::crc_optimal<64, 0x42F0E1EBA9EA3693, 0, 0, false, false> crc;
    crc.process_bytes(content.data(), content.size());
    return fmt::format("\"{:016x}\"", crc.checksum());
}

/// Returns the content coding of a file, judged by the extension of its name; an empty string for an uncompressed file.
std::string_view contentCodingOf(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    return extension == ".br" ? "br" : extension == ".gz" ? "gzip" : "";
}

HttpRepresentation readRepresentation(const std::filesystem::path& path, std::string_view coding) {
    std::ifstream in(path, std::ios::binary);
    std::string content{std::istreambuf_iterator<char>(in), {}};
    std::string etag = etagOf(content);
    return {SharedBytes(std::move(content)), std::string(coding), std::move(etag)};
}

/// Returns the weight, from 0 to 1, that an Accept-Encoding field gives to a content coding (RFC 9110, section 12.4.2).
double codingWeight(std::string_view coding, std::string_view acceptEncoding) {
    namespace http = boost::beast::http;
    const bool identity = coding == kIdentity;
    // The weight of a coding that the field does not list: unacceptable, except identity as a last resort.
    double any = identity ? 0.0005 : 0;
    for (const auto& [name, parameters] : http::ext_list({acceptEncoding.data(), acceptEncoding.size()})) {
        double weight = 1;
        for (const auto& [key, value] : parameters)
            if (boost::beast::iequals(key, "q")) weight = std::strtod(std::string(value).c_str(), nullptr);
        if (boost::beast::iequals(name, boost::beast::string_view(coding.data(), coding.size()))) return weight;
        if (name == "*" && (!identity || weight == 0)) any = weight;
    }
    return any;
}

}  // namespace

const HttpRepresentation& WebFile::negotiate(std::string_view acceptEncoding) const {
    const auto best = std::ranges::max_element(
        representations, {}, [&](const HttpRepresentation& each) { return codingWeight(each.coding, acceptEncoding); });
    if (codingWeight(best->coding, acceptEncoding) > 0) return *best;
    return *std::ranges::find(representations, kIdentity, &HttpRepresentation::coding);
}

WebFiles::WebFiles(const std::filesystem::path& root) {
    namespace fs = std::filesystem;
    std::error_code fault;
    for (const auto& entry : fs::recursive_directory_iterator(root, fault)) {
        const fs::path& path = entry.path();
        if (!entry.is_regular_file() ||
            (!contentCodingOf(path).empty() && fs::exists(fs::path(path).replace_extension())))
            continue;
        WebFile file{mediaTypeOf(path), {readRepresentation(path, kIdentity)}};
        for (const char* extension : {".br", ".gz"}) {
            const fs::path compressed = fs::path(path) += extension;
            if (fs::exists(compressed))
                file.representations.push_back(readRepresentation(compressed, contentCodingOf(compressed)));
        }
        std::ranges::sort(file.representations, {}, [](const HttpRepresentation& each) { return each.bytes.size(); });
        files_[fmt::format("/{}", path.lexically_relative(root).generic_string())] = std::move(file);
    }
    if (find("/") == nullptr) spdlog::warn("no page: the folder has no index.html folder=\"{}\"", root.string());
}

const WebFile* WebFiles::find(std::string_view path) const {
    const auto found = files_.find(path == "/" ? std::string_view("/index.html") : path);
    return found == files_.end() ? nullptr : &found->second;
}

}  // namespace oval4d::net
