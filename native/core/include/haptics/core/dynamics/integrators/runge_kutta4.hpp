#pragma once
/// The classical Runge-Kutta method: k1 = f(t, y), k2 = f(t + h/2, y + h k1/2), k3 = f(t + h/2, y + h k2/2),
/// k4 = f(t + h, y + h k3), y += h (k1 + 2 k2 + 2 k3 + k4)/6. Order 4.

#include <haptics/core/dynamics/integrators/state_vector.hpp>

namespace haptics {

/// Classical Runge-Kutta.
class RungeKutta4 {
  public:
    /// Order of the global error.
    static constexpr int k_order = 4;

    /// One step of h (s) from t (s).
    template <class Derivative>
    void step(const Derivative& derivative, double t, double h, StateVector& y) {
        rate_.resize(y.size());
        derivative(t, y, rate_);
        sum_ = rate_;
        stage_ = y + (0.5 * h) * rate_;
        derivative(t + 0.5 * h, stage_, rate_);
        sum_ += 2.0 * rate_;
        stage_ = y + (0.5 * h) * rate_;
        derivative(t + 0.5 * h, stage_, rate_);
        sum_ += 2.0 * rate_;
        stage_ = y + h * rate_;
        derivative(t + h, stage_, rate_);
        sum_ += rate_;
        y += (h / 6.0) * sum_;
    }
    /// Nothing to forget.
    void restart() {}

  private:
    StateVector rate_, sum_, stage_;
};

} // namespace haptics
