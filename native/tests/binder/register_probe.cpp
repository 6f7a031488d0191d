#include "binder_probe.hpp"
#include "probe_server.hpp"

using namespace haptics;
using namespace haptics::godot;

namespace {

void initialize(ModuleInitializationLevel level) {
    if (level == MODULE_INITIALIZATION_LEVEL_SCENE) {
        GDREGISTER_CLASS(BinderProbeCounted);
        GDREGISTER_CLASS(BinderProbe);
        GDREGISTER_ABSTRACT_CLASS(ProbeServer);
        register_engine_singleton<ProbeServer>();
        ProbeServer::start();
    }
    print_line("initialize ", level);
}

void terminate(ModuleInitializationLevel level) {
    print_line("terminate ", level);
    if (level == MODULE_INITIALIZATION_LEVEL_SCENE) {
        unregister_engine_singleton<ProbeServer>();
    }
}

} // namespace

extern "C" __attribute__((visibility("default"))) GDExtensionBool
binder_probe_init(GDExtensionInterfaceGetProcAddress get_proc_address, GDExtensionClassLibraryPtr library,
                  GDExtensionInitialization* initialization) {
    const GDExtensionBinding::InitObject init(get_proc_address, library, initialization);
    init.register_initializer(&initialize);
    init.register_terminator(&terminate);
    init.set_minimum_library_initialization_level(MODULE_INITIALIZATION_LEVEL_SCENE);
    return init.init();
}
