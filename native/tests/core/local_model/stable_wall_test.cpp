// The stiffest wall on which a bounce gains no energy, per integrator: the table of docs/physics.md.

#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>
#include <haptics/shared/tool_in_socket.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>

using namespace haptics;

namespace {

constexpr double k_speed = 0.2;
constexpr double k_mass = 0.3;

// energy of a bounce as a share of that before; the largest and the smallest over the phases of the step
struct Returned {
    double least{1e300};
    double most{0.0};
};

// `strictly`: semi-implicit where it is unstable too
Returned bounce(Data& data, Integrator integrator, double stiffness, double damping, double rate,
                bool strictly = true) {
    Returned r;
    for (int phase = 0; phase < 8; ++phase) {
        Model model = shared::box_tool(k_mass);
        model.settings.integrator = integrator;
        model.settings.strictly_semi_implicit = strictly;
        model.settings.contact_mode = ContactMode::penalty;
        data = Data{};
        reset(model, data, Pose(0.0, 0.0102 + k_speed / rate * phase / 8.0, 0.0));
        data.velocity = Twist(0.0, -k_speed, 0.0);
        Surface s = shared::paper_surface();
        s.stiffness = stiffness;
        s.damping = damping;
        take_neighborhood(*shared::floor_of(1, s), data);
        StepOutput out;
        bool touched = false;
        for (int i = 0; i < 2000; ++i) {
            step(model, data, HandInput{}, 1.0 / rate, out);
            touched = touched || out.contact.y() != 0.0;
            if (touched && out.contact.y() == 0.0)
                break;
        }
        const double speed = data.velocity.y() / k_speed;
        r.least = std::min(r.least, speed * speed);
        r.most = std::max(r.most, speed * speed);
    }
    return r;
}

double stiffest(Data& data, Integrator integrator, double rate) {
    double stable = 0.0;
    for (int quarter = 0; quarter <= 36; ++quarter) {
        const double stiffness = std::pow(10.0, 3.0 + 0.25 * quarter);
        if (!(bounce(data, integrator, stiffness, 20.0, rate).most <= 1.01))
            break;
        stable = stiffness;
    }
    return stable;
}

const char* name_of(Integrator integrator) {
    switch (integrator) {
    case Integrator::semi_implicit:
        return "semi_implicit";
    case Integrator::linearly_implicit:
        return "linearly_implicit";
    case Integrator::exact:
        return "exact";
    }
    return "";
}

} // namespace

TEST_CASE(
    "the stiffest wall without gain of energy: semi-implicit has a bound, the other two reach 1e12 N/m") {
    auto data = std::make_unique<Data>();
    std::ostringstream table;
    table << "stiffest wall (N/m, B = 20 N s/m, 0.3 kg) at 500, 1000, 4000 Hz; energy back from 15000 N/m "
             "without damper at 500 Hz";
    for (const Integrator integrator :
         {Integrator::semi_implicit, Integrator::linearly_implicit, Integrator::exact}) {
        table << "\n    " << std::left << std::setw(18) << name_of(integrator);
        for (const double rate : {500.0, 1000.0, 4000.0}) {
            const double stable = stiffest(*data, integrator, rate);
            table << std::setw(10) << std::setprecision(2) << stable;
            CAPTURE(name_of(integrator));
            CAPTURE(rate);
            if (integrator == Integrator::semi_implicit) {
                // the bound of the linear analysis is m > (K h^2 + 2 B h) / 4
                const double bound = 4.0 * k_mass * rate * rate - 40.0 * rate;
                CHECK(stable > 0.08 * bound);
                CHECK(stable < bound);
            } else {
                CHECK(stable == doctest::Approx(1e12));
            }
        }
        const Returned back = bounce(*data, integrator, 15000.0, 0.0, 500.0);
        table << std::setprecision(5) << back.least << " to " << back.most;
        if (integrator == Integrator::exact) {
            CHECK(back.least > 1.0 - 1e-10);
            CHECK(back.most < 1.0 + 1e-10);
        }
    }
    MESSAGE(table.str());
}

TEST_CASE("beyond its bound semi-implicit gives way and says so, within it it does not") {
    auto data = std::make_unique<Data>();
    for (const double stiffness : {15000.0, 1e6, 1e9, 1e12})
        for (const double damping : {0.0, 20.0, 1e6}) {
            CAPTURE(stiffness);
            CAPTURE(damping);
            CHECK(bounce(*data, Integrator::semi_implicit, stiffness, damping, 500.0, false).most <= 1.01);
        }
    // a disc that cannot turn: one row that presses, so that the bound is that of the analysis
    for (const double share : {0.9, 1.1}) {
        Model model = shared::box_tool(k_mass);
        model.tool.inertia = 1e12;
        model.tool.shape.piece[0].convex = make_disc(Vec2::Zero(), 0.01);
        model.settings.integrator = Integrator::semi_implicit;
        *data = Data{};
        reset(model, *data, Pose(0.0, 0.0099, 0.0));
        Surface s = shared::paper_surface();
        s.static_friction = s.dynamic_friction = 0.0;
        s.damping = 20.0;
        s.stiffness = share * (4.0 * k_mass - 2.0 * 20.0 * 1e-3) / 1e-6;
        take_neighborhood(*shared::floor_of(1, s), *data);
        StepOutput out;
        step(model, *data, HandInput{}, 1e-3, out);
        REQUIRE(out.contact.y() > 0.0);
        CHECK(out.fell_back == (share > 1.0));
    }
    // many contacts share the tool's few freedoms: it refuses steps that fell back
    CHECK_NOTHROW((void)shared::tool_in_socket(64, Integrator::semi_implicit));
}
