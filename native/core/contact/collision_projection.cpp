/// Projection onto opening normals in the metric of D.
///
///     minimize E(p) = p^T G p / 2 + p^T v   over p >= 0,   G = J D^-1 J^T, v = J q'
///
/// is the dual of min |x - q'|_D over J x >= 0. Its optimality conditions are 0 <= p, 0 <= v + G p, p (v + G
/// p) = 0, and E(p) is exactly the kinetic energy that the impulses p add. The active-set method of Lawson
/// and Hanson (1974) walks from p = 0 through points p >= 0 with E strictly falling, so that it cannot cycle,
/// ends at the optimum, and wherever it is stopped the impulses so far neither pull nor add energy.
///
/// A normal that depends on the active ones opens a direction of constant G p along which E falls linearly.
/// Either an active impulse runs out along it (that contact leaves), or E has no lower bound: then no motion
/// opens all these contacts at once, which walls at rest cannot cause (x = 0 would do). Such a contact is
/// excluded.

#include <cmath>

#include "collision_solver.hpp"

namespace haptics::detail {
namespace {

constexpr int k_stride = k_max_collision_contacts;
/// A dependent contact that closes slower than this does so by rounding.
constexpr double k_closes = 1e-9;

/// The active contacts. Their rows a = J L, with D^-1 = L L^T, are kept as A = R Q: Q orthonormal, R lower
/// triangular. G of the active contacts is R R^T, but taking R from it would square the condition of A.
struct ActiveSet {
    double* r{nullptr};
    double* q{nullptr};
    int width{0};
    int count{0};
    int contact[k_max_collision_contacts];

    /// Forward substitution R y = b in place.
    void solve_lower(double* b) const {
        for (int i = 0; i < count; ++i) {
            const double* row = r + i * k_stride;
            double sum = b[i];
            for (int j = 0; j < i; ++j)
                sum -= row[j] * b[j];
            b[i] = sum / row[i];
        }
    }
    /// Backward substitution R^T y = b in place.
    void solve_upper(double* b) const {
        for (int i = count - 1; i >= 0; --i) {
            b[i] /= r[i * k_stride + i];
            for (int j = 0; j < i; ++j)
                b[j] -= r[i * k_stride + j] * b[i];
        }
    }
    /// Splits a row into its parts along Q (y) and across (rest, width long); returns the square of the
    /// latter.
    double split(const double* row, double* y, double* rest) const {
        for (int k = 0; k < width; ++k)
            rest[k] = row[k];
        for (int j = 0; j < count; ++j)
            y[j] = 0.0;
        // twice is enough (Kahan): the second pass takes out what rounding left in
        for (int pass = 0; pass < 2; ++pass) {
            for (int j = 0; j < count; ++j) {
                const double* axis = q + j * width;
                double along = 0.0;
                for (int k = 0; k < width; ++k)
                    along += axis[k] * rest[k];
                for (int k = 0; k < width; ++k)
                    rest[k] -= along * axis[k];
                y[j] += along;
            }
        }
        double square = 0.0;
        for (int k = 0; k < width; ++k)
            square += rest[k] * rest[k];
        return square;
    }
    /// Appends a contact that was split; `square` > 0 belongs to `rest`.
    void append(int added, const double* y, const double* rest, double square) {
        double* row = r + count * k_stride;
        const double length = std::sqrt(square);
        for (int j = 0; j < count; ++j)
            row[j] = y[j];
        row[count] = length;
        for (int k = 0; k < width; ++k)
            q[count * width + k] = rest[k] / length;
        contact[count++] = added;
    }
    /// Takes one contact out; Givens rotations bring R back to triangular form.
    void remove(int place) {
        for (int i = place; i + 1 < count; ++i) {
            contact[i] = contact[i + 1];
            double* row = r + i * k_stride;
            const double* below = row + k_stride;
            for (int j = 0; j <= i + 1; ++j)
                row[j] = below[j];
        }
        --count;
        for (int i = place; i < count; ++i) {
            const double a = r[i * k_stride + i];
            const double b = r[i * k_stride + i + 1];
            const double length = std::sqrt(a * a + b * b);
            const double c = a / length;
            const double s = b / length;
            r[i * k_stride + i] = length;
            for (int k = i + 1; k < count; ++k)
                turn(r[k * k_stride + i], r[k * k_stride + i + 1], c, s);
            for (int k = 0; k < width; ++k)
                turn(q[i * width + k], q[(i + 1) * width + k], c, s);
        }
    }
    static void turn(double& x, double& y, double c, double s) {
        const double old = x;
        x = c * old + s * y;
        y = c * y - s * old;
    }
};

/// Two contacts: the four cases of the complementarity one by one. False where they are (nearly) dependent.
bool project_two(const ImpulseSpace& space, const double* v, double* p) {
    const double a = space.row(0)[0];
    const double b = space.row(0)[1];
    const double d = space.row(1)[1];
    const double det = a * d - b * b;
    if (det <= (space.walls_move ? 0.1 : k_dependent) * a * d)
        return false;
    p[0] = 0.0;
    p[1] = 0.0;
    if (v[0] >= -k_still && v[1] >= -k_still)
        return true;
    const double first = -v[0] / a;
    if (first > 0.0 && v[1] + b * first >= 0.0) {
        p[0] = first;
        return true;
    }
    const double second = -v[1] / d;
    if (second > 0.0 && v[0] + b * second >= 0.0) {
        p[1] = second;
        return true;
    }
    p[0] = std::fmax(0.0, (b * v[1] - d * v[0]) / det);
    p[1] = std::fmax(0.0, (b * v[0] - a * v[1]) / det);
    return true;
}

/// The walk from p = 0 to the optimum.
class Walk {
  public:
    Walk(ImpulseSpace& space, const double* velocity, double* impulse, CollisionWorkspace& workspace,
         SolverReport& report)
        : space_(space)
        , velocity_(velocity)
        , impulse_(impulse)
        , report_(report) {
        active_.r = workspace.factor;
        active_.q = workspace.axes;
        active_.width = space.freedoms;
        for (int i = 0; i < space.contacts; ++i) {
            impulse[i] = 0.0;
            asleep_[i] = space.excluded[i];
            is_active_[i] = false;
            now_[i] = velocity[i];
        }
    }

    void run() {
        const int bound = 6 * space_.contacts + 16;
        for (int iteration = 0; iteration < bound; ++iteration) {
            const int worst = fastest_closing();
            if (worst < 0)
                return;
            ++report_.iterations;
            if (space_.walls_move)
                remember();
            if (!admit(worst))
                continue;
            descend(worst);
            if (space_.walls_move && is_runaway())
                squeeze_out(worst);
            update_velocities();
        }
        report_.fell_back = fastest_closing() >= 0;
    }

  private:
    ImpulseSpace& space_;
    const double* velocity_;
    double* impulse_;
    SolverReport& report_;
    ActiveSet active_;
    /// Closes by rounding only, or cannot be opened: not asked again.
    bool asleep_[k_max_collision_contacts];
    bool is_active_[k_max_collision_contacts];
    /// Velocities after the impulses so far.
    double now_[k_max_collision_contacts];
    /// Where the walk stood before the last contact was admitted.
    int remembered_count_{0};
    int remembered_contact_[k_max_collision_contacts];
    double remembered_impulse_[k_max_collision_contacts];

    [[nodiscard]] int fastest_closing() const {
        int worst = -1;
        double least = -k_still;
        for (int i = 0; i < space_.contacts; ++i) {
            if (!asleep_[i] && !is_active_[i] && now_[i] < least) {
                least = now_[i];
                worst = i;
            }
        }
        return worst;
    }

    void leave(int place) {
        const int contact = active_.contact[place];
        impulse_[contact] = 0.0;
        is_active_[contact] = false;
        active_.remove(place);
    }

    /// Makes a contact active; false when it cannot be or need not be.
    bool admit(int contact) {
        double y[k_max_collision_contacts];
        double rest[k_max_collision_freedoms];
        double square = active_.split(space_.whitened_row(contact), y, rest);
        if (square <= k_dependent) {
            asleep_[contact] = true;
            if (now_[contact] > -k_closes)
                return false;
            // slide along the direction of constant G p until an active impulse runs out
            active_.solve_upper(y);
            int blocking = -1;
            double reach = 0.0;
            for (int j = 0; j < active_.count; ++j) {
                const double p = impulse_[active_.contact[j]];
                if (y[j] > 1e-9 && (blocking < 0 || p < reach * y[j])) {
                    reach = p / y[j];
                    blocking = j;
                }
            }
            if (blocking < 0) {
                exclude(contact);
                return false;
            }
            for (int j = 0; j < active_.count; ++j) {
                double& p = impulse_[active_.contact[j]];
                p = std::fmax(0.0, p - reach * y[j]);
            }
            leave(blocking);
            square = active_.split(space_.whitened_row(contact), y, rest);
            if (square <= 0.0)
                return false;
            impulse_[contact] = reach;
            asleep_[contact] = false;
        }
        active_.append(contact, y, rest, square);
        is_active_[contact] = true;
        return true;
    }

    /// Goes to the lowest point of E over the active impulses; those that would pull leave.
    void descend(int admitted) {
        while (active_.count > 0) {
            double target[k_max_collision_contacts];
            for (int j = 0; j < active_.count; ++j)
                target[j] = -velocity_[active_.contact[j]];
            active_.solve_lower(target);
            active_.solve_upper(target);
            double step = 1.0;
            int blocking = -1;
            for (int j = 0; j < active_.count; ++j) {
                const double p = impulse_[active_.contact[j]];
                if (target[j] < 0.0 && p < step * (p - target[j])) {
                    step = p / (p - target[j]);
                    blocking = j;
                }
            }
            for (int j = 0; j < active_.count; ++j) {
                double& p = impulse_[active_.contact[j]];
                p = std::fmax(0.0, p + step * (target[j] - p));
            }
            if (blocking < 0)
                return;
            ++report_.iterations;
            // what was just admitted can only leave by rounding
            if (active_.contact[blocking] == admitted)
                asleep_[admitted] = true;
            leave(blocking);
        }
    }

    /// From the motion, not from G p: large impulses that nearly cancel (a wedge) would leave no digits.
    void update_velocities() {
        double y[k_max_collision_contacts];
        for (int j = 0; j < active_.count; ++j)
            y[j] = -velocity_[active_.contact[j]];
        active_.solve_lower(y);
        double change[k_max_collision_freedoms];
        for (int k = 0; k < space_.freedoms; ++k)
            change[k] = 0.0;
        for (int j = 0; j < active_.count; ++j)
            for (int k = 0; k < space_.freedoms; ++k)
                change[k] += y[j] * active_.q[j * space_.freedoms + k];
        for (int i = 0; i < space_.contacts; ++i) {
            const double* row = space_.whitened_row(i);
            now_[i] = velocity_[i];
            for (int k = 0; k < space_.freedoms; ++k)
                now_[i] += row[k] * change[k];
        }
    }

    void exclude(int contact) {
        asleep_[contact] = true;
        if (!space_.walls_move)
            return;
        space_.excluded[contact] = true;
        ++report_.squeezed;
    }

    void remember() {
        remembered_count_ = active_.count;
        for (int j = 0; j < active_.count; ++j) {
            remembered_contact_[j] = active_.contact[j];
            remembered_impulse_[j] = impulse_[active_.contact[j]];
        }
    }

    [[nodiscard]] bool is_runaway() const {
        for (int j = 0; j < active_.count; ++j) {
            if (impulse_[active_.contact[j]] > k_jammed)
                return true;
        }
        return false;
    }

    /// Goes back to before a contact was admitted, and leaves it out for good.
    void squeeze_out(int contact) {
        while (active_.count > 0)
            leave(active_.count - 1);
        for (int j = 0; j < remembered_count_; ++j) {
            double y[k_max_collision_contacts];
            double rest[k_max_collision_freedoms];
            const int old = remembered_contact_[j];
            const double square = active_.split(space_.whitened_row(old), y, rest);
            if (square <= 0.0)
                continue;
            active_.append(old, y, rest, square);
            is_active_[old] = true;
            impulse_[old] = remembered_impulse_[j];
        }
        exclude(contact);
    }
};

/// J L with D^-1 = L L^T: rows whose products are J D^-1 J^T.
void whiten(ImpulseSpace& space, CollisionWorkspace& workspace) {
    const int n = space.freedoms;
    double* l = workspace.mass_factor;
    factorize(space.inverse_mass, n, l);
    for (int i = 0; i < space.contacts; ++i) {
        const double* row = space.jacobian + i * n;
        double* to = workspace.whitened + i * n;
        for (int k = 0; k < n; ++k)
            to[k] = 0.0;
        for (int j = 0; j < n; ++j)
            for (int k = 0; k <= j; ++k)
                to[k] += row[j] * l[j * n + k];
    }
    space.whitened = workspace.whitened;
}

} // namespace

void factorize(const double* matrix, int n, double* l) noexcept {
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j <= i; ++j) {
            double sum = matrix[i * n + j];
            for (int k = 0; k < j; ++k)
                sum -= l[i * n + k] * l[j * n + k];
            if (i == j)
                l[i * n + i] = std::sqrt(std::fmax(sum, 0.0));
            else
                l[i * n + j] = l[j * n + j] > 0.0 ? sum / l[j * n + j] : 0.0;
        }
    }
}

void project_normals(ImpulseSpace& space, const double* velocity, double* impulse,
                     CollisionWorkspace& workspace, SolverReport& report) noexcept {
    if (space.contacts == 2 && !space.excluded[0] && !space.excluded[1] &&
        project_two(space, velocity, impulse)) {
        ++report.iterations;
        return;
    }
    if (space.whitened == nullptr)
        whiten(space, workspace);
    Walk(space, velocity, impulse, workspace, report).run();
}

} // namespace haptics::detail
