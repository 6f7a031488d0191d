#include <haptics/binder/engine.hpp>

namespace haptics::godot {

Engine* Engine::get_singleton() {
    static Engine engine;
    return &engine;
}

Variant Engine::call(const char* method, const Variant* args, int64_t count) const {
    GDExtensionObjectPtr object = internal::api.global_get_singleton(SNAME("Engine")._native_ptr());
    Variant self;
    internal::builtin_ops[GDEXTENSION_VARIANT_TYPE_OBJECT].to_variant(self._native_ptr(), &object);
    return self.call_array(StringName(method), args, count);
}

String Engine::get_version_string() const {
    GDExtensionGodotVersion2 version = {};
    internal::api.get_godot_version2(&version);
    return version.string;
}

bool Engine::is_editor_hint() const {
    return call("is_editor_hint", nullptr, 0);
}

bool Engine::has_main_loop() const {
    return call("get_main_loop", nullptr, 0).to<Object*>() != nullptr;
}

bool Engine::has_singleton(const StringName& name) const {
    const Variant args[] = {name};
    return call("has_singleton", args, 1);
}

Object* Engine::get_singleton(const StringName& name) const {
    const Variant args[] = {name};
    return call("get_singleton", args, 1);
}

void Engine::register_singleton(const StringName& name, Object* instance) {
    const Variant args[] = {name, instance};
    call("register_singleton", args, 2);
}

void Engine::unregister_singleton(const StringName& name) {
    const Variant args[] = {name};
    call("unregister_singleton", args, 1);
}

bool internal::singleton_lives_on(const StringName& name) {
    // the engine deletes its main loop before it takes extensions down, and keeps it through a reload
    return !Engine::get_singleton()->has_singleton(name) || Engine::get_singleton()->has_main_loop();
}

} // namespace haptics::godot
