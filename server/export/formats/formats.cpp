#include "export/formats/formats.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "export/formats/csv.hpp"
#include "export/formats/glb.hpp"
#include "export/formats/obj.hpp"
#include "export/formats/off.hpp"
#include "export/formats/ply.hpp"
#include "export/formats/stl.hpp"
#include "export/formats/svg.hpp"
#include "export/formats/three_mf.hpp"
#include "export/formats/x3d.hpp"
#include "protocol_data/embedded_files.hpp"

namespace oval4d::exports {

namespace {

/// The name of a format and the function that writes it: `ofBodies` or `ofScene`; the other one is null.
struct Writer {
    std::string_view name;
    std::string (*ofBodies)(const BodiesInput&);
    std::string (*ofScene)(const SceneInput&);
};
constexpr auto kWriters = std::to_array<Writer>({{"3mf", threeMf, nullptr},
                                                 {"csv", nullptr, measurementsCsv},
                                                 {"glb", glb, nullptr},
                                                 {"obj", obj, nullptr},
                                                 {"off", nullptr, off},
                                                 {"ply", ply, nullptr},
                                                 {"stl", stl, nullptr},
                                                 {"svg", nullptr, parallelCoordinatesSvg},
                                                 {"x3d", x3d, nullptr}});

std::vector<Format> readTable() {
    std::vector<Format> table;
    const auto rows = nlohmann::json::parse(protocol_data::embeddedFile("export_formats.json")).at("formats");
    for (const auto& row : rows) {
        Format format{row.at("name"), row.at("media_type"), Format::Arrangement::none, nullptr, nullptr};
        const auto writer = std::ranges::find(kWriters, format.name, &Writer::name);
        const std::string bodies = row.value("bodies", "");
        if (writer == kWriters.end() || (writer->ofBodies != nullptr) == bodies.empty())
            throw std::logic_error("export_formats.json: no matching writer for " + format.name);
        if (!bodies.empty())
            format.arrangement = bodies == "plate" ? Format::Arrangement::plate : Format::Arrangement::oval;
        format.writeBodies = writer->ofBodies;
        format.writeScene = writer->ofScene;
        table.push_back(std::move(format));
    }
    if (table.size() != kWriters.size())
        throw std::logic_error("export_formats.json: a format with a writer is missing");
    return table;
}

}  // namespace

std::span<const Format> formats() {
    static const std::vector<Format> table = readTable();
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
