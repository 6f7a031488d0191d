/// The engine's 2D transform.
#pragma once

#include <haptics/binder/vector2.hpp>

namespace haptics::godot {

/// Columns x, y and origin: a point p goes to x*p.x + y*p.y + origin.
struct Transform2D {
    Vector2 columns[3] = {{1, 0}, {0, 1}, {0, 0}};

    constexpr Transform2D() = default;
    constexpr Transform2D(Vector2 x, Vector2 y, Vector2 origin)
        : columns{x, y, origin} {}

    constexpr bool operator==(const Transform2D&) const = default;
    constexpr const Vector2& get_origin() const { return columns[2]; }
    constexpr void set_origin(Vector2 origin) { columns[2] = origin; }
    constexpr Vector2 xform(Vector2 p) const { return columns[0] * p.x + columns[1] * p.y + columns[2]; }
};

} // namespace haptics::godot
