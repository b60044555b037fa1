#pragma once
// Writes the stored members of structs to JSON arrays, and reads them. MemberWriter and MemberReader are visitors for
// the functions visitStoredMembers(), which serialization/stored_members.hpp describes.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>

#include "fields/array/sample_storage.hpp"
#include "geometry/jagged_array.hpp"
#include "geometry/range.hpp"
#include "geometry/rotation.hpp"
#include "session/settings.hpp"
#include "store/cbor.hpp"
#include "text/choice.hpp"
#include "text/message_text.hpp"

namespace oval4d::store {

/// A visitor that writes the stored members of a struct to a JSON array (see serialization/stored_members.hpp).
class MemberWriter {
  public:
    template <typename T, typename... Ranges>
    void member(std::size_t number, const T& value, Ranges... /*range*/) {
        put(number, encoded(value));
    }
    template <typename T, typename... Ranges>
    void memberAddedLater(std::size_t number, const T& value, Ranges... /*range*/) {
        put(number, encoded(value));
    }
    template <typename T>
    void recomputableMember(const T& /*value*/) {}
    void nestedArray(std::size_t number, const auto& visitThem) {
        MemberWriter writer;
        visitThem(writer);
        put(number, std::move(writer.array_));
    }
    void rotation(std::size_t number, const geometry::Rotation& rotation) {
        put(number, encoded(rotation.leftQuaternion()));
        put(number + 1, encoded(rotation.rightQuaternion()));
    }

    /// Returns the array with all members, and leaves the writer empty.
    nlohmann::json takeArray() { return std::move(array_); }

  protected:
    void put(std::size_t number, nlohmann::json value) {
        while (array_.size() <= number) array_.push_back(nullptr);
        array_[number] = std::move(value);
    }

  private:
    template <typename Struct>
    static nlohmann::json encoded(const Struct& value) {
        MemberWriter writer;
        visitStoredMembers(value, writer);
        return std::move(writer.array_);
    }
    template <typename Number>
        requires std::is_arithmetic_v<Number>
    static nlohmann::json encoded(const Number& value) {
        return value;
    }
    template <text::HasChoices Enum>
    static nlohmann::json encoded(const Enum& value) {
        return static_cast<unsigned>(value);
    }
    template <typename T>
    static nlohmann::json encoded(const std::vector<T>& values) {
        nlohmann::json list = nlohmann::json::array();
        for (const T& value : values) list.push_back(encoded(value));
        return list;
    }
    template <typename T>
    static nlohmann::json encoded(const std::optional<T>& value) {
        return value ? encoded(*value) : nlohmann::json();
    }
    template <typename T, std::size_t kSize>
    static nlohmann::json encoded(const std::array<T, kSize>& values) {
        nlohmann::json list = nlohmann::json::array();
        for (const T& value : values) list.push_back(encoded(value));
        return list;
    }
    static nlohmann::json encoded(const std::string& text) { return text; }
    static nlohmann::json encoded(const geometry::JaggedArray& rows) {
        nlohmann::json list = nlohmann::json::array();
        for (std::size_t i = 0; i < rows.size(); ++i) list.emplace_back(rows[i]);
        return list;
    }
    // Encodes samples as 32-bit floats in the byte order of the processor: little-endian on x86-64.
    static nlohmann::json encoded(const fields::SampleStorage& samples) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(samples.values().data());
        return nlohmann::json::binary(
            nlohmann::json::binary_t::container_type(bytes, bytes + samples.values().size_bytes()));
    }
    static nlohmann::json encoded(const glm::dvec4& v) { return {v.x, v.y, v.z, v.w}; }
    static nlohmann::json encoded(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
    static nlohmann::json encoded(const glm::dquat& q) { return {q.w, q.x, q.y, q.z}; }
    // Encodes a turn (a rotation in one plane or several). A turn in one plane, or in two perpendicular planes, becomes
    // [plane, angle, angle in the perpendicular plane or null]; earlier versions can read this form, too. Any other
    // turn becomes a list of pairs: [[plane, angle], …]. Angles are in radians.
    static nlohmann::json encoded(const geometry::RotationAngles& turn) {
        const std::vector<geometry::Plane> planes = turn.planes();
        const geometry::Plane first = planes.at(0);
        if (planes.size() == 1 || (planes.size() == 2 && planes[1] == geometry::orthogonalComplement(first)))
            return {static_cast<unsigned>(first), *turn[first], encoded(turn[geometry::orthogonalComplement(first)])};
        nlohmann::json pairs = nlohmann::json::array();
        for (const geometry::Plane plane : planes)
            pairs.push_back(nlohmann::json::array({static_cast<unsigned>(plane), *turn[plane]}));
        return pairs;
    }

    nlohmann::json array_ = nlohmann::json::array();
};

inline geometry::Plane planeIn(const nlohmann::json& value) {
    const auto number = readInteger<unsigned>(value);
    if (number >= geometry::kPlanes.size()) throwLaterRecord("there is no plane " + std::to_string(number));
    return geometry::kPlanes[number];
}

inline glm::dquat quaternionIn(const nlohmann::json& value) {
    refuseUnknownMembers(value, 4);
    return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>(), value.at(3).get<double>()};
}

/// A visitor that reads the stored members of a struct from a JSON array (see serialization/stored_members.hpp).
class MemberReader {
  public:
    explicit MemberReader(const nlohmann::json& array) : array_(array) {}

    template <typename T, typename... Ranges>
    void member(std::size_t number, T& value, Ranges... range) {
        read(at(number), value, range...);
    }
    template <typename T, typename... Ranges>
    void memberAddedLater(std::size_t number, T& value, Ranges... range) {
        if (has(number)) member(number, value, range...);
    }
    template <typename T>
    void recomputableMember(T& /*value*/) {}
    void nestedArray(std::size_t number, const auto& visitThem) {
        MemberReader reader(at(number));
        visitThem(reader);
        reader.refuseUnreadMembers();
    }
    void rotation(std::size_t number, geometry::Rotation& rotation) {
        const auto decoded =
            geometry::Rotation::fromQuaternions(quaternionIn(at(number)), quaternionIn(at(number + 1)));
        if (!decoded) throwUnreadableRecord("an orientation is not a rotation");
        rotation = *decoded;
    }

    /// Throws NewerVersionRecord if the array has elements after those of the members that were read.
    void refuseUnreadMembers() const { refuseUnknownMembers(array_, readCount_); }

  protected:
    bool has(std::size_t number) const { return number < array_.size(); }
    const nlohmann::json& at(std::size_t number) {
        readCount_ = std::max(readCount_, number + 1);
        return array_.at(number);
    }

  private:
    template <typename Struct>
    static void read(const nlohmann::json& value, Struct& into) {
        MemberReader reader(value);
        visitStoredMembers(into, reader);
        reader.refuseUnreadMembers();
    }
    static void read(const nlohmann::json& value, bool& into) { into = value.get<bool>(); }
    template <std::integral Integer>
    static void read(const nlohmann::json& value, Integer& into) {
        into = readInteger<Integer>(value);
    }
    static void read(const nlohmann::json& value, double& into, geometry::NumberRange range) {
        into = readNumber(value, range.least, range.most);
    }
    template <text::HasChoices Enum>
    static void read(const nlohmann::json& value, Enum& into) {
        static_assert(text::hasNoAliases(choicesOf(Enum{})), "two enumerators are stored under one number");
        const auto number = readInteger<unsigned>(value);
        const auto& choices = choicesOf(Enum{});
        const auto found = std::ranges::find_if(
            choices, [&](const auto& choice) { return static_cast<unsigned>(choice.value) == number; });
        if (found == choices.end()) throwLaterRecord("an enumerator is out of range: " + std::to_string(number));
        into = found->value;
    }
    template <typename T, typename... Ranges>
    static void read(const nlohmann::json& value, std::vector<T>& into, Ranges... range) {
        if (!value.is_array()) throwUnreadableRecord("a list is missing");
        into.clear();
        for (const nlohmann::json& element : value) read(element, into.emplace_back(), range...);
    }
    template <typename T>
    static void read(const nlohmann::json& value, std::optional<T>& into) {
        into.reset();
        if (!value.is_null()) read(value, into.emplace());
    }
    template <typename T, std::size_t kSize>
    static void read(const nlohmann::json& value, std::array<T, kSize>& into) {
        refuseUnknownMembers(value, kSize);
        for (std::size_t i = 0; i < kSize; ++i) read(value.at(i), into[i]);
    }
    static void read(const nlohmann::json& value, std::string& into) {
        into = value.get<std::string>();
        if (!text::isUtf8(into)) throwUnreadableRecord("a text is not UTF-8");
    }
    static void read(const nlohmann::json& value, geometry::JaggedArray& into) {
        if (!value.is_array()) throwUnreadableRecord("a list is missing");
        into = {};
        for (const nlohmann::json& row : value) into.add(readIntegers(row));
    }
    static void read(const nlohmann::json& value, fields::SampleStorage& into) {
        const auto& bytes = value.get_binary();
        if (bytes.empty() || bytes.size() % sizeof(float) != 0)
            throwUnreadableRecord("samples of an array are missing");
        std::vector<float> samples(bytes.size() / sizeof(float));
        std::memcpy(samples.data(), bytes.data(), bytes.size());
        into = fields::SampleStorage(std::move(samples));
    }
    static void read(const nlohmann::json& value, glm::dvec3& into, geometry::NumberRange range) {
        refuseUnknownMembers(value, 3);
        for (int i = 0; i < 3; ++i) read(value.at(static_cast<std::size_t>(i)), into[i], range);
    }
    static void read(const nlohmann::json& value, glm::dvec4& into, geometry::NumberRange range) {
        refuseUnknownMembers(value, 4);
        for (int i = 0; i < 4; ++i) read(value.at(static_cast<std::size_t>(i)), into[i], range);
    }
    static void read(const nlohmann::json& value, geometry::RotationAngles& into) {
        const auto angle = [&](const nlohmann::json& plane, const nlohmann::json& radians) {
            into[planeIn(plane)] = readNumber(radians, session::kMaxAngle);
        };
        if (value.at(0).is_array()) {
            for (const nlohmann::json& pair : value) {
                refuseUnknownMembers(pair, 2);
                angle(pair.at(0), pair.at(1));
            }
            return;
        }
        refuseUnknownMembers(value, 3);
        angle(value.at(0), value.at(1));
        if (!value.at(2).is_null())
            into[geometry::orthogonalComplement(planeIn(value.at(0)))] = readNumber(value.at(2), session::kMaxAngle);
    }

    const nlohmann::json& array_;
    std::size_t readCount_ = 0;  // the largest number of a member that was read, plus 1
};

}  // namespace oval4d::store
