#pragma once
// Whether contacts may be stepped with the forces of the start of the step (semi_implicit).
//
// One spring K, B on a mobility w = J D^-1 J' is stable for (h^2 K + 2 h B) w <= 4. Many of them are for the
// largest eigenvalue of M = D^-1 S, S = sum (h^2 K + 2 h B) J'J, which is no larger than sqrt(trace M^2), and
// that no larger than trace M: both bounds are safe, the first at most as many times too strict as the root
// of the number of freedoms, the second is the cheaper one and asked first. Friction of joints is left out:
// its spring is made for the step.

namespace haptics::local {

// of the largest eigenvalue
inline constexpr double k_explicit_limit = 4.0;

// weight of a row in S
inline double explicit_weight(double stiffness, double damping, double dt) {
    return dt * (dt * stiffness + 2.0 * damping);
}

} // namespace haptics::local
