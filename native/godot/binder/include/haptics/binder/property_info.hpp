/// Descriptions of properties, signals and methods.
#pragma once

#include <haptics/binder/variant.hpp>

#include <vector>

namespace haptics::godot {

/// How the inspector edits a property; the engine's values.
enum PropertyHint : uint32_t {
    PROPERTY_HINT_NONE = 0,
    PROPERTY_HINT_RANGE = 1,
    PROPERTY_HINT_ENUM = 2,
    PROPERTY_HINT_EXP_EASING = 4,
    PROPERTY_HINT_FLAGS = 6,
    PROPERTY_HINT_FILE = 13,
    PROPERTY_HINT_DIR = 14,
    PROPERTY_HINT_RESOURCE_TYPE = 17,
    PROPERTY_HINT_MULTILINE_TEXT = 18,
    PROPERTY_HINT_PLACEHOLDER_TEXT = 20,
    PROPERTY_HINT_TYPE_STRING = 23,
    PROPERTY_HINT_ARRAY_TYPE = 31,
    PROPERTY_HINT_NODE_TYPE = 34,
};

/// Where a property is stored and shown; the engine's bits.
enum PropertyUsageFlags : uint32_t {
    PROPERTY_USAGE_NONE = 0,
    PROPERTY_USAGE_STORAGE = 1U << 1U,
    PROPERTY_USAGE_EDITOR = 1U << 2U,
    PROPERTY_USAGE_CLASS_IS_ENUM = 1U << 16U,
    PROPERTY_USAGE_NIL_IS_VARIANT = 1U << 17U,
    PROPERTY_USAGE_READ_ONLY = 1U << 28U,
    PROPERTY_USAGE_DEFAULT = PROPERTY_USAGE_STORAGE | PROPERTY_USAGE_EDITOR,
};

/// One property, argument or return value.
struct PropertyInfo {
    Variant::Type type = Variant::NIL;
    StringName name;
    StringName class_name;
    uint32_t hint = PROPERTY_HINT_NONE;
    String hint_string;
    uint32_t usage = PROPERTY_USAGE_DEFAULT;

    PropertyInfo() = default;
    PropertyInfo(Variant::Type type_value, const StringName& name_value,
                 PropertyHint hint_value = PROPERTY_HINT_NONE, const String& hint_text = String(),
                 uint32_t usage_value = PROPERTY_USAGE_DEFAULT,
                 const StringName& class_name_value = StringName())
        : type(type_value)
        , name(name_value)
        , class_name(class_name_value)
        , hint(hint_value)
        , hint_string(hint_text)
        , usage(usage_value) {}

    /// The same for the engine; points into this object.
    GDExtensionPropertyInfo native();
};

/// A signal's name with its arguments.
struct MethodInfo {
    StringName name;
    std::vector<PropertyInfo> arguments;

    MethodInfo(const StringName& name_value)
        : name(name_value) {}
    template <class... Args>
    MethodInfo(const StringName& name_value, const Args&... args)
        : name(name_value)
        , arguments{args...} {}
};

} // namespace haptics::godot
