#include <haptics/binder/object.hpp>
#include <haptics/binder/ref_counted.hpp>

#include <vector>

namespace haptics::godot {

namespace {

// Hashes of method signatures, from the engine's own API description.
constexpr GDExtensionInt k_hash_emit_signal = 4047867050;
constexpr GDExtensionInt k_hash_bool = 2240911060;      // init_ref, reference, unreference
constexpr GDExtensionInt k_hash_ref_count = 3905245786; // get_reference_count

GDExtensionMethodBindPtr method_bind(const StringName& class_name, const char* method, GDExtensionInt hash) {
    const StringName name(method);
    return internal::api.classdb_get_method_bind(class_name._native_ptr(), name._native_ptr(), hash);
}

bool call_bool(GDExtensionMethodBindPtr bind, GDExtensionObjectPtr object) {
    GDExtensionBool result = 0;
    internal::api.object_method_bind_ptrcall(bind, object, nullptr, &result);
    return result != 0;
}

} // namespace

void Object::emit_signal_array(const Variant* args, int64_t count) {
    static const GDExtensionMethodBindPtr bind =
        method_bind(Object::get_class_static(), "emit_signal", k_hash_emit_signal);
    std::vector<GDExtensionConstVariantPtr> pointers;
    for (int64_t i = 0; i < count; ++i) {
        pointers.push_back(args[i]._native_ptr());
    }
    Variant result;
    GDExtensionCallError error = {};
    internal::api.object_method_bind_call(bind, _owner, pointers.data(), count, result._native_ptr(), &error);
}

Callable::Callable(const Object* object, const StringName& method)
    : Builtin(Uninitialized{}) {
    constexpr int32_t k_from_object_and_method = 2;
    static const GDExtensionPtrConstructor construct =
        internal::api.variant_get_ptr_constructor(variant_type, k_from_object_and_method);
    const GDExtensionObjectPtr owner = object == nullptr ? nullptr : object->_owner;
    const GDExtensionConstTypePtr args[] = {&owner, method._native_ptr()};
    construct(_native_ptr(), args);
}

bool RefCounted::init_ref() {
    static const GDExtensionMethodBindPtr bind =
        method_bind(RefCounted::get_class_static(), "init_ref", k_hash_bool);
    return call_bool(bind, _owner);
}

bool RefCounted::reference() {
    static const GDExtensionMethodBindPtr bind =
        method_bind(RefCounted::get_class_static(), "reference", k_hash_bool);
    return call_bool(bind, _owner);
}

bool RefCounted::unreference() {
    static const GDExtensionMethodBindPtr bind =
        method_bind(RefCounted::get_class_static(), "unreference", k_hash_bool);
    return call_bool(bind, _owner);
}

int32_t RefCounted::get_reference_count() const {
    static const GDExtensionMethodBindPtr bind =
        method_bind(RefCounted::get_class_static(), "get_reference_count", k_hash_ref_count);
    int64_t count = 0;
    internal::api.object_method_bind_ptrcall(bind, _owner, nullptr, &count);
    return static_cast<int32_t>(count);
}

namespace internal {

namespace {

// A plain wrapper for an object that is not of this library's classes.
void* create_wrapper(void*, void* object) {
    static void* const ref_counted_tag =
        api.classdb_get_class_tag(RefCounted::get_class_static()._native_ptr());
    Object* wrapper = nullptr;
    if (api.object_cast_to(object, ref_counted_tag) != nullptr) {
        wrapper = new RefCounted;
    } else {
        wrapper = new Object;
    }
    wrapper->_owner = object;
    return static_cast<Wrapped*>(wrapper);
}

void free_wrapper(void*, void*, void* wrapper) {
    delete static_cast<Wrapped*>(wrapper);
}

constexpr GDExtensionInstanceBindingCallbacks k_wrapper_callbacks = {&create_wrapper, &free_wrapper, nullptr};

} // namespace

Wrapped* wrapped_of(GDExtensionObjectPtr object) {
    if (object == nullptr) {
        return nullptr;
    }
    return static_cast<Wrapped*>(api.object_get_instance_binding(object, api.library, &k_wrapper_callbacks));
}

void destroy_object(Wrapped* wrapped) {
    if (wrapped != nullptr) {
        api.object_destroy(wrapped->_owner);
    }
}

GDExtensionObjectPtr live_object(const Variant& variant) {
    const GDObjectInstanceID id = api.variant_get_object_instance_id(variant._native_ptr());
    return id == 0 ? nullptr : api.object_get_instance_from_id(id);
}

} // namespace internal

} // namespace haptics::godot
