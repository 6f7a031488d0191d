/// Packed arrays: shared, copied on write, contiguous.
#pragma once

#include <haptics/binder/string.hpp>
#include <haptics/binder/vector2.hpp>

#include <initializer_list>
#include <span>

namespace haptics::godot {

namespace internal {

/// The engine's element access for one packed array type.
template <GDExtensionVariantType Type>
struct PackedAccess;

#define HAPTICS_BINDER_PACKED_ACCESS(m_tag, m_name, m_element)                                               \
    template <>                                                                                              \
    struct PackedAccess<GDEXTENSION_VARIANT_TYPE_PACKED_##m_tag##_ARRAY> {                                   \
        using Element = m_element;                                                                           \
        static Element* write(void* self) {                                                                  \
            void* first = api.packed_##m_name##_array_operator_index(self, 0);                               \
            return static_cast<Element*>(first);                                                             \
        }                                                                                                    \
        static const Element* read(const void* self) {                                                       \
            const void* first = api.packed_##m_name##_array_operator_index_const(self, 0);                   \
            return static_cast<const Element*>(first);                                                       \
        }                                                                                                    \
    };

HAPTICS_BINDER_PACKED_ACCESS(BYTE, byte, uint8_t)
HAPTICS_BINDER_PACKED_ACCESS(INT32, int32, int32_t)
HAPTICS_BINDER_PACKED_ACCESS(INT64, int64, int64_t)
HAPTICS_BINDER_PACKED_ACCESS(FLOAT32, float32, float)
HAPTICS_BINDER_PACKED_ACCESS(FLOAT64, float64, double)
HAPTICS_BINDER_PACKED_ACCESS(STRING, string, String)
HAPTICS_BINDER_PACKED_ACCESS(VECTOR2, vector2, Vector2)
#undef HAPTICS_BINDER_PACKED_ACCESS

} // namespace internal

/// An array of one plain type. `const PackedArray&` as a bound parameter reads the caller's memory without a
/// copy.
template <GDExtensionVariantType Type>
class PackedArray : public internal::Builtin<Type, 16> {
    using Base = internal::Builtin<Type, 16>;
    using Access = internal::PackedAccess<Type>;

  public:
    using Element = typename Access::Element;

    PackedArray() = default;
    PackedArray(std::initializer_list<Element> values)
        : PackedArray(std::span<const Element>(values)) {}
    /// A copy of plain memory.
    explicit PackedArray(std::span<const Element> values) {
        resize(static_cast<int64_t>(values.size()));
        Element* to = ptrw();
        for (const Element& value : values) {
            *to++ = value;
        }
    }

    int64_t size() const { return internal::call_int(Base::ops().size, this->_native_ptr(), nullptr, 0); }
    bool is_empty() const { return size() == 0; }
    /// New elements are zero (empty for text).
    void resize(int64_t count) {
        const GDExtensionConstTypePtr args[] = {&count};
        internal::call_int(Base::ops().resize, this->_native_ptr(), args, 1);
    }
    void clear() { Base::ops().clear(this->_native_ptr(), nullptr, nullptr, 0); }

    /// First element, null when empty; valid until the array changes.
    const Element* ptr() const { return is_empty() ? nullptr : Access::read(this->_native_ptr()); }
    /// First element for writing; takes a copy of shared memory first. Null when empty.
    Element* ptrw() { return is_empty() ? nullptr : Access::write(this->_native_ptr()); }
    /// The memory with its size.
    std::span<const Element> span() const { return {ptr(), static_cast<std::size_t>(size())}; }
    std::span<Element> span_w() { return {ptrw(), static_cast<std::size_t>(size())}; }

    /// No bounds check.
    const Element& operator[](int64_t index) const { return Access::read(this->_native_ptr())[index]; }
    void set(int64_t index, const Element& value) { Access::write(this->_native_ptr())[index] = value; }
    /// Grows by one; for many elements resize() once and write through ptrw().
    void push_back(const Element& value) {
        const int64_t count = size();
        resize(count + 1);
        set(count, value);
    }
};

using PackedByteArray = PackedArray<GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY>;
using PackedInt32Array = PackedArray<GDEXTENSION_VARIANT_TYPE_PACKED_INT32_ARRAY>;
using PackedInt64Array = PackedArray<GDEXTENSION_VARIANT_TYPE_PACKED_INT64_ARRAY>;
using PackedFloat32Array = PackedArray<GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY>;
using PackedFloat64Array = PackedArray<GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT64_ARRAY>;
using PackedStringArray = PackedArray<GDEXTENSION_VARIANT_TYPE_PACKED_STRING_ARRAY>;
using PackedVector2Array = PackedArray<GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR2_ARRAY>;

} // namespace haptics::godot
