#include <haptics/binder/string.hpp>

namespace haptics::godot {

String::String(std::string_view utf8)
    : Builtin(Uninitialized{}) {
    internal::api.string_new_with_utf8_chars_and_len2(_native_ptr(), utf8.data(),
                                                      static_cast<int64_t>(utf8.size()));
}

String::String(const StringName& name)
    : Builtin(Uninitialized{}) {
    constexpr int32_t k_from_string_name = 2;
    static const GDExtensionPtrConstructor construct =
        internal::api.variant_get_ptr_constructor(variant_type, k_from_string_name);
    const GDExtensionConstTypePtr args[] = {name._native_ptr()};
    construct(_native_ptr(), args);
}

std::string String::utf8() const {
    const int64_t size = internal::api.string_to_utf8_chars(_native_ptr(), nullptr, 0);
    std::string result(static_cast<std::size_t>(size), '\0');
    internal::api.string_to_utf8_chars(_native_ptr(), result.data(), size);
    return result;
}

String& String::operator+=(const String& other) {
    *this = String(utf8() + other.utf8());
    return *this;
}

StringName::StringName(const char* utf8)
    : Builtin(Uninitialized{}) {
    internal::api.string_name_new_with_utf8_chars(_native_ptr(), utf8);
}

StringName::StringName(const String& text)
    : Builtin(Uninitialized{}) {
    constexpr int32_t k_from_string = 2;
    static const GDExtensionPtrConstructor construct =
        internal::api.variant_get_ptr_constructor(variant_type, k_from_string);
    const GDExtensionConstTypePtr args[] = {text._native_ptr()};
    construct(_native_ptr(), args);
}

namespace internal {

namespace {
StaticName* static_names = nullptr;
} // namespace

StaticName::StaticName(const char* text) {
    api.string_name_new_with_utf8_chars(bytes_, text);
    next_ = static_names;
    static_names = this;
}

void StaticName::release_all() {
    for (StaticName* name = static_names; name != nullptr; name = name->next_) {
        builtin_ops[GDEXTENSION_VARIANT_TYPE_STRING_NAME].destroy(name->bytes_);
    }
    static_names = nullptr;
}

} // namespace internal

} // namespace haptics::godot
