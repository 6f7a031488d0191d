#pragma once
/// Adams-Bashforth with four rates: y += h (55 f_n - 59 f_{n-1} + 37 f_{n-2} - 9 f_{n-3})/24. Order 4 at one
/// derivative a step; the first three steps are Runge-Kutta 4. Steps have equal length between restarts.

#include <haptics/core/dynamics/integrators/runge_kutta4.hpp>

namespace haptics {

/// Adams-Bashforth, four steps.
class AdamsBashforth4 {
  public:
    /// Order of the global error.
    static constexpr int k_order = 4;

    /// One step of h (s) from t (s).
    template <class Derivative>
    void step(const Derivative& derivative, double t, double h, StateVector& y) {
        StateVector& newest = history_[newest_];
        newest.resize(y.size());
        derivative(t, y, newest);
        if (known_ < 3) {
            ++known_;
            starter_.step(derivative, t, h, y);
        } else {
            const StateVector& one = history_[(newest_ + 3) % 4];
            const StateVector& two = history_[(newest_ + 2) % 4];
            const StateVector& three = history_[(newest_ + 1) % 4];
            y += (h / 24.0) * (55.0 * newest - 59.0 * one + 37.0 * two - 9.0 * three);
        }
        newest_ = (newest_ + 1) % 4;
    }
    /// Forgets the earlier rates: call it when the step length changes or the motion is not smooth.
    void restart() { known_ = 0; }

  private:
    Slots<StateVector, 4> history_;
    int newest_{0};
    int known_{0};
    RungeKutta4 starter_;
};

} // namespace haptics
