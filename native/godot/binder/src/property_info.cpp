#include <haptics/binder/property_info.hpp>

namespace haptics::godot {

GDExtensionPropertyInfo PropertyInfo::native() {
    return {static_cast<GDExtensionVariantType>(type),
            name._native_ptr(),
            class_name._native_ptr(),
            hint,
            hint_string._native_ptr(),
            usage};
}

} // namespace haptics::godot
