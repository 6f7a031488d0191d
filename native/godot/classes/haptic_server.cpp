#include <haptics/classes/haptic_server.hpp>

namespace haptics {

using namespace godot;

namespace {

#if defined(__clang__)
constexpr const char* k_compiler = "clang " __clang_version__;
#else
constexpr const char* k_compiler = "g++ " __VERSION__;
#endif

#if defined(__x86_64__)
constexpr const char* k_architecture = "x86_64";
#elif defined(__aarch64__)
constexpr const char* k_architecture = "arm64";
#else
constexpr const char* k_architecture = "unknown";
#endif

} // namespace

HapticServer::HapticServer() {
    singleton_ = this;
}

HapticServer::~HapticServer() {
    singleton_ = nullptr;
}

HapticServer* HapticServer::get_singleton() {
    return singleton_;
}

String HapticServer::get_version() const {
    return HAPTICS_VERSION;
}

Dictionary HapticServer::get_build_info() const {
    Dictionary info;
    info["version"] = HAPTICS_VERSION;
    info["build_type"] = HAPTICS_BUILD_TYPE;
    info["compiler"] = k_compiler;
    info["architecture"] = k_architecture;
    info["godot_version"] = Engine::get_singleton()->get_version_string();
    return info;
}

void HapticServer::_bind_methods() {
    ClassDB::bind_method(D_METHOD("get_version"), &HapticServer::get_version);
    ClassDB::bind_method(D_METHOD("get_build_info"), &HapticServer::get_build_info);
}

} // namespace haptics
