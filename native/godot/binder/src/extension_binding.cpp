#include <haptics/binder/extension_binding.hpp>
#include <haptics/binder/main_loop.hpp>

namespace haptics::godot {

namespace {

GDExtensionBinding::Callback initializer = nullptr;
GDExtensionBinding::Callback terminator = nullptr;
GDExtensionInitializationLevel minimum_level = GDEXTENSION_INITIALIZATION_SCENE;
std::vector<std::function<void()>>* unload_callbacks = nullptr;

void run_unload_callbacks() {
    if (unload_callbacks == nullptr) {
        return;
    }
    while (!unload_callbacks->empty()) {
        const std::function<void()> callback = std::move(unload_callbacks->back());
        unload_callbacks->pop_back();
        try {
            callback();
        } catch (const std::exception& exception) {
            print_error(std::string("An unload callback failed: ") + exception.what());
        } catch (...) {
            print_error("An unload callback failed.");
        }
    }
    delete unload_callbacks;
    unload_callbacks = nullptr;
}

void initialize(void*, GDExtensionInitializationLevel level) {
    const auto module_level = static_cast<ModuleInitializationLevel>(level);
    ClassDB::set_level(module_level);
    if (initializer != nullptr && level >= minimum_level) {
        initializer(module_level);
    }
}

void deinitialize(void*, GDExtensionInitializationLevel level) {
    const auto module_level = static_cast<ModuleInitializationLevel>(level);
    if (level < minimum_level) {
        return;
    }
    run_unload_callbacks();
    if (terminator != nullptr) {
        terminator(module_level);
    }
    ClassDB::deinitialize(module_level);
    if (level == minimum_level) {
        MainLoopCallbacks::release_all();
        ClassDB::release_all();
        internal::StaticName::release_all();
    }
}

} // namespace

void on_unload(std::function<void()> callback) {
    if (unload_callbacks == nullptr) {
        unload_callbacks = new std::vector<std::function<void()>>;
    }
    unload_callbacks->push_back(std::move(callback));
}

void GDExtensionBinding::InitObject::register_initializer(Callback callback) const {
    initializer = callback;
}

void GDExtensionBinding::InitObject::register_terminator(Callback callback) const {
    terminator = callback;
}

void GDExtensionBinding::InitObject::set_minimum_library_initialization_level(
    ModuleInitializationLevel level) const {
    minimum_level = static_cast<GDExtensionInitializationLevel>(level);
}

GDExtensionBool GDExtensionBinding::InitObject::init() const {
    if (!internal::load_interface(get_proc_address_, library_)) {
        return 0;
    }
    internal::load_builtin_ops();
    MainLoopCallbacks::connect();
    initialization_->minimum_initialization_level = minimum_level;
    initialization_->userdata = nullptr;
    initialization_->initialize = &initialize;
    initialization_->deinitialize = &deinitialize;
    return 1;
}

} // namespace haptics::godot
