#include <haptics/binder/interface.hpp>
#include <haptics/binder/main_loop.hpp>
#include <haptics/binder/print.hpp>

#include <algorithm>
#include <exception>
#include <vector>

namespace haptics::godot {

namespace {

struct Entry {
    MainLoopCallbacks::Id id;
    MainLoopCallbacks::Callback callback;
};

struct Lists {
    std::vector<Entry> startup;
    std::vector<Entry> frame;
    std::vector<Entry> shutdown;
};

Lists* lists_pointer = nullptr;

Lists& lists() {
    if (lists_pointer == nullptr) {
        lists_pointer = new Lists;
    }
    return *lists_pointer;
}

MainLoopCallbacks::Id add(std::vector<Entry>& list, MainLoopCallbacks::Callback callback) {
    static MainLoopCallbacks::Id last = 0;
    list.push_back({++last, std::move(callback)});
    return last;
}

void run(const std::vector<Entry>& list) {
    // by index and by copy: a callback may add and remove
    for (std::size_t i = 0; i < list.size(); ++i) {
        // it may be removed meanwhile
        // NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
        const Entry entry = list[i];
        try {
            entry.callback();
        } catch (const std::exception& exception) {
            print_error(std::string("A main loop callback failed: ") + exception.what());
        } catch (...) {
            print_error("A main loop callback failed.");
        }
        if (i < list.size() && list[i].id != entry.id) {
            --i;
        }
    }
}

} // namespace

MainLoopCallbacks::Id MainLoopCallbacks::add_startup(Callback callback) {
    return add(lists().startup, std::move(callback));
}

MainLoopCallbacks::Id MainLoopCallbacks::add_frame(Callback callback) {
    return add(lists().frame, std::move(callback));
}

MainLoopCallbacks::Id MainLoopCallbacks::add_shutdown(Callback callback) {
    return add(lists().shutdown, std::move(callback));
}

void MainLoopCallbacks::remove(Id id) {
    for (std::vector<Entry>* list : {&lists().startup, &lists().frame, &lists().shutdown}) {
        std::erase_if(*list, [id](const Entry& entry) { return entry.id == id; });
    }
}

void MainLoopCallbacks::connect() {
    const GDExtensionMainLoopCallbacks callbacks = {
        [] { run(lists().startup); },
        [] { run(lists().shutdown); },
        [] { run(lists().frame); },
    };
    internal::api.register_main_loop_callbacks(internal::api.library, &callbacks);
}

void MainLoopCallbacks::release_all() {
    delete lists_pointer;
    lists_pointer = nullptr;
}

} // namespace haptics::godot
