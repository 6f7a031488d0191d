#include <haptics/binder/class_db.hpp>

#include <vector>

namespace haptics::godot {

namespace {

struct RegisteredClass {
    StringName name;
    ModuleInitializationLevel level;
};

/// What lives from the first registration to release_all(); never a static object, whose destructor would run
/// too late.
struct Registry {
    std::vector<RegisteredClass> classes;
    std::vector<std::unique_ptr<internal::MethodBind>> methods;
    ModuleInitializationLevel level = MODULE_INITIALIZATION_LEVEL_SCENE;
};

Registry* registry_pointer = nullptr;

Registry& registry() {
    if (registry_pointer == nullptr) {
        registry_pointer = new Registry;
    }
    return *registry_pointer;
}

/// The part after the last "::".
const char* unscoped(const char* name) {
    const std::string_view text(name);
    const std::size_t last = text.rfind("::");
    return last == std::string_view::npos ? name : name + last + 2;
}

// Own objects are freed through free_instance_func, so their binding needs no callback.
constexpr GDExtensionInstanceBindingCallbacks k_own_callbacks = {nullptr, nullptr, nullptr};

} // namespace

void ClassDB::set_level(ModuleInitializationLevel level) {
    registry().level = level;
}

void ClassDB::deinitialize(ModuleInitializationLevel level) {
    std::vector<RegisteredClass>& classes = registry().classes;
    while (!classes.empty() && classes.back().level == level) {
        internal::api.classdb_unregister_extension_class(internal::api.library,
                                                         classes.back().name._native_ptr());
        classes.pop_back();
    }
}

void ClassDB::release_all() {
    delete registry_pointer;
    registry_pointer = nullptr;
}

void ClassDB::register_native(const StringName& name, const StringName& parent,
                              const GDExtensionClassCreationInfo5& info) {
    registry().classes.push_back({name, registry().level});
    internal::api.classdb_register_extension_class5(internal::api.library, name._native_ptr(),
                                                    parent._native_ptr(), &info);
}

void ClassDB::bind(const StringName& class_name, const MethodDefinition& definition,
                   std::unique_ptr<internal::MethodBind> bind, std::vector<Variant> defaults) {
    bind->class_name = class_name;
    bind->name = definition.name;
    bind->defaults = std::move(defaults);
    if (definition.arguments.size() != bind->arguments.size() ||
        bind->defaults.size() > bind->arguments.size()) {
        print_error("Binding " + class_name.utf8() + "::" + definition.name.utf8() + ": it takes " +
                    std::to_string(bind->arguments.size()) + " arguments, but D_METHOD names " +
                    std::to_string(definition.arguments.size()) + " and " +
                    std::to_string(bind->defaults.size()) + " have defaults.");
        return;
    }
    std::vector<GDExtensionPropertyInfo> arguments;
    for (std::size_t i = 0; i < bind->arguments.size(); ++i) {
        bind->arguments[i].name = definition.arguments[i];
        arguments.push_back(bind->arguments[i].native());
    }
    std::vector<GDExtensionVariantPtr> default_pointers;
    for (Variant& value : bind->defaults) {
        default_pointers.push_back(value._native_ptr());
    }
    GDExtensionPropertyInfo return_info = bind->return_value.native();

    GDExtensionClassMethodInfo info = {};
    info.name = bind->name._native_ptr();
    info.method_userdata = bind.get();
    info.call_func = bind->call;
    info.ptrcall_func = bind->ptrcall;
    info.method_flags = bind->flags;
    info.has_return_value = bind->has_return;
    info.return_value_info = &return_info;
    info.return_value_metadata = bind->return_metadata;
    info.argument_count = static_cast<uint32_t>(arguments.size());
    info.arguments_info = arguments.data();
    info.arguments_metadata = bind->argument_metadata.data();
    info.default_argument_count = static_cast<uint32_t>(default_pointers.size());
    info.default_arguments = default_pointers.data();
    internal::api.classdb_register_extension_class_method(internal::api.library, class_name._native_ptr(),
                                                          &info);
    registry().methods.push_back(std::move(bind));
}

void ClassDB::add_property(const StringName& class_name, PropertyInfo info, const StringName& setter,
                           const StringName& getter) {
    const GDExtensionPropertyInfo native = info.native();
    internal::api.classdb_register_extension_class_property(
        internal::api.library, class_name._native_ptr(), &native, setter._native_ptr(), getter._native_ptr());
}

void ClassDB::add_property_group(const StringName& class_name, const String& name, const String& prefix) {
    internal::api.classdb_register_extension_class_property_group(
        internal::api.library, class_name._native_ptr(), name._native_ptr(), prefix._native_ptr());
}

void ClassDB::add_property_subgroup(const StringName& class_name, const String& name, const String& prefix) {
    internal::api.classdb_register_extension_class_property_subgroup(
        internal::api.library, class_name._native_ptr(), name._native_ptr(), prefix._native_ptr());
}

void ClassDB::add_signal(const StringName& class_name, MethodInfo signal) {
    std::vector<GDExtensionPropertyInfo> arguments;
    for (PropertyInfo& argument : signal.arguments) {
        arguments.push_back(argument.native());
    }
    internal::api.classdb_register_extension_class_signal(internal::api.library, class_name._native_ptr(),
                                                          signal.name._native_ptr(), arguments.data(),
                                                          static_cast<int64_t>(arguments.size()));
}

void ClassDB::bind_integer_constant(const StringName& class_name, const char* enum_name, const char* constant,
                                    int64_t value, bool is_bitfield) {
    const StringName enumeration(unscoped(enum_name));
    const StringName name(unscoped(constant));
    internal::api.classdb_register_extension_class_integer_constant(
        internal::api.library, class_name._native_ptr(), enumeration._native_ptr(), name._native_ptr(), value,
        is_bitfield);
}

void ClassDB::attach(GDExtensionObjectPtr object, const StringName& class_name, Wrapped* instance) {
    instance->_owner = object;
    internal::api.object_set_instance(object, class_name._native_ptr(), instance);
    internal::api.object_set_instance_binding(object, internal::api.library, instance, &k_own_callbacks);
}

void ClassDB::send_postinitialize(GDExtensionObjectPtr object) {
    constexpr GDExtensionInt k_hash_notification = 4023243586;
    static const GDExtensionMethodBindPtr bind = internal::api.classdb_get_method_bind(
        Object::get_class_static()._native_ptr(), SNAME("notification")._native_ptr(), k_hash_notification);
    const int64_t what = Object::NOTIFICATION_POSTINITIALIZE;
    const GDExtensionBool reversed = 0;
    const GDExtensionConstTypePtr args[] = {&what, &reversed};
    internal::api.object_method_bind_ptrcall(bind, object, args, nullptr);
}

} // namespace haptics::godot
