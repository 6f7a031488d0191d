/// Objects of the engine and of this library.
#pragma once

#include <haptics/binder/array.hpp>
#include <haptics/binder/callable.hpp>
#include <haptics/binder/dictionary.hpp>
#include <haptics/binder/packed_array.hpp>
#include <haptics/binder/variant.hpp>

namespace haptics::godot {

/// The C++ side of one engine object. Objects made by others get a plain Object or RefCounted on first sight,
/// which the engine frees with them.
class Wrapped {
  public:
    Wrapped() = default;
    Wrapped(const Wrapped&) = delete;
    Wrapped& operator=(const Wrapped&) = delete;
    virtual ~Wrapped() = default;

    /// The engine's object; null inside constructors of this library's classes (see Object::_notification).
    GDExtensionObjectPtr _owner = nullptr;
};

/// Base of every bound class. A class that defines `void _notification(int what)` is told about everything
/// that happens to the object; NOTIFICATION_POSTINITIALIZE comes first, when the object may be used.
class Object : public Wrapped {
  public:
    static constexpr int NOTIFICATION_POSTINITIALIZE = 0;
    static constexpr int NOTIFICATION_PREDELETE = 1;
    /// After a hot reload, when the stored properties are back.
    static constexpr int NOTIFICATION_EXTENSION_RELOADED = 2;

    static const StringName& get_class_static() { return SNAME("Object"); }
    /// The nearest class of the engine, from which the object itself is made.
    static const StringName& engine_class_static() { return get_class_static(); }

    /// Unique for the life of the process; 0 before the object is attached.
    uint64_t get_instance_id() const {
        return _owner == nullptr ? 0 : internal::api.object_get_instance_id(_owner);
    }
    String get_class() const { return call_const(SNAME("get_class")).to<String>(); }

    /// Emits on the calling thread; use it from the main thread only.
    template <class... Args>
    void emit_signal(const StringName& signal, const Args&... args) {
        const Variant values[] = {Variant(signal), Variant(args)...};
        emit_signal_array(values, static_cast<int64_t>(sizeof...(Args) + 1));
    }
    /// Calls any method by name; errors are printed and give null.
    template <class... Args>
    Variant call(const StringName& method, const Args&... args) {
        return call_const(method, args...);
    }

    /// The object as a T, null when it is none.
    template <class T>
    static T* cast_to(Object* object) {
        return dynamic_cast<T*>(object);
    }

  private:
    void emit_signal_array(const Variant* args, int64_t count);
    template <class... Args>
    Variant call_const(const StringName& method, const Args&... args) const;
};

namespace internal {

/// The C++ side of an engine object, made when there is none yet; null for null.
Wrapped* wrapped_of(GDExtensionObjectPtr object);

/// Destroys the engine object, which destroys the C++ side.
void destroy_object(Wrapped* wrapped);

/// The engine object in a Variant, null when it is gone already or when the Variant holds none.
GDExtensionObjectPtr live_object(const Variant& variant);

} // namespace internal

template <class T>
    requires std::derived_from<T, Object>
struct TypeBinding<T*> {
    using Class = T;
    static constexpr GDExtensionVariantType variant_type = GDEXTENSION_VARIANT_TYPE_OBJECT;
    static constexpr GDExtensionClassMethodArgumentMetadata metadata =
        GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;

    static T* from_engine(GDExtensionObjectPtr object) {
        return dynamic_cast<T*>(internal::wrapped_of(object));
    }
    static T* from_ptr(const void* from) {
        return from == nullptr ? nullptr : from_engine(*static_cast<const GDExtensionObjectPtr*>(from));
    }
    static void to_ptr(void* to, const T* value) {
        *static_cast<GDExtensionObjectPtr*>(to) = value == nullptr ? nullptr : value->_owner;
    }
    static T* from_variant(const Variant& from) { return from_engine(internal::live_object(from)); }
    static void to_variant(void* uninitialized, const T* value) {
        GDExtensionObjectPtr object = value == nullptr ? nullptr : value->_owner;
        internal::builtin_ops[variant_type].to_variant(uninitialized, &object);
    }
};

template <class... Args>
Variant Object::call_const(const StringName& method, const Args&... args) const {
    return Variant(const_cast<Object*>(this)).call(method, args...);
}

/// Destroys an object that is not reference counted.
template <class T>
void memdelete(T* object) {
    internal::destroy_object(object);
}

} // namespace haptics::godot
