#include "probe_server.hpp"

#include <chrono>
#include <stdexcept>

namespace haptics {

using namespace godot;

void ProbeServer::start() {
    static std::thread* thread = nullptr;
    beating = true;
    thread = new std::thread([] {
        while (beating.load()) {
            ++beats;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    });
    on_unload([] { print_line("unload: thread stopped, server ", instance != nullptr ? "alive" : "gone"); });
    on_unload([] {
        beating = false;
        thread->join();
        delete thread;
    });
    MainLoopCallbacks::add_startup([] { ++startups; });
    static MainLoopCallbacks::Id once = 0;
    once = MainLoopCallbacks::add_frame([] { MainLoopCallbacks::remove(once); });
    MainLoopCallbacks::add_frame([] { ++frames; });
}

void ProbeServer::_bind_methods() {
    ClassDB::bind_method(D_METHOD("get_generation"), &ProbeServer::get_generation);
    ClassDB::bind_method(D_METHOD("get_frames"), &ProbeServer::get_frames);
    ClassDB::bind_method(D_METHOD("get_startups"), &ProbeServer::get_startups);
    ClassDB::bind_method(D_METHOD("get_beats"), &ProbeServer::get_beats);
    ClassDB::bind_method(D_METHOD("is_beating"), &ProbeServer::is_beating);
}

} // namespace haptics
