// Ten minutes on the paper's wall with a hand that stiffens and softens: the loop creates no energy beyond
// what the encoder leaves uncertain. A controller that is active by design fails the same check.

#include <haptics/shared/observed_tool.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace haptics;
using shared::ObservedTool;
using shared::ObservedToolOptions;

namespace {

struct Soak {
    double injected{0.0};
    double allowed{0.0};
    double taken{0.0};
    Fault faults{Fault::none};
};

// the hand leans, slides, lifts a little, and changes its stiffness between 50 and 2000 N/m twice a second
Soak soak(ObservedToolOptions o, double seconds) {
    std::vector<HandTarget> path;
    for (int i = 0; i <= static_cast<int>(4.0 * seconds); ++i) {
        const double t = 0.25 * i;
        const double depth = t < 1.5 ? 0.0 : -0.008 + 0.005 * std::sin(1.3 * t);
        path.push_back({t, Pose(0.01 * std::sin(0.7 * t), depth, 0.0)});
    }
    o.distance = 0.002;
    o.hand = path_hand(path);
    ObservedTool tool(o);
    const int steps = static_cast<int>(seconds * o.rate_hz);
    const int half_second = static_cast<int>(0.5 * o.rate_hz);
    double most = 0.0;
    for (int i = 0; i < steps; ++i) {
        if (i % half_second == 0) {
            const double stiffness = 50.0 * std::pow(40.0, 0.5 + 0.5 * std::sin(2.3 * i / o.rate_hz));
            tool.device->hand().set_grip(stiffness, std::sqrt(0.3 * stiffness));
        }
        tool.session->step();
        most = std::max(most, tool.session->report().force.head<2>().norm());
    }
    Soak result;
    result.injected = tool.session->report().energy_injected;
    result.allowed = most * o.encoder + 1e-4;
    result.taken = tool.session->passivity().taken();
    result.faults = tool.session->report().faults;
    return result;
}

} // namespace

TEST_SUITE("passivity soak") {
    TEST_CASE("ten minutes on the paper's wall create no more energy than the encoder hides") {
        ObservedToolOptions o;
        o.rate_hz = 500.0;
        o.observer = false;
        const Soak plain = soak(o, 600.0);
        MESSAGE("no observer, 500 Hz: " << plain.injected << " J of " << plain.allowed);
        CHECK(plain.injected <= plain.allowed);
        CHECK(plain.faults == Fault::none);
        o.observer = true;
        o.rate_hz = 1000.0;
        const Soak observed = soak(o, 600.0);
        MESSAGE("observer, 1 kHz: " << observed.injected << " J of " << observed.allowed);
        CHECK(observed.injected <= observed.allowed);
        CHECK(observed.faults == Fault::none);
    }

    TEST_CASE("direct rendering of the same wall, active at this rate, fails the check within a minute") {
        ObservedToolOptions o;
        o.rate_hz = 500.0;
        o.coupling = Coupling::direct;
        o.observer = false;
        const Soak direct = soak(o, 60.0);
        CHECK(direct.injected > 100.0 * direct.allowed);
    }
}
