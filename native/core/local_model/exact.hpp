#pragma once
// The exact integrator: linear contact modes between events.

#include "flow.hpp"
#include "internal.hpp"

namespace haptics::local {

inline constexpr int k_max_exact_points = 32;
inline constexpr int k_max_exact_patches = 32;

// Where a run ends before its time, so that the caller can look for contacts again or resolve a collision.
enum class ExactStop {
    never,
    hits,    // a point that may collide has closed faster than the collision speed
    changes, // a point has closed or opened
};

struct ExactTask {
    // how far to go, and from now to the end of the haptic step, s
    double dt{0.0};
    double left{0.0};
    ExactStop stop{ExactStop::never};
    // changes within this time do not end the run, s
    double too_early{0.0};
    // products that the run may take
    double budget{0.0};
};

// What a run did.
struct ExactMotion {
    // s; less than asked when it stopped, or where it does not apply
    double done{0.0};
    bool stopped{false};
    // there were contact forces
    bool pressed{false};
    // products that it took
    double spent{0.0};
    // displacement of the freedoms over `done`, and its integral over time
    FreedomVector moved;
    FreedomVector moved_time;
};

// What a run changes in the system, to run again from the same start.
class ExactStart {
  public:
    explicit ExactStart(const ContactSystem& s);
    void restore(ContactSystem& s) const;

  private:
    FreedomVector velocity_;
    std::array<double, k_max_points> gap_;
    std::array<double, k_max_rows> spring_;
    std::array<bool, k_max_rows> was_sliding_;
};

// Advances velocity, gaps, friction springs and modes of `data.system`; forces become means over `done`.
// Poses stay.
void solve_exactly(const Model& model, Data& data, const HandInput& hand, const ExactTask& task,
                   ExactMotion& motion);

} // namespace haptics::local
