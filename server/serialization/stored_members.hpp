#pragma once
// Defines which members of a struct are stored, and with which numbers.
//
// Each struct of a stored session or object has a function visitStoredMembers(), which visits its stored members. The
// function names all members in a structured binding, so it no longer compiles when the struct gets another member:
//
//     void visitStoredMembers(serialization::ReadOrWritten<CameraOrbit> auto& orbit, auto& visit) {
//         auto& [azimuth, elevation, zoom] = orbit;
//         visit.member(0, azimuth, CameraOrbit::kAngleRange);
//         …
//     }
//
// A struct with a base class has no structured binding. Instead, a static_assert beside the function states the number
// of members without those of the base (see HasOwnMembers). The function visits the base as a member (see asBase()).
//
// `visit` reads or writes one record (see store/member_codec.hpp). A struct is stored as an array, and the number of a
// member is its index in this array. Servers of different versions read and write the same records. Hence these rules:
//
// - A member keeps its number forever. The number of a removed member is not used again.
// - A new member gets the next number. memberAddedLater() visits it, because records of earlier versions lack it.
// - The same rules hold for the numbers of enumerators.
// - A record with members that this version does not know is refused. Otherwise, these members would be lost when the
//   record is written again.
//
// The functions of `visit` are:
//
// - member(number, value) or member(number, value, range): visits a member. `range` is the range of a floating-point
//   number, or of all numbers in a list. A record with a number outside the range is refused.
// - memberAddedLater(…): does the same for a member that records of earlier versions lack. When such a record is read,
//   the value stays unchanged.
// - rotation(number, value): visits a rotation: two quaternions, with the numbers `number` and `number` + 1.
// - nestedArray(number, visitThem): visits members that are stored together, as an array of their own with the index
//   `number` in the record. visitThem(visit) visits these members.
// - object(number, value): visits a 4-D object. Only State has such a member.
// - recomputableMember(value): visits a member of a 4-D object that is not stored, because it is computed when the
//   object is made. Messages between processes can contain such a member (see slicing/object_bytes.cpp).

#include <cstddef>
#include <type_traits>
#include <utility>

namespace oval4d::serialization {

/// Satisfied by `Struct`, whose members are then read, and by `const Struct`, whose members are then written.
template <typename T, typename Struct>
concept ReadOrWritten = std::is_same_v<std::remove_const_t<T>, Struct>;

/// Returns a reference to the base class `Base` of a struct. The reference is const if the struct is.
template <typename Base, typename Struct>
auto& asBase(Struct& value) {
    using Result = std::conditional_t<std::is_const_v<Struct>, const Base, Base>;
    return static_cast<Result&>(value);
}

/// A placeholder for a value of any type, for expressions that are never evaluated.
template <std::size_t kNumber>
struct ConvertibleToAnyType {
    template <typename T>
    operator T() const;  // NOLINT(google-explicit-constructor)
};

/// Returns whether the aggregate `Struct` can be initialized with its base class and N further values, where N is the
/// number of `kNumbers`.
template <typename Struct, typename Base, std::size_t... kNumbers>
constexpr bool isInitializableWith(std::index_sequence<kNumbers...> /*numbers*/) {
    return requires { Struct{std::declval<Base>(), ConvertibleToAnyType<kNumbers>()...}; };
}

/// Satisfied if the aggregate `Struct` has exactly `kCount` members besides the members of `Base`, its only base class.
template <typename Struct, typename Base, std::size_t kCount>
concept HasOwnMembers = isInitializableWith<Struct, Base>(std::make_index_sequence<kCount>()) &&
                        !isInitializableWith<Struct, Base>(std::make_index_sequence<kCount + 1>());

}  // namespace oval4d::serialization
