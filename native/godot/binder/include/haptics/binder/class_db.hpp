/// Registration of classes, and what the engine needs to make and free their objects.
#pragma once

#include <haptics/binder/method_bind.hpp>
#include <haptics/binder/print.hpp>

namespace haptics::godot {

/// The order in which the engine starts; it ends in reverse.
enum ModuleInitializationLevel {
    MODULE_INITIALIZATION_LEVEL_CORE = GDEXTENSION_INITIALIZATION_CORE,
    MODULE_INITIALIZATION_LEVEL_SERVERS = GDEXTENSION_INITIALIZATION_SERVERS,
    MODULE_INITIALIZATION_LEVEL_SCENE = GDEXTENSION_INITIALIZATION_SCENE,
    MODULE_INITIALIZATION_LEVEL_EDITOR = GDEXTENSION_INITIALIZATION_EDITOR,
};

/// Opens a bound class: GDCLASS(Probe, Object), then `static void _bind_methods();`. What follows is private.
#define GDCLASS(m_class, m_inherits)                                                                         \
    friend class ::haptics::godot::ClassDB;                                                                  \
                                                                                                             \
  public:                                                                                                    \
    using self_type = m_class;                                                                               \
    using parent_type = m_inherits;                                                                          \
    static const ::haptics::godot::StringName& get_class_static() {                                          \
        return SNAME(#m_class);                                                                              \
    }                                                                                                        \
    static const ::haptics::godot::StringName& engine_class_static() {                                       \
        return m_inherits::engine_class_static();                                                            \
    }                                                                                                        \
                                                                                                             \
  private:

/// Registers classes and their members with the engine. Members are bound inside `_bind_methods` of their
/// class.
class ClassDB {
  public:
    /// A class that scripts can make with new().
    template <class T>
    static void register_class() {
        register_typed<T>(false);
    }
    /// A class that only C++ makes.
    template <class T>
    static void register_abstract_class() {
        register_typed<T>(true);
    }

    /// bind_method(D_METHOD("name", "argument"), &Class::method, DEFVAL(default of the last argument))
    template <class Function, class... Defaults>
    static void bind_method(const MethodDefinition& definition, Function function,
                            const Defaults&... defaults) {
        bind(class_of(function), definition, internal::create_method_bind(function), {Variant(defaults)...});
    }
    /// A static method of class `class_name`.
    template <class Function, class... Defaults>
    static void bind_static_method(const StringName& class_name, const MethodDefinition& definition,
                                   Function function, const Defaults&... defaults) {
        bind(class_name, definition, internal::create_method_bind(function), {Variant(defaults)...});
    }
    static void add_property(const StringName& class_name, PropertyInfo info, const StringName& setter,
                             const StringName& getter);
    static void add_property_group(const StringName& class_name, const String& name, const String& prefix);
    static void add_property_subgroup(const StringName& class_name, const String& name, const String& prefix);
    static void add_signal(const StringName& class_name, MethodInfo signal);
    /// `enum_name` may be empty (a plain constant); both names may carry C++ scopes, which are dropped.
    static void bind_integer_constant(const StringName& class_name, const char* enum_name,
                                      const char* constant, int64_t value, bool is_bitfield = false);
    template <class Enum>
    static void bind_enum_constant(const StringName& class_name, const char* constant, Enum value,
                                   bool is_bitfield) {
        bind_integer_constant(class_name, EnumName<Enum>::value, constant, static_cast<int64_t>(value),
                              is_bitfield);
    }

    /// Used by GDExtensionBinding: classes belong to the level at which they were registered.
    static void set_level(ModuleInitializationLevel level);
    /// Unregisters the classes of a level, last first.
    static void deinitialize(ModuleInitializationLevel level);
    /// Frees what described the methods; the engine must know none of the classes any more.
    static void release_all();

    /// A new object of this library's class T; its engine object is made too. Null after an exception.
    template <class T>
    static T* make_instance(bool notify_postinitialize) {
        T* instance = construct<T>();
        if (instance != nullptr) {
            const GDExtensionObjectPtr object =
                internal::api.classdb_construct_object2(T::engine_class_static()._native_ptr());
            attach(object, T::get_class_static(), instance);
            if (notify_postinitialize) {
                send_postinitialize(object);
            }
        }
        return instance;
    }

  private:
    template <class Class, class Return, class... Params>
    static const StringName& class_of(Return (Class::*)(Params...)) {
        return Class::get_class_static();
    }
    template <class Class, class Return, class... Params>
    static const StringName& class_of(Return (Class::*)(Params...) const) {
        return Class::get_class_static();
    }

    template <class T>
    static T* construct() {
        try {
            return new T;
        } catch (const std::exception& exception) {
            print_error("A constructor of " + T::get_class_static().utf8() + " failed: " + exception.what());
        } catch (...) {
            print_error("A constructor of " + T::get_class_static().utf8() + " failed.");
        }
        return nullptr;
    }

    // the engine's callbacks; `userdata` is unused, the class is in the template

    template <class T>
    static GDExtensionObjectPtr on_create(void*, GDExtensionBool notify_postinitialize) {
        T* instance = make_instance<T>(notify_postinitialize != 0);
        return instance == nullptr ? nullptr : instance->_owner;
    }
    /// After a reload: a new C++ side for an object that lives on.
    template <class T>
    static GDExtensionClassInstancePtr on_recreate(void*, GDExtensionObjectPtr object) {
        T* instance = construct<T>();
        if (instance == nullptr) {
            return nullptr;
        }
        attach(object, T::get_class_static(), instance);
        return static_cast<Wrapped*>(instance);
    }
    static void on_free(void*, GDExtensionClassInstancePtr instance) {
        delete static_cast<Wrapped*>(instance);
    }

    template <class T>
    static void on_notification(GDExtensionClassInstancePtr instance, int32_t what, GDExtensionBool) {
        if constexpr (requires(T* self) { self->_notification(what); }) {
            static_cast<T*>(static_cast<Wrapped*>(instance))->_notification(what);
        }
    }
    template <class T>
    static void on_to_string(GDExtensionClassInstancePtr instance, GDExtensionBool* is_valid,
                             GDExtensionStringPtr out) {
        if constexpr (requires(const T* self) { self->_to_string(); }) {
            *static_cast<String*>(out) = static_cast<const T*>(static_cast<Wrapped*>(instance))->_to_string();
            *is_valid = 1;
        }
    }

    template <class T>
    static void register_typed(bool is_abstract) {
        static_assert(std::same_as<typename T::self_type, T>, "GDCLASS names another class");
        GDExtensionClassCreationInfo5 info = {};
        info.is_abstract = is_abstract;
        info.is_exposed = 1;
        info.notification_func = &on_notification<T>;
        info.to_string_func = &on_to_string<T>;
        if constexpr (std::is_default_constructible_v<T>) {
            info.create_instance_func = &on_create<T>;
            info.recreate_instance_func = &on_recreate<T>;
        }
        info.free_instance_func = &on_free;
        register_native(T::get_class_static(), T::parent_type::get_class_static(), info);
        T::_bind_methods();
    }

    static void register_native(const StringName& name, const StringName& parent,
                                const GDExtensionClassCreationInfo5& info);
    static void bind(const StringName& class_name, const MethodDefinition& definition,
                     std::unique_ptr<internal::MethodBind> bind, std::vector<Variant> defaults);
    static void attach(GDExtensionObjectPtr object, const StringName& class_name, Wrapped* instance);
    static void send_postinitialize(GDExtensionObjectPtr object);
};

namespace internal {

template <class T>
T* make_instance() {
    return ClassDB::make_instance<T>(true);
}

} // namespace internal

#define GDREGISTER_CLASS(m_class) ::haptics::godot::ClassDB::register_class<m_class>()
#define GDREGISTER_ABSTRACT_CLASS(m_class) ::haptics::godot::ClassDB::register_abstract_class<m_class>()

/// A new object of a bound class; memdelete() it, or hold it in a Ref when it is reference counted.
#define memnew(m_class) ::haptics::godot::internal::make_instance<m_class>()

#define ADD_PROPERTY(m_info, m_setter, m_getter)                                                             \
    ::haptics::godot::ClassDB::add_property(get_class_static(), m_info, m_setter, m_getter)
#define ADD_GROUP(m_name, m_prefix)                                                                          \
    ::haptics::godot::ClassDB::add_property_group(get_class_static(), m_name, m_prefix)
#define ADD_SUBGROUP(m_name, m_prefix)                                                                       \
    ::haptics::godot::ClassDB::add_property_subgroup(get_class_static(), m_name, m_prefix)
#define ADD_SIGNAL(m_signal) ::haptics::godot::ClassDB::add_signal(get_class_static(), m_signal)

#define BIND_CONSTANT(m_constant)                                                                            \
    ::haptics::godot::ClassDB::bind_integer_constant(get_class_static(), "", #m_constant, m_constant)
#define BIND_ENUM_CONSTANT(m_constant)                                                                       \
    ::haptics::godot::ClassDB::bind_enum_constant(get_class_static(), #m_constant, m_constant, false)
#define BIND_BITFIELD_FLAG(m_constant)                                                                       \
    ::haptics::godot::ClassDB::bind_enum_constant(get_class_static(), #m_constant, m_constant, true)

} // namespace haptics::godot
