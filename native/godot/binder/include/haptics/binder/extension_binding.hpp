/// The entry of the library: called from its one exported function.
#pragma once

#include <haptics/binder/class_db.hpp>

#include <functional>

namespace haptics::godot {

/// Runs `callback` once, before anything of the library is taken down: at the end of the process and at every
/// hot reload. All classes and objects are still there. The place to stop threads and to let hardware go; the
/// engine unmaps our code right afterwards. Last added runs first.
void on_unload(std::function<void()> callback);

class GDExtensionBinding {
  public:
    using Callback = void (*)(ModuleInitializationLevel);

    /// Collects what the library does at each level; init() hands it to the engine.
    class InitObject {
      public:
        InitObject(GDExtensionInterfaceGetProcAddress get_proc_address, GDExtensionClassLibraryPtr library,
                   GDExtensionInitialization* initialization)
            : get_proc_address_(get_proc_address)
            , library_(library)
            , initialization_(initialization) {}

        /// Called with each level, going up.
        void register_initializer(Callback callback) const;
        /// Called with each level, going down, before the classes of that level go.
        void register_terminator(Callback callback) const;
        /// Hot reload needs SCENE (the default).
        void set_minimum_library_initialization_level(ModuleInitializationLevel level) const;
        /// The entry function's result: false when this engine cannot run the library.
        GDExtensionBool init() const;

      private:
        GDExtensionInterfaceGetProcAddress get_proc_address_;
        GDExtensionClassLibraryPtr library_;
        GDExtensionInitialization* initialization_;
    };
};

} // namespace haptics::godot
