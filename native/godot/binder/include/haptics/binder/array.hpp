/// The engine's untyped list.
#pragma once

#include <haptics/binder/variant.hpp>

namespace haptics::godot {

/// A list of any values. Copies share the same list, as in scripts.
class Array : public internal::Builtin<GDEXTENSION_VARIANT_TYPE_ARRAY, 8> {
  public:
    Array() = default;
    /// A list of the given values.
    template <class... Args>
    static Array make(const Args&... args) {
        Array array;
        (array.push_back(Variant(args)), ...);
        return array;
    }

    int64_t size() const { return internal::call_int(ops().size, _native_ptr(), nullptr, 0); }
    bool is_empty() const { return size() == 0; }
    void resize(int64_t count);
    void clear() { ops().clear(_native_ptr(), nullptr, nullptr, 0); }
    void push_back(const Variant& value);
    /// An index out of range prints an engine error.
    const Variant& operator[](int64_t index) const;
    Variant& operator[](int64_t index);
};

} // namespace haptics::godot
