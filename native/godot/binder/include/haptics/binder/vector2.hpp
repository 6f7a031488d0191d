/// Plain geometric values, laid out as the engine lays them out (single precision).
#pragma once

namespace haptics::godot {

/// The engine's scalar inside vectors; the official builds use float.
using real_t = float;

/// A 2D vector.
struct Vector2 {
    real_t x = 0;
    real_t y = 0;

    constexpr Vector2() = default;
    constexpr Vector2(real_t x_value, real_t y_value)
        : x(x_value)
        , y(y_value) {}

    constexpr bool operator==(const Vector2&) const = default;
    constexpr Vector2 operator+(Vector2 o) const { return {x + o.x, y + o.y}; }
    constexpr Vector2 operator-(Vector2 o) const { return {x - o.x, y - o.y}; }
    constexpr Vector2 operator*(real_t s) const { return {x * s, y * s}; }
    constexpr Vector2 operator-() const { return {-x, -y}; }
};

} // namespace haptics::godot
