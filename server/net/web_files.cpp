#include "net/web_files.hpp"

#include <spdlog/spdlog.h>

#include <array>
#include <boost/crc.hpp>
#include <fstream>
#include <iterator>
#include <utility>

namespace oval4d::net {

namespace {

std::string typeOf(const std::filesystem::path& path) {
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

}  // namespace

WebFiles::WebFiles(const std::filesystem::path& root) {
    namespace fs = std::filesystem;
    std::error_code fault;
    for (const auto& entry : fs::recursive_directory_iterator(root, fault)) {
        if (!entry.is_regular_file()) continue;
        std::ifstream in(entry.path(), std::ios::binary);
        std::string content{std::istreambuf_iterator<char>(in), {}};
        std::string etag = etagOf(content);
        files_[fmt::format("/{}", entry.path().lexically_relative(root).generic_string())] =
            WebFile{Bytes(std::move(content)), typeOf(entry.path()), std::move(etag)};
    }
    if (find("/") == nullptr) spdlog::warn("no page: there is no index.html folder=\"{}\"", root.string());
}

const WebFile* WebFiles::find(std::string_view path) const {
    const auto found = files_.find(path == "/" ? std::string_view("/index.html") : path);
    return found == files_.end() ? nullptr : &found->second;
}

}  // namespace oval4d::net
