/// How each C++ type crosses the border to the engine, by Variant and by typed pointer. Included by
/// variant.hpp.
#pragma once

#include <haptics/binder/variant.hpp>

namespace haptics::godot {

/// The name under which scripts see an enumeration ("Class.Name"); VARIANT_ENUM_CAST gives it.
template <class Enum>
struct EnumName {
    static constexpr const char* value = "";
};

/// Names an enumeration of a bound class for scripts and documentation: VARIANT_ENUM_CAST(Probe::Mode), at
/// namespace haptics or outside of every namespace.
#define VARIANT_ENUM_CAST(m_enum)                                                                            \
    template <>                                                                                              \
    struct haptics::godot::EnumName<m_enum> {                                                                \
        static constexpr const char* value = #m_enum;                                                        \
    };

namespace internal {

/// A value type of the engine that is held as opaque bytes.
template <class T>
concept BuiltinValue = !std::same_as<T, Variant> && requires(T value) {
    { T::variant_type } -> std::convertible_to<GDExtensionVariantType>;
    { value._native_ptr() } -> std::same_as<void*>;
};

/// Scalars travel by pointer as one of the engine's three wide types.
template <class T, class Wide, GDExtensionVariantType Type, GDExtensionClassMethodArgumentMetadata Metadata>
struct ScalarBinding {
    static constexpr GDExtensionVariantType variant_type = Type;
    static constexpr GDExtensionClassMethodArgumentMetadata metadata = Metadata;

    static T from_ptr(const void* from) { return static_cast<T>(*static_cast<const Wide*>(from)); }
    static void to_ptr(void* to, T value) { *static_cast<Wide*>(to) = static_cast<Wide>(value); }
    static T from_variant(const Variant& from) {
        Wide wide{};
        builtin_ops[Type].from_variant(&wide, const_cast<void*>(from._native_ptr()));
        return static_cast<T>(wide);
    }
    static void to_variant(void* uninitialized, T value) {
        Wide wide = static_cast<Wide>(value);
        builtin_ops[Type].to_variant(uninitialized, &wide);
    }
};

template <class T>
constexpr GDExtensionClassMethodArgumentMetadata int_metadata() {
    constexpr bool is_signed = std::is_signed_v<T>;
    switch (sizeof(T)) {
    case 1:
        return is_signed ? GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_INT8
                         : GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_UINT8;
    case 2:
        return is_signed ? GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_INT16
                         : GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_UINT16;
    case 4:
        return is_signed ? GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_INT32
                         : GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_UINT32;
    default:
        return is_signed ? GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_INT64
                         : GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_UINT64;
    }
}

/// Values that lie in memory as the engine's own do: read in place, converted by the engine's table.
template <class T, GDExtensionVariantType Type>
struct PlainBinding {
    static constexpr GDExtensionVariantType variant_type = Type;
    static constexpr GDExtensionClassMethodArgumentMetadata metadata =
        GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;

    static const T& from_ptr(const void* from) { return *static_cast<const T*>(from); }
    static void to_ptr(void* to, T value) { *static_cast<T*>(to) = static_cast<T&&>(value); }
    static T from_variant(const Variant& from) {
        T value;
        builtin_ops[Type].from_variant(&value, const_cast<void*>(from._native_ptr()));
        return value;
    }
    static void to_variant(void* uninitialized, const T& value) {
        builtin_ops[Type].to_variant(uninitialized, const_cast<T*>(&value));
    }
};

} // namespace internal

template <>
struct TypeBinding<bool> : internal::ScalarBinding<bool, GDExtensionBool, GDEXTENSION_VARIANT_TYPE_BOOL,
                                                   GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE> {};

template <std::integral T>
struct TypeBinding<T>
    : internal::ScalarBinding<T, int64_t, GDEXTENSION_VARIANT_TYPE_INT, internal::int_metadata<T>()> {};

template <class T>
    requires std::is_enum_v<T>
struct TypeBinding<T> : internal::ScalarBinding<T, int64_t, GDEXTENSION_VARIANT_TYPE_INT,
                                                GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE> {};

template <std::floating_point T>
struct TypeBinding<T> : internal::ScalarBinding<T, double, GDEXTENSION_VARIANT_TYPE_FLOAT,
                                                sizeof(T) == sizeof(float)
                                                    ? GDEXTENSION_METHOD_ARGUMENT_METADATA_REAL_IS_FLOAT
                                                    : GDEXTENSION_METHOD_ARGUMENT_METADATA_REAL_IS_DOUBLE> {};

template <>
struct TypeBinding<Vector2> : internal::PlainBinding<Vector2, GDEXTENSION_VARIANT_TYPE_VECTOR2> {};

template <>
struct TypeBinding<Transform2D> : internal::PlainBinding<Transform2D, GDEXTENSION_VARIANT_TYPE_TRANSFORM2D> {
};

template <>
struct TypeBinding<Variant> {
    static constexpr GDExtensionVariantType variant_type = GDEXTENSION_VARIANT_TYPE_NIL;
    static constexpr GDExtensionClassMethodArgumentMetadata metadata =
        GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;

    static const Variant& from_ptr(const void* from) { return *static_cast<const Variant*>(from); }
    static void to_ptr(void* to, Variant value) {
        *static_cast<Variant*>(to) = static_cast<Variant&&>(value);
    }
    static const Variant& from_variant(const Variant& from) { return from; }
};

template <internal::BuiltinValue T>
struct TypeBinding<T> : internal::PlainBinding<T, T::variant_type> {};

} // namespace haptics::godot
