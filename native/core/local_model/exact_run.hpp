#pragma once
// One run of the exact integrator (derivation in exact.cpp).

#include <array>

#include "contact_rules.hpp"
#include "exact.hpp"

namespace haptics::local {

// How the mode of a point or a patch changes, and where in an interval.
enum class ChangeKind { none, open, close, slip, stick };

struct Change {
    ChangeKind kind{ChangeKind::none};
    int index{0};
    double sign{0.0};
    double at{1.0};
};

inline double flow_dot(const FlowVector& a, const FlowVector& b, int n) {
    double sum = 0.0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k)
        sum += a[k] * b[k];
    return sum;
}

class ExactRun {
  public:
    ExactRun(const Model& model, Data& data)
        : model_(model)
        , data_(data)
        , s_(data.system) {}

    void run(const HandInput& hand, const ExactTask& task, ExactMotion& motion);

  private:
    void setup(const HandInput& hand, double left);
    void add_contacts();
    void add_joint_springs();
    void add_coupling(const HandInput& hand, double left);
    void add_row(const FlowVector& direction, double stiffness, double damping, double drive,
                 double displacement);
    void guess_modes();
    void choose_springs();
    [[nodiscard]] bool affordable(double left, double budget, int since_change) const;
    [[nodiscard]] bool stops(const Change& change, const ExactTask& task, double done) const;
    [[nodiscard]] Change first_change();
    void look(Condition& condition, ChangeKind kind, int index, double sign, Change& first) const;
    void look_at_point(int i, Change& first);
    void look_at_patch(int i, Change& first);
    void book_interval();
    void apply(const Change& change);
    // of patch i
    void book_work(int i, const Series& tangent);
    void normal_series(int i, Series& sum, double& scale) const;
    [[nodiscard]] double normal_now(int i) const;
    [[nodiscard]] bool pressed(int i) const;
    void write_back(double done);

    PointRow& point(int i) { return s_.point[static_cast<std::size_t>(i)]; }
    [[nodiscard]] const PointRow& point(int i) const { return s_.point[static_cast<std::size_t>(i)]; }
    PatchRow& patch(int i) { return s_.row[static_cast<std::size_t>(i)]; }
    [[nodiscard]] const PatchRow& patch(int i) const { return s_.row[static_cast<std::size_t>(i)]; }
    FlowRow& row(int i) { return flow_.row[static_cast<std::size_t>(i)]; }
    [[nodiscard]] const FlowRow& row(int i) const { return flow_.row[static_cast<std::size_t>(i)]; }
    // flow rows: points, then patches, then the coupling
    [[nodiscard]] int row_of_patch(int i) const { return s_.points + i; }

    const Model& model_;
    Data& data_;
    ContactSystem& s_;
    Flow flow_;
    // acceleration without springs and without the constant part of sliding friction
    FlowVector free_;
    double spent_{0.0};
    bool pressed_{false};
    // impulse per point and patch
    std::array<double, k_max_exact_points> normal_impulse_;
    std::array<double, k_max_exact_patches> tangent_impulse_;
    // rows whose mode has changed at the present instant
    std::array<bool, k_flow_rows> fresh_;
    // ends of patches without a spring that have closed, see share_out
    std::array<bool, k_max_exact_points> met_{};
};

} // namespace haptics::local
