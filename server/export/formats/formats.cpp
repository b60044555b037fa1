#include "export/formats/formats.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "export/formats/writers.hpp"
#include "protocol_data/embedded_files.hpp"
#include "text/choice.hpp"

namespace oval4d::exports {

namespace {

constexpr auto kArrangements =
    text::completeTable<text::NamedValue<Format::BodyArrangement>>({{"", Format::BodyArrangement::none},
                                                                    {"plate", Format::BodyArrangement::plate},
                                                                    {"oval", Format::BodyArrangement::oval}});

constexpr auto kObjects = text::completeTable<text::NamedValue<Format::ObjectKinds>>(
    {{"all", Format::ObjectKinds::all},
     {"fields", Format::ObjectKinds::fields},
     {"polytopes", Format::ObjectKinds::polytopes_and_points}});

std::vector<Format> readFormatTable() {
    std::vector<Format> table;
    const auto rows = nlohmann::json::parse(protocol_data::embeddedFile("export_formats.json")).at("formats");
    for (const auto& row : rows) {
        Format format;
        format.name = row.at("name");
        format.mediaType = row.at("media_type");
        const auto writer = std::ranges::find(kWriters, format.name, &FormatWriterRow::name);
        const std::string bodies = row.value("bodies", "");
        if (writer == kWriters.end() || (writer->ofBodies != nullptr) == bodies.empty())
            throw std::logic_error("export_formats.json: no matching writer for " + format.name);
        format.arrangement = text::valueNamed(kArrangements, bodies).value();
        format.objects = text::valueNamed(kObjects, row.value("objects", "all")).value();
        for (const std::string of : row.at("of"))
            format.contents.push_back(text::valueNamed(kExportContents, of).value());
        format.readsSurfaces = writer->readsSurfaces;
        format.keepsDoubles = writer->keepsDoubles;
        format.showsPicture = writer->showsPicture;
        format.writeBodies = writer->ofBodies;
        format.writeScene = writer->ofScene;
        format.writeDrawing = writer->ofDrawing;
        table.push_back(std::move(format));
    }
    if (table.size() != kWriters.size())
        throw std::logic_error("export_formats.json: a format with a writer is missing");
    return table;
}

}  // namespace

std::span<const Format> formats() {
    static const std::vector<Format> table = readFormatTable();
    return table;
}

const Format* formatNamed(std::string_view name) {
    const auto found = std::ranges::find(formats(), name, &Format::name);
    return found == formats().end() ? nullptr : &*found;
}

std::vector<std::string_view> formatNames() {
    std::vector<std::string_view> names;
    for (const Format& format : formats()) names.emplace_back(format.name);
    return names;
}

}  // namespace oval4d::exports
