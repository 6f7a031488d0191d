/// The engine's key-value store.
#pragma once

#include <haptics/binder/array.hpp>

namespace haptics::godot {

/// Any keys to any values, in order of insertion. Copies share the same store, as in scripts.
/// Keys given as text are stored as String, which scripts find as `d["key"]` and `d.key` alike.
class Dictionary : public internal::Builtin<GDEXTENSION_VARIANT_TYPE_DICTIONARY, 8> {
  public:
    int64_t size() const { return internal::call_int(ops().size, _native_ptr(), nullptr, 0); }
    bool is_empty() const { return size() == 0; }
    void clear() { ops().clear(_native_ptr(), nullptr, nullptr, 0); }
    bool has(const Variant& key) const;
    Array keys() const;

    /// `d["key"] = value` makes the entry when it is missing.
    Variant& operator[](const Variant& key);
    /// Reading a missing key gives null.
    Variant operator[](const Variant& key) const { return get(key, Variant()); }
    Variant get(const Variant& key, const Variant& fallback) const;
    void set(const Variant& key, const Variant& value) { (*this)[key] = value; }
};

} // namespace haptics::godot
