#include "register_types.hpp"

#include <haptics/binder/godot.hpp>
#include <haptics/classes/haptic_server.hpp>

#include "class_reference.hpp"

namespace haptics {

using namespace godot;

void initialize_haptics(ModuleInitializationLevel level) {
    if (level == MODULE_INITIALIZATION_LEVEL_SCENE) {
        GDREGISTER_ABSTRACT_CLASS(HapticServer);
        register_engine_singleton<HapticServer>();
        on_unload([] { HapticServer::stop_all(); });
    }
    if (level == MODULE_INITIALIZATION_LEVEL_EDITOR) {
        for (const std::string_view page : class_reference_pages()) {
            load_editor_help(page);
        }
    }
}

void terminate_haptics(ModuleInitializationLevel level) {
    if (level == MODULE_INITIALIZATION_LEVEL_SCENE) {
        unregister_engine_singleton<HapticServer>();
    }
}

} // namespace haptics

/// The one symbol that the engine looks up; addons/haptics/haptics.gdextension names it.
extern "C" __attribute__((visibility("default"))) GDExtensionBool
haptics_library_init(GDExtensionInterfaceGetProcAddress get_proc_address, GDExtensionClassLibraryPtr library,
                     GDExtensionInitialization* initialization) {
    using namespace haptics::godot;
    const GDExtensionBinding::InitObject init(get_proc_address, library, initialization);
    init.register_initializer(&haptics::initialize_haptics);
    init.register_terminator(&haptics::terminate_haptics);
    init.set_minimum_library_initialization_level(MODULE_INITIALIZATION_LEVEL_SCENE);
    return init.init();
}
