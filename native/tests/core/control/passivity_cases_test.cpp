// The energy ledger away from the soak: weights, force channels, the edge of reach, linkages. In a closed
// cycle nothing is stored, so what the ledger calls created has to be what left the device's port.

#include <haptics/shared/linkage_tools.hpp>
#include <haptics/shared/observed_tool.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace haptics;
using shared::ObservedTool;
using shared::ObservedToolOptions;

namespace {

constexpr double k_pi = std::numbers::pi;

// out to (x, y) and back, `frequency` times a second, after a second of rest
std::vector<HandTarget> to_and_fro(double x, double y, double frequency, double seconds) {
    std::vector<HandTarget> path{{0.0, Pose::Zero()}};
    for (int i = 0; 0.005 * i <= seconds; ++i) {
        const double t = 0.005 * i;
        const double out = 0.5 - 0.5 * std::cos(2.0 * k_pi * frequency * t);
        path.push_back({1.0 + t, Pose(out * x, out * y, 0.0)});
    }
    return path;
}

struct Books {
    /// Rise of what is called created, from the end of the start ramp on, and what an encoder may hide.
    double rise{0.0};
    double allowed{0.0};
    /// Of the last whole cycle.
    double created{0.0};
    double delivered{0.0};
    Fault faults{Fault::none};
};

// `cycle` in steps
Books run(Session& session, double encoder, int steps, int cycle) {
    Books books;
    double least = 1e300;
    double most = 0.0;
    double created = 0.0;
    double delivered = 0.0;
    for (int i = 0; i < steps; ++i) {
        session.step();
        const EnergyLedger& ledger = session.ledger();
        most = std::max(most, session.report().force.head<2>().norm());
        if (i == 1000)
            least = ledger.created();
        if (i >= 1000)
            books.rise = std::max(books.rise, ledger.created() - least);
        if (i % cycle == 0) {
            books.created = ledger.created() - created;
            books.delivered = ledger.delivered() - delivered;
            created = ledger.created();
            delivered = ledger.delivered();
        }
    }
    books.allowed = most * encoder + 1e-4;
    books.faults = session.report().faults;
    return books;
}

struct PortChannels {
    const char* name;
    Coupling coupling;
    HandForce hand_force;
};
constexpr PortChannels k_port_channels[]{
    {"virtual coupling", Coupling::virtual_coupling, HandForce::combined},
    {"four channels", Coupling::four_channel, HandForce::combined},
    {"transparent", Coupling::four_channel, HandForce::transparent},
};

ObservedToolOptions with(const PortChannels& channels, bool controlled) {
    ObservedToolOptions o;
    o.coupling = channels.coupling;
    o.hand_force = channels.hand_force;
    o.hidden_inertia = channels.hand_force == HandForce::transparent ? 0.9 : 0.0;
    o.passivity = controlled;
    return o;
}

// a wall wider than the device's reach, whose edge the tool is pushed along
std::unique_ptr<Neighborhood> wide_floor() {
    auto n = std::make_unique<Neighborhood>();
    n->sequence = 2;
    shared::add_body(n->bodies, 100, BodyKind::fixed, shared::paper_surface(), Pose::Zero());
    shared::add_piece(n->bodies, make_box(Vec2(0.0, -0.02), Vec2(0.8, 0.04)));
    return n;
}

} // namespace

TEST_SUITE("passivity ledger, cases") {
    TEST_CASE("a held weight that is raised and lowered, and a free tool: created is what the port gave in a "
              "cycle, and next to nothing when it is controlled") {
        for (const PortChannels& channels : k_port_channels)
            for (const bool weight : {true, false}) {
                CAPTURE(std::string(channels.name));
                CAPTURE(weight);
                for (const bool controlled : {false, true}) {
                    ObservedToolOptions o = with(channels, controlled);
                    o.distance = 0.05;
                    o.gravity = Vec2(0.0, weight ? -9.81 : 0.0);
                    o.hand = path_hand(to_and_fro(weight ? 0.0 : 0.04, 0.03, 1.0, 4.0));
                    ObservedTool tool(o);
                    const Books books = run(*tool.session, o.encoder, 4001, 1000);
                    CHECK(books.faults == Fault::none);
                    CHECK(std::abs(books.created - books.delivered) < books.allowed);
                    if (controlled)
                        CHECK(books.rise < books.allowed);
                }
            }
    }

    TEST_CASE("pressed into a wall at the edge of reach, where no force is, and brought inside: the force "
              "comes back when the hand lets up, not before") {
        for (const PortChannels& channels : k_port_channels) {
            CAPTURE(std::string(channels.name));
            ObservedToolOptions o = with(channels, true);
            o.distance = 0.002;
            std::vector<HandTarget> path{{0.0, Pose::Zero()}, {1.0, Pose::Zero()}};
            for (int i = 1; i <= 400; ++i) {
                const double a = 0.01 * k_pi * i;
                path.push_back(
                    {1.0 + 0.01 * i, Pose(0.08 - 0.08 * std::cos(a), -0.004 + 0.006 * std::sin(a), 0.0)});
            }
            o.hand = path_hand(path);
            ObservedTool tool(o);
            tool.session->take(*wide_floor());
            const Books books = run(*tool.session, o.encoder, 5001, 2000);
            MESSAGE(std::string(channels.name) << ": created " << books.rise * 1e3 << " mJ");
            CHECK(books.faults == Fault::none);
            CHECK(books.rise < books.allowed);
        }
    }

    TEST_CASE("chains held by their ends, angle and all, create next to nothing when controlled") {
        for (const PortChannels& channels : k_port_channels)
            for (const int links : {1, 2, 3}) {
                CAPTURE(std::string(channels.name));
                CAPTURE(links);
                Model model = shared::linkage_tool(shared::chain(links));
                model.tool.grip = Grip{links - 1, Vec2(0.05, 0.0), true};
                LinkageVector start(links);
                for (int i = 0; i < links; ++i)
                    start[i] = i == 0 ? 0.5 : (i % 2 == 1 ? -0.8 : 0.7);
                SessionSettings s;
                s.coupling = channels.coupling;
                s.hand_force = channels.hand_force;
                s.hidden_inertia = channels.hand_force == HandForce::transparent ? 0.9 : 0.0;
                s.passivity_control = true;
                SimulatedHandOptions hand = path_hand(to_and_fro(0.03, 0.05, 1.0, 3.0));
                hand.rotation_stiffness = 1.0;
                shared::HeldTool tool(model, start, hand, s, 0.3, 1e-6);
                tool.session->take(*shared::empty_world());
                const Books books = run(*tool.session, 1e-6, 3501, 1000);
                MESSAGE(std::string(channels.name)
                        << ", " << links << " links: created " << books.rise * 1e3 << " mJ");
                CHECK(books.faults == Fault::none);
                CHECK(books.rise < books.allowed);
            }
    }
}
