#pragma once
/// The eighth-order method of Dormand and Prince with twelve stages: Hairer, Norsett, Wanner, Solving
/// Ordinary Differential Equations I (1993), program DOP853. Fixed step: the embedded error estimates are
/// left out.
///     k_i = f(t + c_i h, y + h sum_{j<i} a_ij k_j),   y += h sum_i b_i k_i.

#include <haptics/core/dynamics/integrators/state_vector.hpp>

#include <utility>

namespace haptics {
namespace detail {

inline constexpr int k_dop853_stages = 12;
inline constexpr double k_dop853_c[12] = {0.0,
                                          0.05260015195876773,
                                          0.0789002279381516,
                                          0.1183503419072274,
                                          0.2816496580927726,
                                          0.3333333333333333,
                                          0.25,
                                          0.3076923076923077,
                                          0.6512820512820513,
                                          0.6,
                                          0.8571428571428571,
                                          1.0};
inline constexpr double k_dop853_a[12][11] = {
    {},
    {0.05260015195876773},
    {0.0197250569845379, 0.0591751709536137},
    {0.02958758547680685, 0.0, 0.08876275643042054},
    {0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792},
    {0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242},
    {0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125},
    {0.03709200011850479, 0.0, 0.0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
     0.008273789163814023},
    {0.6241109587160757, 0.0, 0.0, -3.3608926294469414, -0.868219346841726, 27.59209969944671,
     20.154067550477894, -43.48988418106996},
    {0.47766253643826434, 0.0, 0.0, -2.4881146199716677, -0.590290826836843, 21.230051448181193,
     15.279233632882423, -33.28821096898486, -0.020331201708508627},
    {-0.9371424300859873, 0.0, 0.0, 5.186372428844064, 1.0914373489967295, -8.149787010746927,
     -18.52006565999696, 22.739487099350505, 2.4936055526796523, -3.0467644718982196},
    {2.273310147516538, 0.0, 0.0, -10.53449546673725, -2.0008720582248625, -17.9589318631188,
     27.94888452941996, -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636},
};
inline constexpr double k_dop853_b[12] = {0.054293734116568765,
                                          0.0,
                                          0.0,
                                          0.0,
                                          0.0,
                                          4.450312892752409,
                                          1.8915178993145003,
                                          -5.801203960010585,
                                          0.3111643669578199,
                                          -0.1521609496625161,
                                          0.20136540080403034,
                                          0.04471061572777259};

} // namespace detail

/// Dormand-Prince, order 8.
class DormandPrince8 {
  public:
    /// Order of the global error.
    static constexpr int k_order = 8;

    /// One step of h (s) from t (s).
    template <class Derivative>
    void step(const Derivative& derivative, double t, double h, StateVector& y) {
        stage_.resize(y.size());
        take_stages(derivative, t, h, y, std::make_integer_sequence<int, detail::k_dop853_stages>{});
        combine<detail::k_dop853_stages>(h, y, y, std::make_integer_sequence<int, detail::k_dop853_stages>{});
    }
    /// Nothing to forget.
    void restart() {}

  private:
    template <class Derivative, int... Stage>
    void take_stages(const Derivative& derivative, double t, double h, const StateVector& y,
                     std::integer_sequence<int, Stage...> /*stages*/) {
        (take_stage<Stage>(derivative, t, h, y), ...);
    }
    template <int Stage, class Derivative>
    void take_stage(const Derivative& derivative, double t, double h, const StateVector& y) {
        rate_[Stage].resize(y.size());
        if constexpr (Stage > 0)
            combine<Stage>(h, y, stage_, std::make_integer_sequence<int, Stage>{});
        derivative(t + detail::k_dop853_c[Stage] * h, Stage > 0 ? stage_ : y, rate_[Stage]);
    }
    // a row of the table, its last row b; written out, for the table's zeros and without a loop over rates
    template <int Row, int... J>
    void combine(double h, const StateVector& y, StateVector& result,
                 std::integer_sequence<int, J...> /*columns*/) const {
        const double* const rate[] = {rate_[J].data()...};
        const double weight[] = {h * weight_of(Row, J)...};
        const Eigen::Index size = y.size();
        for (Eigen::Index k = 0; k < size; ++k) {
            double sum = y[k];
            ((weight_of(Row, J) != 0.0 ? void(sum += weight[J] * rate[J][k]) : void()), ...);
            result[k] = sum;
        }
    }
    static constexpr double weight_of(int row, int column) {
        return row == detail::k_dop853_stages ? detail::k_dop853_b[column] : detail::k_dop853_a[row][column];
    }

    Slots<StateVector, detail::k_dop853_stages> rate_;
    StateVector stage_;
};

} // namespace haptics
