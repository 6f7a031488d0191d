/// The engine's registry of singletons.
#pragma once

#include <haptics/binder/class_db.hpp>

namespace haptics::godot {

/// The engine's `Engine` object, as far as it is needed.
class Engine {
  public:
    static Engine* get_singleton();

    /// The running engine, as "Godot Engine v4.6.3.stable...".
    String get_version_string() const;
    /// True in the editor process.
    bool is_editor_hint() const;
    /// False while the engine starts and once it is ending.
    bool has_main_loop() const;
    bool has_singleton(const StringName& name) const;
    /// Prints an engine error and gives null when there is none.
    Object* get_singleton(const StringName& name) const;
    void register_singleton(const StringName& name, Object* instance);
    void unregister_singleton(const StringName& name);

  private:
    Variant call(const char* method, const Variant* args, int64_t count) const;
};

namespace internal {
bool singleton_lives_on(const StringName& name);
} // namespace internal

/// Makes the one T and registers it under the name of its class. After a hot reload the engine still holds
/// the object of before, which then gets its new C++ side from the engine itself: scripts that keep it stay
/// right. But the engine restores none of its stored properties, as it does for all other objects. T keeps
/// its own instance pointer: set in the constructor, cleared in the destructor.
template <class T>
void register_engine_singleton() {
    if (!Engine::get_singleton()->has_singleton(T::get_class_static())) {
        Engine::get_singleton()->register_singleton(T::get_class_static(), memnew(T));
    }
}

/// The counterpart, called at the same level: destroys the object unless this is a hot reload.
template <class T>
void unregister_engine_singleton() {
    const StringName& name = T::get_class_static();
    if (internal::singleton_lives_on(name)) {
        return;
    }
    Object* instance = Engine::get_singleton()->get_singleton(name);
    Engine::get_singleton()->unregister_singleton(name);
    memdelete(instance);
}

} // namespace haptics::godot
