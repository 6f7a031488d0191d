#pragma once
// Whether contacts may be stepped with the forces of the start of the step (semi_implicit).
//
// One spring K, B on a mobility w = J D^-1 J' is stable for (h^2 K + 2 h B) w <= 4. Many of them are for the
// largest eigenvalue of D^-1 sum (h^2 K + 2 h B) J'J, which the trace sum (h^2 K + 2 h B) w never falls short
// of: the bound is safe, and at most as many times too strict as there are rows that press. Friction of
// joints is left out: its spring is made for the step.

namespace haptics::local {

class ExplicitStep {
  public:
    explicit ExplicitStep(double dt)
        : dt_(dt) {}

    void add(double stiffness, double damping, double mobility) {
        trace_ += dt_ * (dt_ * stiffness + 2.0 * damping) * mobility;
    }
    // false for what is not a number
    [[nodiscard]] bool is_stable() const { return trace_ <= 4.0; }

  private:
    double dt_;
    double trace_{0.0};
};

} // namespace haptics::local
