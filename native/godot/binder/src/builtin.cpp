#include <haptics/binder/builtin.hpp>
#include <haptics/binder/string.hpp>

namespace haptics::godot::internal {

BuiltinOpsTable builtin_ops;

namespace {

// Hashes of method signatures, from the engine's own API description; they never change for a released
// method.
constexpr GDExtensionInt k_hash_size = 3173160232;
constexpr GDExtensionInt k_hash_resize = 848867239;
constexpr GDExtensionInt k_hash_clear = 3218959716;

// Text is measured by length(), containers by size().
const char* size_method(GDExtensionVariantType type) {
    switch (type) {
    case GDEXTENSION_VARIANT_TYPE_STRING:
        return "length";
    case GDEXTENSION_VARIANT_TYPE_ARRAY:
    case GDEXTENSION_VARIANT_TYPE_DICTIONARY:
        return "size";
    default:
        return type >= GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY ? "size" : nullptr;
    }
}

GDExtensionPtrBuiltInMethod method(GDExtensionVariantType type, const char* name, GDExtensionInt hash) {
    const StringName interned(name);
    return api.variant_get_ptr_builtin_method(type, interned._native_ptr(), hash);
}

void load_ops(GDExtensionVariantType type) {
    BuiltinOps& ops = builtin_ops[type];
    ops.construct_default = api.variant_get_ptr_constructor(type, 0);
    ops.construct_copy = api.variant_get_ptr_constructor(type, 1);
    ops.destroy = api.variant_get_ptr_destructor(type);
    ops.equal = api.variant_get_ptr_operator_evaluator(GDEXTENSION_VARIANT_OP_EQUAL, type, type);
    ops.to_variant = api.get_variant_from_type_constructor(type);
    ops.from_variant = api.get_variant_to_type_constructor(type);
}

void load_methods(GDExtensionVariantType type) {
    BuiltinOps& ops = builtin_ops[type];
    if (const char* name = size_method(type)) {
        ops.size = method(type, name, k_hash_size);
        if (type != GDEXTENSION_VARIANT_TYPE_STRING) {
            ops.clear = method(type, "clear", k_hash_clear);
            if (type != GDEXTENSION_VARIANT_TYPE_DICTIONARY) {
                ops.resize = method(type, "resize", k_hash_resize);
            }
        }
    }
}

} // namespace

void load_builtin_ops() {
    constexpr GDExtensionVariantType k_types[] = {
        GDEXTENSION_VARIANT_TYPE_BOOL,
        GDEXTENSION_VARIANT_TYPE_INT,
        GDEXTENSION_VARIANT_TYPE_FLOAT,
        GDEXTENSION_VARIANT_TYPE_STRING,
        GDEXTENSION_VARIANT_TYPE_VECTOR2,
        GDEXTENSION_VARIANT_TYPE_TRANSFORM2D,
        GDEXTENSION_VARIANT_TYPE_STRING_NAME,
        GDEXTENSION_VARIANT_TYPE_OBJECT,
        GDEXTENSION_VARIANT_TYPE_CALLABLE,
        GDEXTENSION_VARIANT_TYPE_DICTIONARY,
        GDEXTENSION_VARIANT_TYPE_ARRAY,
        GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY,
        GDEXTENSION_VARIANT_TYPE_PACKED_INT32_ARRAY,
        GDEXTENSION_VARIANT_TYPE_PACKED_INT64_ARRAY,
        GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY,
        GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT64_ARRAY,
        GDEXTENSION_VARIANT_TYPE_PACKED_STRING_ARRAY,
        GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR2_ARRAY,
    };
    for (const GDExtensionVariantType type : k_types) {
        load_ops(type);
    }
    // looked up by name, so only once names can be made
    for (const GDExtensionVariantType type : k_types) {
        load_methods(type);
    }
}

} // namespace haptics::godot::internal
