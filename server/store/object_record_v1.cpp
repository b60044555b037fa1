#include "store/object_record_v1.hpp"

#include <cstddef>
#include <string>
#include <utility>

#include "store/cbor.hpp"

// The record of an object in version 1 is an array. The length of the array tells the kind of object:
// - 2: [version, [[origin], record]], an object that was moved when it was loaded: its origin in its file, and its
//   record, which has another length
// - 3: [version, name, source], a field in a file of the data folder; the source is as in version 2, but may lack the
//   region
// - 4: [version, name, points, radii], a point cloud
// - 5: [version, name, formula or samples, box, shape], a field; the shape of a formula is an empty array
// - 6: [version, name, vertices, 2-faces, cells, the type of each cell], a polytope
// - 7: a field with a second function: the elements of length 5, then the second function and a text; the second
//   function is a formula or [variable, samples]
// - 8: [version, name, vertices, 2-faces, null, null, null, null], a surface
// - 9: an array with units: the elements of length 7 (the last two are null if there is no second function), then
//   [unit of x, unit of y, unit of z, unit of w, [name, unit] of the values], and [name, unit] of the values of the
//   second function
// This format does not change anymore. The members of version 2 and their numbers are in visitStoredMembers() beside
// each struct.

namespace oval4d::store {

using nlohmann::json;

namespace {

// The numbers of the kinds of objects in version 2.
constexpr unsigned kPolytope = 0, kCloud = 1, kField = 2, kSurface = 3;

json objectRecord(unsigned kind, bool isFile, json members) {
    return json::array({2, kind, isFile, std::move(members)});
}

json unknownQuantity() { return json::array({"", ""}); }

// Returns the stored members of a fields::FieldArray, as version 2 has them.
json arrayOf(json shape, json box, json samples, json units, json quantity) {
    return json::array(
        {std::move(shape), std::move(box), std::move(samples), std::move(units), std::move(quantity), false});
}

json fieldFromVersion1(json info, json record) {
    constexpr std::size_t kWithSecond = 7, kWithQuantities = 9;
    const bool isFormula = record.at(2).is_string(), measures = record.size() == kWithQuantities;
    if (isFormula && measures) throwUnreadableRecord("a formula has units");
    const json box = record.at(3), shape = record.at(4), noUnits = json::array({"", "", "", ""});
    json units = noUnits, quantity = unknownQuantity(), ofSecond = unknownQuantity();
    if (measures) {
        units = record.at(7);
        refuseUnknownMembers(units, noUnits.size() + 1);
        quantity = units.at(noUnits.size());
        units.erase(noUnits.size());
        ofSecond = record.at(8);
    }
    json second;
    if (record.size() >= kWithSecond && !record.at(5).is_null()) {
        json& function = record.at(5);
        if (function.is_string()) {
            second = json::array({std::move(function), "", nullptr});
        } else {
            json array = arrayOf(shape, box, std::move(function.at(1)), noUnits, std::move(ofSecond));
            second = json::array({"", std::move(function.at(0)), std::move(array)});
        }
    }
    json formula = "", array;
    if (isFormula) {
        formula = std::move(record.at(2));
    } else {
        array = arrayOf(shape, box, std::move(record.at(2)), std::move(units), std::move(quantity));
    }
    return json::array({std::move(info), nullptr, std::move(formula), box, std::move(array), std::move(second)});
}

}  // namespace

json convertedFromVersion1(json record) {
    json origin = json::array({0.0, 0.0, 0.0, 0.0});
    if (record.size() == 2) {
        json& moved = record.at(1);
        if (moved.at(0).size() != 1) throwUnreadableRecord("an object does not have one origin");
        origin = std::move(moved.at(0).at(0));
        json inner = std::move(moved.at(1));
        record = std::move(inner);
    }
    const std::size_t size = record.size();
    const auto take = [&record](std::size_t index) { return std::move(record.at(index)); };
    if (size < 3 || size > 9)
        throwLaterRecord("there is no kind of object with a record of " + std::to_string(size) + " members");
    json info = json::array({take(1), std::move(origin)});
    switch (size) {
        case 3: {
            // A field in a file needs no box in its record. But version 2 has an element for it, so any box is written
            // there.
            const json box = json::array({{-1.0, -1.0, -1.0, -1.0}, {1.0, 1.0, 1.0, 1.0}});
            return objectRecord(kField, true, json::array({std::move(info), take(2), "", box, nullptr, nullptr}));
        }
        case 4:
            return objectRecord(kCloud, false, json::array({std::move(info), take(2), take(3)}));
        case 6: {
            json complex = json::array({std::move(info), take(2), take(3), take(4), take(5)});
            return objectRecord(kPolytope, false, json::array({std::move(complex)}));
        }
        case 8: {
            for (std::size_t i = 4; i < size; ++i)
                if (!record.at(i).is_null()) throwLaterRecord("a surface has members that this version does not know");
            json complex = json::array({std::move(info), take(2), take(3), json::array(), json::array()});
            return objectRecord(kSurface, false, json::array({std::move(complex)}));
        }
        default:
            return objectRecord(kField, false, fieldFromVersion1(std::move(info), std::move(record)));
    }
}

}  // namespace oval4d::store
