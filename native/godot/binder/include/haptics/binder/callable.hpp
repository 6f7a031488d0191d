/// A function value of the engine.
#pragma once

#include <haptics/binder/variant.hpp>

namespace haptics::godot {

class Object;

/// A method of an object, or a lambda that a script handed over.
class Callable : public internal::Builtin<GDEXTENSION_VARIANT_TYPE_CALLABLE, 16> {
  public:
    Callable() = default;
    Callable(const Object* object, const StringName& method);

    bool is_null() const { return *this == Callable(); }
    /// Calls it now; errors are printed and give null.
    template <class... Args>
    Variant call(const Args&... args) const {
        return Variant(*this).call(SNAME("call"), args...);
    }
    /// Calls it at the end of the frame.
    template <class... Args>
    void call_deferred(const Args&... args) const {
        Variant(*this).call(SNAME("call_deferred"), args...);
    }
};

} // namespace haptics::godot
