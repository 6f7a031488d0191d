#include <haptics/binder/interface.hpp>

#include <cstdio>

namespace haptics::godot::internal {

Interface api;

namespace {

template <class Function>
bool load(GDExtensionInterfaceGetProcAddress get_proc_address, const char* name, Function& function) {
    function = reinterpret_cast<Function>(get_proc_address(name));
    if (function == nullptr) {
        std::fprintf(stderr, "ERROR: this engine has no function '%s': Godot 4.6 or newer is needed.\n",
                     name);
        return false;
    }
    return true;
}

} // namespace

bool load_interface(GDExtensionInterfaceGetProcAddress get_proc_address, GDExtensionClassLibraryPtr library) {
    api = {};
    api.library = library;
    bool whole = true;
#define HAPTICS_BINDER_LOAD(name, type) whole = load(get_proc_address, #name, api.name) && whole;
    HAPTICS_BINDER_INTERFACE(HAPTICS_BINDER_LOAD)
#undef HAPTICS_BINDER_LOAD
    return whole;
}

} // namespace haptics::godot::internal
