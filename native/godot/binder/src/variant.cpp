#include <haptics/binder/print.hpp>
#include <haptics/binder/variant.hpp>

#include <array>
#include <vector>

namespace haptics::godot {

Variant::Variant(const char* utf8)
    : Variant(String(utf8)) {}

bool Variant::operator==(const char* utf8) const {
    return *this == Variant(utf8);
}

Variant& Variant::operator=(const Variant& other) {
    if (this != &other) {
        internal::api.variant_destroy(bytes_);
        internal::api.variant_new_copy(bytes_, other.bytes_);
    }
    return *this;
}

Variant& Variant::operator=(Variant&& other) noexcept {
    if (this != &other) {
        internal::api.variant_destroy(bytes_);
        steal(other);
    }
    return *this;
}

// A variant may lie anywhere: it keeps no pointer into itself.
void Variant::steal(Variant& other) {
    for (std::size_t i = 0; i < sizeof(bytes_); ++i) {
        bytes_[i] = other.bytes_[i];
    }
    internal::api.variant_new_nil(other.bytes_);
}

String Variant::stringify() const {
    String text;
    internal::api.variant_stringify(bytes_, text._native_ptr());
    return text;
}

bool Variant::operator==(const Variant& other) const {
    GDExtensionBool valid = 0;
    Variant result;
    internal::api.variant_evaluate(GDEXTENSION_VARIANT_OP_EQUAL, bytes_, other.bytes_, result.bytes_, &valid);
    return valid != 0 && result.booleanize();
}

Variant Variant::call_array(const StringName& method, const Variant* args, int64_t count) {
    std::vector<GDExtensionConstVariantPtr> pointers;
    for (int64_t i = 0; i < count; ++i) {
        pointers.push_back(args[i]._native_ptr());
    }
    Variant result;
    GDExtensionCallError error = {};
    internal::api.variant_call(bytes_, method._native_ptr(), pointers.data(), count, result.bytes_, &error);
    if (error.error != GDEXTENSION_CALL_OK) {
        constexpr std::array<const char*, 7> k_reasons = {"",
                                                          "no such method",
                                                          "wrong argument type",
                                                          "too many arguments",
                                                          "too few arguments",
                                                          "no instance",
                                                          "not a const method"};
        print_error("Calling '" + method.utf8() + "' on " + stringify().utf8() +
                    " failed: " + k_reasons[static_cast<std::size_t>(error.error)] + " (argument " +
                    std::to_string(error.argument) + ").");
        return Variant();
    }
    return result;
}

String Variant::get_type_name(Type type) {
    String name;
    internal::api.variant_get_type_name(static_cast<GDExtensionVariantType>(type), name._native_ptr());
    return name;
}

} // namespace haptics::godot
