/// The engine's any-value.
#pragma once

#include <haptics/binder/string.hpp>
#include <haptics/binder/transform2d.hpp>
#include <haptics/binder/vector2.hpp>

#include <concepts>
#include <type_traits>

namespace haptics::godot {

class Variant;

/// How a C++ type crosses the border; the specializations are in type_binding.hpp and, for objects, in
/// object.hpp.
template <class T>
struct TypeBinding;

namespace internal {

/// True for the types that Variant's converting constructor and operator take.
template <class T>
concept VariantValue = !std::same_as<std::remove_cvref_t<T>, Variant> && requires {
    { TypeBinding<std::remove_cvref_t<T>>::variant_type } -> std::convertible_to<GDExtensionVariantType>;
};

} // namespace internal

/// Any value that the engine knows. Reading it as a type it does not hold converts as the engine does (or
/// gives that type's default).
class Variant {
  public:
    /// The engine's type tags, under the names that PropertyInfo uses.
    enum Type {
        NIL = GDEXTENSION_VARIANT_TYPE_NIL,
        BOOL = GDEXTENSION_VARIANT_TYPE_BOOL,
        INT = GDEXTENSION_VARIANT_TYPE_INT,
        FLOAT = GDEXTENSION_VARIANT_TYPE_FLOAT,
        STRING = GDEXTENSION_VARIANT_TYPE_STRING,
        VECTOR2 = GDEXTENSION_VARIANT_TYPE_VECTOR2,
        TRANSFORM2D = GDEXTENSION_VARIANT_TYPE_TRANSFORM2D,
        STRING_NAME = GDEXTENSION_VARIANT_TYPE_STRING_NAME,
        OBJECT = GDEXTENSION_VARIANT_TYPE_OBJECT,
        CALLABLE = GDEXTENSION_VARIANT_TYPE_CALLABLE,
        DICTIONARY = GDEXTENSION_VARIANT_TYPE_DICTIONARY,
        ARRAY = GDEXTENSION_VARIANT_TYPE_ARRAY,
        PACKED_BYTE_ARRAY = GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY,
        PACKED_INT32_ARRAY = GDEXTENSION_VARIANT_TYPE_PACKED_INT32_ARRAY,
        PACKED_INT64_ARRAY = GDEXTENSION_VARIANT_TYPE_PACKED_INT64_ARRAY,
        PACKED_FLOAT32_ARRAY = GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY,
        PACKED_FLOAT64_ARRAY = GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT64_ARRAY,
        PACKED_STRING_ARRAY = GDEXTENSION_VARIANT_TYPE_PACKED_STRING_ARRAY,
        PACKED_VECTOR2_ARRAY = GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR2_ARRAY,
    };

    Variant() { internal::api.variant_new_nil(bytes_); }
    Variant(const Variant& other) { internal::api.variant_new_copy(bytes_, other.bytes_); }
    Variant(Variant&& other) noexcept { steal(other); }
    Variant& operator=(const Variant& other);
    Variant& operator=(Variant&& other) noexcept;
    ~Variant() { internal::api.variant_destroy(bytes_); }

    Variant(const char* utf8);
    template <internal::VariantValue T>
    Variant(const T& value) {
        TypeBinding<T>::to_variant(bytes_, value);
    }

    Type get_type() const { return static_cast<Type>(internal::api.variant_get_type(bytes_)); }
    /// False for null, zero, empty text and empty containers.
    bool booleanize() const { return internal::api.variant_booleanize(bytes_) != 0; }
    /// The text that print() shows.
    String stringify() const;
    bool operator==(const Variant& other) const;
    bool operator==(const char* utf8) const;
    template <internal::VariantValue T>
    bool operator==(const T& other) const {
        return *this == Variant(other);
    }

    /// The value as a T, converted where the engine converts.
    template <class T>
    T to() const {
        return TypeBinding<T>::from_variant(*this);
    }
    template <internal::VariantValue T>
    operator T() const {
        return to<T>();
    }

    /// Calls a method by name on the value; errors are printed and give null.
    template <class... Args>
    Variant call(const StringName& method, const Args&... args) {
        const Variant values[sizeof...(Args) + 1] = {Variant(args)...};
        return call_array(method, values, static_cast<int64_t>(sizeof...(Args)));
    }
    Variant call_array(const StringName& method, const Variant* args, int64_t count);

    static String get_type_name(Type type);

    void* _native_ptr() { return bytes_; }
    const void* _native_ptr() const { return bytes_; }

  private:
    void steal(Variant& other);

    alignas(8) std::byte bytes_[24];
};

} // namespace haptics::godot

#include <haptics/binder/type_binding.hpp>
