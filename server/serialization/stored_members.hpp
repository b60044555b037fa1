#pragma once
// Which members of a struct are stored, and under which numbers.
//
// Beside each struct of a stored session or object is a function that visits the stored members. It names all members
// in a structured binding, so it no longer compiles when the struct gets another member:
//
//     void visitStoredMembers(serialization::ReadOrWritten<CameraOrbit> auto& orbit, auto& visit) {
//         auto& [azimuth, elevation, zoom] = orbit;
//         visit.member(0, azimuth, CameraOrbit::kAngleRange);
//         …
//     }
//
// A struct with a base class cannot be bound. Instead, a static_assert beside the function says how many members the
// struct has besides those of its base (see HasOwnMembers), and the function visits the base as a member (see
// asBase()).
//
// `visit` reads or writes one record (see store/member_codec.hpp). A struct is stored as an array, and the number of a
// member is its index in this array. Servers of other versions read and write the same records, hence these rules: a
// member keeps its number forever; the number of a removed member is not used again; a new member gets the next number
// and is visited with addedMember(), because records of earlier versions lack it. The same rules hold for the numbers
// of enumerators. A record with members that this version does not know is refused, because they would be lost when it
// is written again.
//
// - member(number, value) or member(number, value, range): a member, and the range of a floating-point number or of all
//   such numbers in a vector or list; a record with a number outside its range is refused
// - addedMember(…): like member(…), for a member that records of earlier versions lack; such records leave its value
//   unchanged
// - rotation(number, value): a rotation, as two quaternions with the numbers `number` and `number` + 1
// - array(number, visitThem): members that are stored together, as an array of their own with the index `number`;
//   visitThem(visit) visits them
// - object(number, value): a 4-D object; only State has one
// - computedMember(value): a member of a 4-D object that is not stored, because the function that makes the object
//   computes it; messages between processes can contain it (see slicing/object_bytes.cpp)

#include <cstddef>
#include <type_traits>
#include <utility>

namespace oval4d::serialization {

/// Satisfied by `Struct`, for reading its members, and by `const Struct`, for writing them.
template <typename T, typename Struct>
concept ReadOrWritten = std::is_same_v<std::remove_const_t<T>, Struct>;

/// Returns a struct as its base class, which is const if the struct is.
template <typename Base, typename Struct>
auto& asBase(Struct& value) {
    using Result = std::conditional_t<std::is_const_v<Struct>, const Base, Base>;
    return static_cast<Result&>(value);
}

/// Stands for a value of any type in expressions that are not evaluated.
template <std::size_t kNumber>
struct AnyValue {
    template <typename T>
    operator T() const;  // NOLINT(google-explicit-constructor)
};

/// Returns whether the aggregate `Struct` can be initialized with its base class and as many further values as there
/// are numbers.
template <typename Struct, typename Base, std::size_t... kNumbers>
constexpr bool takesInitializers(std::index_sequence<kNumbers...> /*numbers*/) {
    return requires { Struct{std::declval<Base>(), AnyValue<kNumbers>()...}; };
}

/// Satisfied if the aggregate `Struct` has exactly `kCount` members besides those of `Base`, its only base class.
template <typename Struct, typename Base, std::size_t kCount>
concept HasOwnMembers = takesInitializers<Struct, Base>(std::make_index_sequence<kCount>()) &&
                        !takesInitializers<Struct, Base>(std::make_index_sequence<kCount + 1>());

}  // namespace oval4d::serialization
