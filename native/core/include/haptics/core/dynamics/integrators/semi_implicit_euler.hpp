#pragma once
/// Semi-implicit (symplectic) Euler: v += h a(t, q, v), q += h v with the new v. Order 1, for y = (q, v).

#include <haptics/core/dynamics/integrators/state_vector.hpp>

namespace haptics {

/// Semi-implicit Euler. The derivative's second half is the acceleration; its first half is not used.
class SemiImplicitEuler {
  public:
    /// Order of the global error.
    static constexpr int k_order = 1;

    /// One step of h (s) from t (s).
    template <class Derivative>
    void step(const Derivative& derivative, double t, double h, StateVector& y) {
        rate_.resize(y.size());
        derivative(t, y, rate_);
        const Eigen::Index half = y.size() / 2;
        y.tail(half) += h * rate_.tail(half);
        y.head(half) += h * y.tail(half);
    }
    /// Forgets what was learnt from earlier steps: call it when the motion is not smooth. Nothing to forget
    /// here.
    void restart() {}

  private:
    StateVector rate_;
};

} // namespace haptics
