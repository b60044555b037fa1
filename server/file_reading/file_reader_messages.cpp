#include "file_reading/file_reader_messages.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "serialization/byte_archive.hpp"
#include "slicing/object_bytes.hpp"
#include "text/message_text.hpp"

namespace oval4d::file_reading {

using serialization::ByteReader;
using serialization::ByteWriter;

namespace {

// Limits on the errors and warnings of a reader process. The errors and warnings of session::readObject stay below
// them.
constexpr std::size_t kMaxText = 2000;  // bytes
constexpr std::size_t kMaxWarnings = 100;

enum class Kind : std::uint8_t { object, invalid, too_large };
constexpr auto kErrors = std::to_array<std::pair<Kind, ErrorCode>>(
    {{Kind::invalid, ErrorCode::bad_polytope}, {Kind::too_large, ErrorCode::too_large}});

[[noreturn]] void reject(const std::string& what) { throw std::runtime_error("a reader process sent " + what); }

std::string textFrom(ByteReader& archive) {
    std::string text;
    archive(text);
    return text::printable(text, kMaxText);
}

}  // namespace

void encodeFile(std::string_view format, std::string_view text, const std::string& name, const session::Limits& limits,
                std::string& out) {
    out.clear();
    ByteWriter archive(out);
    archive(format), archive(name), archive(limits.maxVertices), archive(limits.maxHullCells), archive(text);
}

void decodeFile(std::string_view bytes, File& out) {
    ByteReader archive(bytes);
    archive(out.format), archive(out.name), archive(out.limits.maxVertices), archive(out.limits.maxHullCells);
    archive(out.text);
}

void encodeOutcome(const Result<session::LoadedObject>& outcome, std::string& out) {
    out.clear();
    ByteWriter archive(out);
    if (!outcome) {
        const auto& [code, message] = outcome.error();
        archive(code == ErrorCode::too_large ? Kind::too_large : Kind::invalid), archive(message);
        return;
    }
    archive(Kind::object);
    archive(outcome->warnings.size());
    for (const std::string& warning : outcome->warnings) archive(warning);
    slicing::writeParts(outcome->object, archive);
}

Result<session::LoadedObject> decodeOutcome(std::string_view bytes, const std::string& name,
                                            const session::Limits& limits) {
    ByteReader archive(bytes);
    Kind kind{};
    archive(kind);
    const auto error = std::ranges::find(kErrors, kind, &std::pair<Kind, ErrorCode>::first);
    if (error != kErrors.end()) return Error{error->second, textFrom(archive)};
    if (kind != Kind::object) reject("neither an object nor an error");

    std::size_t count = 0;
    archive(count);
    if (count > kMaxWarnings) reject("too many warnings");
    std::vector<std::string> warnings;
    while (warnings.size() < count) warnings.push_back(textFrom(archive));
    try {
        return session::LoadedObject{slicing::readParts(archive, name, limits.maxVertices), std::move(warnings)};
    } catch (const std::runtime_error& fault) {
        reject(fault.what());
    }
}

std::size_t maxOutcomeBytes(std::size_t textBytes, const session::Limits& limits) {
    // A number takes at least two bytes in the text, with the blank after it, and four bytes as an index in the
    // outcome. A cell of a convex hull, with its 2-faces, takes less than kPerCell bytes.
    constexpr std::size_t kPerTextByte = 16, kPerCell = 512, kBase = 1U << 20U;
    return kBase + kPerTextByte * textBytes + kPerCell * limits.maxHullCells;
}

}  // namespace oval4d::file_reading
