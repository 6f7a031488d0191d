/// Work on the main thread, once a frame.
#pragma once

#include <cstdint>
#include <functional>

namespace haptics::godot {

/// Callbacks around the engine's main loop. All run on the main thread; C++ exceptions become engine errors.
/// All are forgotten when the library goes. Add and remove on the main thread only; a callback may remove
/// itself.
class MainLoopCallbacks {
  public:
    using Id = int64_t;
    using Callback = std::function<void()>;

    /// Once, when the engine is up (at once after a hot reload).
    static Id add_startup(Callback callback);
    /// Every process frame, after all `_process`; in the editor too.
    static Id add_frame(Callback callback);
    /// Once, while the engine is still whole.
    static Id add_shutdown(Callback callback);
    static void remove(Id id);

    /// Used by GDExtensionBinding.
    static void connect();
    static void release_all();
};

} // namespace haptics::godot
