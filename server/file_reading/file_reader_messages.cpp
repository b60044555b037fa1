#include "file_reading/file_reader_messages.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "fields/array/array_function.hpp"
#include "fields/field.hpp"
#include "serialization/byte_archive.hpp"
#include "slicing/object_bytes.hpp"
#include "text/message_text.hpp"

namespace oval4d::file_reading {

using serialization::ByteReader;
using serialization::ByteWriter;

namespace {

// Limits on the errors and warnings that the server accepts from a reader process, because a malicious file may control
// the process. Usual errors and warnings are far below these limits.
constexpr std::size_t kMaxText = 2000;     // the server keeps about this many bytes of an error message or a warning
constexpr std::size_t kMaxWarnings = 100;  // more warnings make the whole outcome invalid

enum class ReadOutcomeKind : std::uint8_t {
    object,
    bad_polytope,
    bad_field,
    unsupported_format,
    too_large,
    out_of_range,
    not_found,
    bad_expression
};
constexpr auto kErrors = std::to_array<std::pair<ReadOutcomeKind, ErrorCode>>(
    {{ReadOutcomeKind::bad_polytope, ErrorCode::bad_polytope},
     {ReadOutcomeKind::bad_field, ErrorCode::bad_field},
     {ReadOutcomeKind::unsupported_format, ErrorCode::unsupported_format},
     {ReadOutcomeKind::too_large, ErrorCode::too_large},
     {ReadOutcomeKind::out_of_range, ErrorCode::out_of_range},
     {ReadOutcomeKind::not_found, ErrorCode::not_found},
     {ReadOutcomeKind::bad_expression, ErrorCode::bad_expression}});

[[noreturn]] void throwBadReaderMessage(const std::string& what) {
    throw std::runtime_error("a reader process sent " + what);
}

std::string readPrintableText(ByteReader& archive) {
    std::string text;
    archive(text);
    return text::printable(text, kMaxText);
}

/// Returns the size in bytes of the samples of `object` that the encoded outcome contains. The samples of an array with
/// more than `maxInMemory` samples do not count: they are in a mapped file, to which the outcome refers.
std::size_t sampleBytes(const slicing::Object& object, std::size_t maxInMemory) {
    const fields::Field* const field = slicing::fieldIn(object);
    std::size_t bytes = 0;
    for (const auto* array : {field == nullptr ? nullptr : field->array.get(),
                              field == nullptr || !field->second ? nullptr : field->second->array.get()}) {
        if (array != nullptr && array->samples().size() <= maxInMemory) bytes += array->samples().size_bytes();
    }
    return bytes;
}

// Encodes the members of a request that need no conversion or, if `archive` is a ByteReader, decodes them.
// encodeReadRequest() and decodeReadRequest() share this code, so that they agree on these members.
template <typename Archive, typename Load, typename Limits>
void serializeReadRequest(Archive& archive, Load& load, Limits& limits) {
    archive(load.format), archive(load.name), archive(load.axes), archive(load.variable), archive(load.data);
    archive(load.secondFormula), archive(load.secondVariable), archive(load.center.choice), archive(load.center.place);
    archive(limits.maxVertices), archive(limits.maxHullCells), archive(limits.maxFieldBytes);
    archive(limits.maxFirstLevelBytes);
}

}  // namespace

void encodeReadRequest(const session::LoadObject& load, const session::Limits& limits, bool mayMap, std::string& out) {
    out.clear();
    ByteWriter archive(out);
    serializeReadRequest(archive, load, limits);
    for (const auto& box : {load.box, load.region}) archive(box.has_value()), archive(box.value_or(fields::Box{}));
    archive(load.finer.has_value()), archive(load.finer.value_or(session::FinerImageLevel{}).level);
    archive(load.series.size()), archive(load.folder != nullptr), archive(mayMap);
}

void decodeReadRequest(std::string_view bytes, FileReadRequest& out) {
    ByteReader archive(bytes);
    serializeReadRequest(archive, out.load, out.limits);
    for (std::optional<fields::Box>* const to : {&out.load.box, &out.load.region}) {
        bool hasBox = false;
        fields::Box box;
        archive(hasBox), archive(box);
        if (hasBox) *to = box;
    }
    bool isFiner = false;
    std::uint32_t level = 0;
    archive(isFiner), archive(level);
    if (isFiner) out.load.finer = session::FinerImageLevel{level, 0};
    archive(out.seriesLength), archive(out.isFolder), archive(out.mayMap);
}

void encodeFindRequest(const FolderFileRequest& request, std::string& out) {
    out.clear();
    ByteWriter archive(out);
    archive(request.path), archive(request.part.offset), archive(request.part.size), archive(request.part.fromEnd);
}

FolderFileRequest decodeFindRequest(std::string_view bytes) {
    ByteReader archive(bytes);
    FolderFileRequest request;
    archive(request.path), archive(request.part.offset), archive(request.part.size), archive(request.part.fromEnd);
    return request;
}

void encodeOutcome(const Result<session::ObjectWithWarnings>& outcome, std::string& out, slicing::MappedFiles files,
                   std::size_t maxInMemory) {
    out.clear();
    ByteWriter archive(out);
    if (!outcome) {
        const auto& [code, message] = outcome.error();
        const auto error = std::ranges::find(kErrors, code, &std::pair<ReadOutcomeKind, ErrorCode>::second);
        archive(error == kErrors.end() ? ReadOutcomeKind::bad_polytope : error->first), archive(message);
        return;
    }
    out.reserve(
        sampleBytes(outcome->object, maxInMemory));  // otherwise, a large array would be copied while the string grows
    archive(ReadOutcomeKind::object);
    archive(outcome->warnings.size());
    for (const std::string& warning : outcome->warnings) archive(warning);
    slicing::writeObjectContent(outcome->object, archive, files, maxInMemory);
}

Result<session::ObjectWithWarnings> decodeOutcome(std::string_view bytes, const std::string& name,
                                                  const session::Limits& limits, const slicing::MappedFiles& files) {
    ByteReader archive(bytes);
    ReadOutcomeKind kind{};
    archive(kind);
    const auto error = std::ranges::find(kErrors, kind, &std::pair<ReadOutcomeKind, ErrorCode>::first);
    if (error != kErrors.end()) return Error{error->second, readPrintableText(archive)};
    if (kind != ReadOutcomeKind::object) throwBadReaderMessage("neither an object nor an error");

    std::size_t count = 0;
    archive(count);
    if (count > kMaxWarnings) throwBadReaderMessage("too many warnings");
    std::vector<std::string> warnings;
    while (warnings.size() < count) warnings.push_back(readPrintableText(archive));
    try {
        return session::ObjectWithWarnings{slicing::readObjectContent(archive, name, limits.maxVertices, files),
                                           std::move(warnings)};
    } catch (const std::runtime_error& fault) {
        throwBadReaderMessage(fault.what());
    }
}

std::size_t maxOutcomeBytes(const session::LoadObject& load, const session::Limits& limits) {
    // Generous limits. A number in a text file takes at least two bytes, with the blank after it. In the outcome, this
    // number takes four bytes as an index, and eight as a coordinate. A cell of a convex hull, with its 2-faces, takes
    // less than kPerCell bytes in the outcome.
    constexpr std::size_t kPerTextByte = 16, kPerCell = 512, kBase = 1U << 20U;
    if (load.isArrayInFiles() || session::isArrayFormat(load.format)) return kBase + limits.maxFieldBytes;
    return kBase + kPerTextByte * load.data.size() + kPerCell * limits.maxHullCells;
}

}  // namespace oval4d::file_reading
