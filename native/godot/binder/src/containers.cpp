#include <haptics/binder/array.hpp>
#include <haptics/binder/dictionary.hpp>

namespace haptics::godot {

void Array::resize(int64_t count) {
    const GDExtensionConstTypePtr args[] = {&count};
    internal::call_int(ops().resize, _native_ptr(), args, 1);
}

void Array::push_back(const Variant& value) {
    const int64_t count = size();
    resize(count + 1);
    (*this)[count] = value;
}

const Variant& Array::operator[](int64_t index) const {
    return *static_cast<const Variant*>(internal::api.array_operator_index_const(_native_ptr(), index));
}

Variant& Array::operator[](int64_t index) {
    return *static_cast<Variant*>(internal::api.array_operator_index(_native_ptr(), index));
}

bool Dictionary::has(const Variant& key) const {
    GDExtensionBool valid = 0;
    const Variant self(*this);
    return internal::api.variant_has_key(self._native_ptr(), key._native_ptr(), &valid) != 0;
}

Array Dictionary::keys() const {
    return Variant(*this).call(SNAME("keys")).to<Array>();
}

Variant& Dictionary::operator[](const Variant& key) {
    return *static_cast<Variant*>(internal::api.dictionary_operator_index(_native_ptr(), key._native_ptr()));
}

Variant Dictionary::get(const Variant& key, const Variant& fallback) const {
    if (!has(key)) {
        return fallback;
    }
    return *static_cast<const Variant*>(
        internal::api.dictionary_operator_index_const(_native_ptr(), key._native_ptr()));
}

} // namespace haptics::godot
