// A mass on a belt, held by a spring: the stick-slip oscillation with rigid Coulomb friction in closed form.
//
// The belt runs with u, the spring k holds the mass m, the normal force is N. Sticking, the mass goes with
// the belt until k x = mu_s N. Sliding, it swings about x_d = mu_d N / k with w = sqrt(k/m); with X0 = (mu_s
// - mu_d) N / k it starts at X0 with velocity u and has u again at -X0. With tan a = X0 w / u:
//     T = (2 pi - 2 a) / w + 2 X0 / u,     largest stretch x_d + sqrt(u^2 / w^2 + X0^2).

#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

using namespace haptics;

namespace {

constexpr double k_block_mass = 0.3;
constexpr double k_spring = 200.0;
constexpr double k_normal = 2.0;
constexpr double k_belt = 0.02;
constexpr double k_static = 0.5;
constexpr double k_dynamic = 0.3;

struct Swing {
    double period{0.0};
    double stretch{0.0};
    int periods{0};
};

Swing closed_form() {
    const double w = std::sqrt(k_spring / k_block_mass);
    const double start = (k_static - k_dynamic) * k_normal / k_spring;
    const double angle = std::atan(start * w / k_belt);
    return {(2.0 * std::numbers::pi - 2.0 * angle) / w + 2.0 * start / k_belt,
            k_dynamic * k_normal / k_spring + std::hypot(k_belt / w, start), 0};
}

Swing run(Integrator integrator, double stiffness, double damping, double rate) {
    Model model = shared::box_tool(k_block_mass);
    model.settings.integrator = integrator;
    auto data = std::make_unique<Data>();
    reset(model, *data, Pose(0.0, 0.01, 0.0));
    auto n = std::make_unique<Neighborhood>();
    n->sequence = 1;
    n->tick = 1e6; // the belt goes on without news
    Surface s;
    s.stiffness = stiffness;
    s.damping = damping;
    s.static_friction = k_static;
    s.dynamic_friction = k_dynamic;
    const auto belt =
        static_cast<std::size_t>(shared::add_body(n->bodies, 1, BodyKind::kinematic, s, Pose::Zero()));
    n->bodies.body[belt].velocity = Twist(k_belt, 0.0, 0.0);
    shared::add_piece(n->bodies, make_half_plane(Vec2::Zero(), Vec2(0.0, 1.0)));
    take_neighborhood(*n, *data);
    HandInput hand;
    hand.held = true;
    hand.stiffness = Vec3(k_spring, 0.0, 200.0);
    hand.damping = Vec3(0.0, 0.0, 0.4);
    hand.force = Wrench(0.0, -k_normal, 0.0);
    StepOutput out;
    Swing swing;
    double first = -1.0;
    double last = -1.0;
    bool sticking = true;
    const int steps = static_cast<int>(6.0 * rate);
    for (int i = 0; i < steps; ++i) {
        step(model, *data, hand, 1.0 / rate, out);
        const double time = (i + 1) / rate;
        const bool slips = sticking && out.sliding > 0;
        sticking = out.sticking > 0;
        if (time < 1.0)
            continue;
        swing.stretch = std::max(swing.stretch, data->pose.x());
        if (!slips)
            continue;
        if (first < 0.0)
            first = time;
        else
            ++swing.periods;
        last = time;
    }
    swing.period = (last - first) / swing.periods;
    return swing;
}

} // namespace

TEST_CASE("a mass on a belt sticks and slips with the period and the stretch of the closed form") {
    const Swing expected = closed_form();
    struct Way {
        std::string name;
        Integrator integrator;
        double stiffness;
        double damping;
        double tolerance;
    };
    // In steps the mass sticks up to a step early and slips up to a step late, the exact one knows when. (The
    // contact's own spring of 1e7 N/m changes the period by 2e-5, that of 1e5 N/m, which semi-implicit bears,
    // by 2e-3.)
    for (const double rate : {500.0, 1000.0})
        for (const Way& way :
             {Way{"exact", Integrator::exact, 1e7, 1500.0, 5e-4},
              Way{"linearly implicit", Integrator::linearly_implicit, 1e7, 1500.0, 17.0 / rate},
              Way{"semi-implicit", Integrator::semi_implicit, 1e5, 100.0, 17.0 / rate}}) {
            const Swing swing = run(way.integrator, way.stiffness, way.damping, rate);
            MESSAGE(way.name << " at " << rate << " Hz: period " << swing.period << " s of "
                             << expected.period << ", stretch " << swing.stretch * 1e3 << " mm of "
                             << expected.stretch * 1e3);
            CAPTURE(way.name);
            CAPTURE(rate);
            REQUIRE(swing.periods > 10);
            CHECK(std::abs(swing.period / expected.period - 1.0) < way.tolerance);
            CHECK(std::abs(swing.stretch / expected.stretch - 1.0) < 0.2 * way.tolerance);
        }
}
