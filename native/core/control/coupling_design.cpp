// Design of coupling and observer.
//
// The loop of one axis is linear between contacts: handle (true mass, held by a hand of stiffness and
// damping), observer (handle_observer.cpp), forces on their way, and the proxy, either free or pressed
// against a hard wall. One step of it is a matrix Z; the loop is stable when its spectral radius is below
// one. Columns of Z are the images of unit vectors under `pass`, which says the loop once, in the words of
// the session, so that nothing is derived twice.
//
// Implicit coupling. A force F that acts over the step moves the handle's end of step by T^2/2 F/m and T F/m.
// Wanting F = -(K x_end + B v_end) with x_end = x_ahead + T^2/2 F/m gives F = -(K' x_ahead + B' v_ahead), K'
// = K/(1 + c), B' = B/(1 + c), c = (K T^2/2 + B T)/m. At rest x_ahead holds the hand's force f = -F, so that
// F = -K x: nothing of the stiffness is lost. As K grows the loop goes to one that takes the handle to the
// proxy in one step.
//
// Four channels (coupling.cpp): with a = m/(m + m_proxy) the proxy gets a f besides F, the wall answers F + a
// f, and the handle gets a times that.
//
// Acceleration feed-forward (shared_motion.cpp): with the visible mass m' (m against a wall) the proxy gets L
// = f m_proxy/(m_proxy + m'), the handle m L/m_proxy - f, which is known before the coupling is solved and so
// moves x_end too. Coupling and observer are chosen with nothing hidden; then the most is hidden, by steps of
// 0.05, with which the same loops stay stable.
//
// Choice. Over a grid of observer bandwidths, stiffnesses and damping ratios: stable for the assumed mass off
// by mass_error and for more than that (k_margin), for hands from none to the stiffest, walls and free
// proxies; force noise within the budget; then the largest geometric mean of the dynamic stiffness at 5 and
// 30 Hz. Noise is that of a white reading error of variance q^2/12: its sum over the impulse response.

#include <haptics/core/control/coupling_design.hpp>
#include <haptics/core/control/shared_motion.hpp>
#include <haptics/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

namespace haptics {
namespace {

// handle, proxy, observer; then the forces on their way
constexpr int k_states = 7;
// more forces on their way make the search slow
constexpr int k_most_searched = 8;
constexpr double k_margin = 1.2;
// a loop against a wall that forgets slower than this is left out, rad/s
constexpr double k_slowest = 5.0;

// sized by the delay
using State = Eigen::VectorXd;
using Square = Eigen::MatrixXd;

struct Loop {
    double mass; // assumed
    double step;
    int delay;      // whole steps
    int size;       // of the state: those above and the forces on their way
    double g, h, k; // observer's gains
    SolverGains gains;
    double share; // a
    // truth
    LoopCase truth;
    bool transparent;
    double lead; // L / f
    double feed; // of the handle, over f
    // handle over one step with a held force: exact for mass, spring and damper
    Mat2 motion;
    Vec2 push;
};

// exp of the handle's motion by scaling and squaring of its series
void solve_handle(Loop& loop) {
    const double m = loop.truth.true_mass;
    Mat3 a = Mat3::Zero();
    a(0, 1) = 1.0;
    a(1, 0) = -loop.truth.hand_stiffness / m;
    a(1, 1) = -loop.truth.hand_damping / m;
    a(1, 2) = 1.0 / m;
    a *= loop.step / 1024.0;
    Mat3 e = Mat3::Identity() + a + 0.5 * a * a + a * a * a / 6.0;
    for (int i = 0; i < 10; ++i)
        e = (e * e).eval();
    loop.motion = e.topLeftCorner<2, 2>();
    loop.push = e.topRightCorner<2, 1>();
}

int steps_of(const LoopFigures& figures) {
    return std::max(0, static_cast<int>(std::ceil(figures.delay / figures.step - 1e-6)));
}

Loop make_loop(const LoopFigures& figures, const CouplingDesign& design, const LoopCase& truth) {
    Loop loop{};
    loop.mass = figures.mass;
    loop.step = figures.step;
    loop.delay = steps_of(figures);
    loop.size = k_states + loop.delay;
    const double p = std::exp(-design.bandwidth * figures.step);
    loop.g = 1.0 - p * p * p;
    loop.h = 1.5 * (1.0 - p) * (1.0 - p) * (1.0 + p) / figures.step;
    loop.k = (1.0 - p) * (1.0 - p) * (1.0 - p) / (figures.step * figures.step);
    loop.gains = solver_gains(design.stiffness, design.damping, 1.0 / figures.mass, figures.step);
    loop.truth = truth;
    loop.transparent = figures.four_channel && figures.transparent;
    loop.share = figures.four_channel ? figures.mass / (figures.mass + truth.proxy_mass) : 0.0;
    const double visible = truth.wall ? figures.mass
                                      : figures.mass * visible_part(design.hidden, figures.hidden,
                                                                    truth.proxy_mass / figures.mass);
    loop.lead = truth.proxy_mass / (truth.proxy_mass + visible);
    loop.feed = figures.mass / (truth.proxy_mass + visible) - 1.0;
    solve_handle(loop);
    return loop;
}

struct Passed {
    State state;
    double force; // sent in this step
};

// one step; `error` is added to the reading, `hand` to the hand's force
Passed pass(const Loop& loop, const State& z, double error, double hand) {
    const double t = loop.step;
    const double m = loop.mass;
    double x = z(4);
    double v = z(5);
    double f = z(6);
    const double e = z(0) + error - x;
    x += loop.g * e;
    v += loop.h * e;
    f += loop.k * m * e;
    // forces on their way, the oldest first: z(7) acts next
    double xa = x;
    double va = v;
    for (int i = 0; i < loop.delay; ++i) {
        const double a = (z(7 + i) + f) / m;
        xa += t * va + 0.5 * t * t * a;
        va += t * a;
    }
    // end of the step without the new force
    xa += t * va + 0.5 * t * t * f / m;
    va += t * f / m;
    if (loop.transparent) {
        xa += 0.5 * t * t * loop.feed * f / m;
        va += t * loop.feed * f / m;
    }
    const double to_proxy = (loop.transparent ? loop.lead : loop.share) * f;
    Passed out{State::Zero(loop.size), 0.0};
    double coupling = 0.0;
    double answer = 0.0;
    if (loop.truth.wall) {
        coupling = loop.gains.stiffness * xa + loop.gains.damping * va;
        answer = -(coupling + to_proxy);
    } else {
        const double mp = loop.truth.proxy_mass;
        const double pull = loop.gains.stiffness * (xa - z(2)) + loop.gains.damping * va + to_proxy;
        const double yield = loop.gains.stiffness * t + loop.gains.damping;
        const double vp = (z(3) + t / mp * pull) / (1.0 + t / mp * yield);
        out.state(2) = z(2) + t * vp;
        out.state(3) = vp;
        coupling = loop.gains.stiffness * (xa - out.state(2)) + loop.gains.damping * (va - vp);
    }
    out.force = -coupling + (loop.transparent ? loop.feed * f : loop.share * answer);
    const double acting = loop.delay > 0 ? z(7) : out.force;
    const Vec2 handle = loop.motion * z.head<2>() + loop.push * (acting + hand);
    out.state.head<2>() = handle;
    out.state(4) = x + t * v + 0.5 * t * t * (acting + f) / m;
    out.state(5) = v + t * (acting + f) / m;
    out.state(6) = f;
    for (int i = 0; i + 1 < loop.delay; ++i)
        out.state(7 + i) = z(8 + i);
    if (loop.delay > 0)
        out.state(6 + loop.delay) = out.force;
    return out;
}

Square matrix_of(const Loop& loop) {
    Square z(loop.size, loop.size);
    for (int i = 0; i < loop.size; ++i)
        z.col(i) = pass(loop, State::Unit(loop.size, i), 0.0, 0.0).state;
    return z;
}

// |Z^n|^(1/n) by squaring; the power leaves only the largest eigenvalue
double radius(Square z) {
    double log_scale = 0.0;
    constexpr int k_squarings = 22;
    for (int i = 0; i < k_squarings; ++i) {
        const double size = z.cwiseAbs().maxCoeff();
        if (!(size > 0.0) || !std::isfinite(size))
            return size > 0.0 ? HUGE_VAL : 0.0;
        z /= size;
        log_scale += std::log(size) / std::pow(2.0, i);
        z = (z * z).eval();
    }
    return std::exp(log_scale + std::log(std::max(z.norm(), 1e-300)) / std::pow(2.0, k_squarings));
}

// units in which the squared numbers are of one size
void scale(Square& z, double step, double mass) {
    State unit = State::Ones(z.rows());
    unit(1) = unit(3) = unit(5) = 1.0 / step;
    unit.tail(unit.size() - 6).setConstant(mass / (step * step));
    z = (unit.cwiseInverse().asDiagonal() * z * unit.asDiagonal()).eval();
}

double radius_of(const Loop& loop) {
    Square z = matrix_of(loop);
    scale(z, loop.step, loop.mass);
    return radius(z);
}

double noise_of(const Loop& loop, double quantum) {
    Passed now = pass(loop, State::Zero(loop.size), 1.0, 0.0);
    double sum = now.force * now.force;
    for (int i = 0; i < 4000; ++i) {
        now = pass(loop, now.state, 0.0, 0.0);
        sum += now.force * now.force;
        if (i > 20 && now.force * now.force < 1e-9 * sum)
            break;
    }
    return std::sqrt(sum / 12.0) * quantum;
}

double stiffness_at(const Loop& loop, double frequency) {
    using Complex = std::complex<double>;
    Eigen::MatrixXcd a = -matrix_of(loop).cast<Complex>();
    a.diagonal().array() += std::polar(1.0, 2.0 * std::numbers::pi * frequency * loop.step);
    const Eigen::VectorXcd b = pass(loop, State::Zero(loop.size), 0.0, 1.0).state.cast<Complex>();
    const Complex x = a.partialPivLu().solve(b)(0);
    return 1.0 / std::abs(x);
}

bool holds(const LoopFigures& figures, const CouplingDesign& design) {
    // the fourth is where hiding meets its most
    const std::array<double, 4> proxies{figures.lightest_proxy, 1.0, figures.heaviest_proxy,
                                        std::max(figures.lightest_proxy, figures.hidden - design.hidden)};
    const std::size_t asked = figures.transparent && figures.hidden > 0.0 ? 4 : 3;
    for (const double wide : {k_margin, 1.0}) {
        for (const double error : {-figures.mass_error, 0.0, figures.mass_error}) {
            if (wide > 1.0 && error == 0.0)
                continue;
            for (const double hold : {0.0, 0.3, 1.0}) {
                LoopCase truth;
                // the assumed mass is off by `error`: m = (1 + error) true
                truth.true_mass = figures.mass / (1.0 + std::max(wide * error, -0.9));
                truth.hand_stiffness = hold * figures.hand_stiffness;
                truth.hand_damping = hold * figures.hand_damping;
                for (const double ratio : std::span(proxies).first(asked)) {
                    truth.proxy_mass = ratio * figures.mass;
                    truth.wall = true;
                    const double limit = wide > 1.0 ? 1.0 - 1e-9 : std::exp(-k_slowest * figures.step);
                    if (radius_of(make_loop(figures, design, truth)) > limit)
                        return false;
                    truth.wall = false;
                    // without a hand nothing brings the pair back: its rest is an eigenvalue of 1
                    if (hold > 0.0 && radius_of(make_loop(figures, design, truth)) > 1.0 - 1e-9)
                        return false;
                }
            }
        }
    }
    return true;
}

// the most that may be hidden, at most what is asked
CouplingDesign hide(const LoopFigures& figures, CouplingDesign design) {
    if (!figures.four_channel || !figures.transparent)
        return design;
    for (design.hidden = figures.hidden; design.hidden > 0.0; design.hidden -= 0.05)
        if (holds(figures, design))
            return design;
    design.hidden = 0.0;
    return design;
}

} // namespace

SolverGains solver_gains(double stiffness, double damping, double mobility, double step) {
    const double c = mobility * step * (0.5 * step * stiffness + damping);
    return {stiffness / (1.0 + c), damping / (1.0 + c)};
}

double spectral_radius(const LoopFigures& figures, const CouplingDesign& design, const LoopCase& loop) {
    return radius_of(make_loop(figures, design, loop));
}

CouplingDesign design_coupling(const LoopFigures& wanted) {
    // A long delay is searched with longer steps, and so with fewer forces on their way: a slower loop of the
    // same delay is later still, so what holds in it holds in the faster one.
    LoopFigures figures = wanted;
    figures.step = std::max(wanted.step, wanted.delay / k_most_searched);
    LoopCase nominal;
    nominal.true_mass = figures.mass;
    nominal.proxy_mass = figures.mass;
    constexpr int k_grid = 16;
    constexpr double k_slow_observer = 40.0; // rad/s
    constexpr double k_fast_observer = 4.0;  // of the loop's rate
    constexpr double k_soft = 40.0;          // 1/s: sqrt(K/m)
    constexpr double k_hard = 8.0;           // of m / T^2
    const double unit = figures.mass / (figures.step * figures.step);
    const double least = std::min(figures.mass * k_soft * k_soft, 0.1 * k_hard * unit);
    struct Candidate {
        CouplingDesign design;
        double merit;
        // unstable, whatever the noise may be
        bool fails{false};
    };
    std::vector<Candidate> candidates;
    for (int i = 0; i < k_grid; ++i)
        for (int j = 0; j < k_grid; ++j)
            for (const double ratio : {0.5, 0.7, 1.0, 1.4}) {
                const double u = static_cast<double>(i) / (k_grid - 1);
                const double w = static_cast<double>(j) / (k_grid - 1);
                CouplingDesign now;
                now.bandwidth =
                    k_slow_observer * std::pow(k_fast_observer / figures.step / k_slow_observer, u);
                now.stiffness = least * std::pow(k_hard * unit / least, w);
                now.damping = 2.0 * ratio * std::sqrt(now.stiffness * figures.mass);
                const Loop loop = make_loop(figures, now, nominal);
                now.noise = noise_of(loop, figures.quantum);
                now.stiffness_5_hz = stiffness_at(loop, 5.0);
                now.stiffness_30_hz = stiffness_at(loop, 30.0);
                if (std::isfinite(now.noise))
                    candidates.push_back({now, std::sqrt(now.stiffness_5_hz * now.stiffness_30_hz), false});
            }
    // equal merits in a fixed order
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.merit != b.merit ? a.merit > b.merit : a.design.stiffness < b.design.stiffness;
    });
    // a reading so coarse that nothing is quiet enough: twice the noise, until something holds
    double noise = figures.noise;
    for (int doubled = 0; doubled < 20; ++doubled, noise *= 2.0)
        for (Candidate& candidate : candidates) {
            if (candidate.fails || candidate.design.noise > noise)
                continue;
            if (holds(figures, candidate.design))
                return hide(figures, candidate.design);
            candidate.fails = true;
        }
    return {};
}

} // namespace haptics
