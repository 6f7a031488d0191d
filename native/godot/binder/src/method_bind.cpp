#include <haptics/binder/method_bind.hpp>

namespace haptics::godot::internal {

StringName enum_class_name(const char* cpp_name) {
    // keep the last two scopes: Class::Enum
    std::string_view text(cpp_name);
    const std::size_t last = text.rfind("::");
    if (last == std::string_view::npos) {
        return StringName(cpp_name);
    }
    const std::size_t before = last == 0 ? std::string_view::npos : text.rfind("::", last - 1);
    const std::size_t start = before == std::string_view::npos ? 0 : before + 2;
    const std::string dotted =
        std::string(text.substr(start, last - start)) + "." + std::string(text.substr(last + 2));
    return StringName(dotted.c_str());
}

bool MethodBind::gather(const GDExtensionConstVariantPtr* given, int64_t count, const Variant** all,
                        GDExtensionCallError* error) const {
    const auto wanted = static_cast<int64_t>(arguments.size());
    const auto optional = static_cast<int64_t>(defaults.size());
    if (count > wanted) {
        *error = {GDEXTENSION_CALL_ERROR_TOO_MANY_ARGUMENTS, 0, static_cast<int32_t>(wanted)};
        return false;
    }
    if (count < wanted - optional) {
        *error = {GDEXTENSION_CALL_ERROR_TOO_FEW_ARGUMENTS, 0, static_cast<int32_t>(wanted - optional)};
        return false;
    }
    for (int64_t i = 0; i < count; ++i) {
        all[i] = static_cast<const Variant*>(given[i]);
        const auto type = static_cast<GDExtensionVariantType>(arguments[static_cast<std::size_t>(i)].type);
        const GDExtensionVariantType from = api.variant_get_type(given[i]);
        if (type != GDEXTENSION_VARIANT_TYPE_NIL && from != type &&
            api.variant_can_convert_strict(from, type) == 0) {
            *error = {GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT, static_cast<int32_t>(i),
                      static_cast<int32_t>(type)};
            return false;
        }
    }
    for (int64_t i = count; i < wanted; ++i) {
        all[i] = &defaults[static_cast<std::size_t>(i - (wanted - optional))];
    }
    return true;
}

void MethodBind::report(const char* what) const {
    const std::string function = class_name.utf8() + "::" + name.utf8();
    const std::string message = function + " failed: " + what;
    api.print_error(message.c_str(), function.c_str(), "native", 0, 0);
}

} // namespace haptics::godot::internal
