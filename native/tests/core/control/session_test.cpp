#include <haptics/core/control/session.hpp>
#include <haptics/shared/experiment1.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <support/allocation_guard.hpp>

using namespace haptics;
using haptics::testing::AllocationGuard;
using shared::Experiment1;
using shared::Experiment1Options;

namespace {

struct Tail {
    double mean{0.0};
    double swing{0.0};
};

// contact force over the last second of `seconds`
Tail run(Experiment1& e, double seconds) {
    const double h = e.session->settings().step;
    const int steps = static_cast<int>(seconds / h);
    const int last = static_cast<int>(1.0 / h);
    double low = 1e300;
    double high = -1e300;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        e.session->step();
        if (i < steps - last)
            continue;
        const double f = e.session->report().contact.y();
        low = std::min(low, f);
        high = std::max(high, f);
        sum += f;
    }
    return {sum / last, high - low};
}

} // namespace

TEST_CASE("a steady push comes back through the whole loop, whatever tool and coupling") {
    for (const Integrator integrator : {Integrator::linearly_implicit, Integrator::exact})
        for (const Coupling coupling : {Coupling::four_channel, Coupling::virtual_coupling})
            for (const double tool : {0.05, 0.3, 1.0}) {
                Experiment1Options o;
                o.integrator = integrator;
                o.coupling = coupling;
                o.tool_mass = tool;
                o.gain = 0.33;
                Experiment1 e(o);
                CAPTURE(tool);
                CAPTURE(static_cast<int>(integrator));
                CAPTURE(static_cast<int>(coupling));
                const Tail tail = run(e, 5.0);
                CHECK(tail.mean == doctest::Approx(2.0).epsilon(0.01));
                CHECK(tail.swing < 0.2);
                CHECK(e.session->report().faults == Fault::none);
                CHECK(e.session->report().exact_gave_way == 0);
            }
}

TEST_CASE("a device that measures no force still gives the push back once") {
    Experiment1Options o;
    o.gain = 0.33;
    o.measures_force = false;
    Experiment1 e(o);
    const Tail tail = run(e, 5.0);
    CHECK(tail.mean == doctest::Approx(2.0).epsilon(0.01));
    CHECK(e.session->report().force.y() == doctest::Approx(2.0).epsilon(0.03));
}

TEST_CASE("a haptic step takes nothing from the heap") {
    Experiment1 e(Experiment1Options{});
    for (int i = 0; i < 10; ++i)
        e.session->step();
    std::uint64_t taken = 0;
    {
        const AllocationGuard guard;
        for (int i = 0; i < 1500; ++i)
            e.session->step();
        taken = guard.allocations();
    }
    CHECK(e.session->report().run.collisions > 0);
    CHECK(taken == 0);
}

TEST_CASE("the same session gives the same bits") {
    Experiment1 a(Experiment1Options{});
    Experiment1 b(Experiment1Options{});
    bool same = true;
    for (int i = 0; i < 1000; ++i) {
        a.session->step();
        b.session->step();
        same = same && a.session->report().force == b.session->report().force &&
               a.session->report().proxy == b.session->report().proxy;
    }
    CHECK(same);
    CHECK(a.session->report().contacts == 1);
}

TEST_CASE("taking hold and letting go never let the force jump") {
    Experiment1Options o;
    o.gain = 0.33;
    o.encoder = 0.0; // the steps of an encoder are another matter
    Experiment1 e(o);
    for (int i = 0; i < 2000; ++i)
        e.session->step();
    double largest = 0.0;
    const auto run = [&](int steps) {
        Wrench last = e.session->report().force;
        for (int i = 0; i < steps; ++i) {
            e.session->step();
            largest = std::max(largest, (e.session->report().force - last).head<2>().norm());
            last = e.session->report().force;
        }
    };
    CHECK(e.session->report().force.y() == doctest::Approx(2.0).epsilon(0.05));
    e.session->hold(false);
    run(60);
    CHECK(e.session->report().force.isZero(0.0));
    // 2 N fade out over 50 steps: 0.04 N each, and the hand that pushes on changes the coupling meanwhile
    CHECK(largest < 0.1);
}

TEST_CASE("the impulse channel keeps its books") {
    ImpulseChannel channel;
    channel.demand(Wrench(0.1, -0.2, 0.001));
    Wrench given = Wrench::Zero();
    for (int i = 0; i < 10; ++i)
        given += 0.001 * channel.deliver(0.001, 8.0, 0.2);
    const Wrench books = channel.delivered() + channel.pending() + channel.dropped();
    CHECK((books - channel.demanded()).norm() < 1e-12);
    CHECK((given - channel.delivered()).norm() < 1e-12);
    CHECK(channel.dropped().norm() > 0.0);
}
