#pragma once

#include <haptics/binder/godot.hpp>

namespace haptics {

/// The singleton through which scripts reach everything native, as Godot's own servers are reached: a plain
/// Object.
class HapticServer : public godot::Object {
    GDCLASS(HapticServer, godot::Object)

  public:
    HapticServer();
    ~HapticServer() override;

    /// Null before scene level and after it. After a hot reload it is null until the engine has made the new
    /// C++ side.
    static HapticServer* get_singleton();

    /// Version of the library, as "0.1.0".
    godot::String get_version() const;
    /// What was built and what runs it: version, build_type, compiler, architecture, godot_version.
    godot::Dictionary get_build_info() const;

  protected:
    static void _bind_methods();

  private:
    static inline HapticServer* singleton_ = nullptr;
};

} // namespace haptics
