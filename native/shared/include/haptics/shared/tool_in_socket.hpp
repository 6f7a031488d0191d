#pragma once
/// A rigid tool with any number of contacts, each a patch of its own: discs on a circle, each pressed into a
/// wall that is tangent to the circle. At rest in the middle all forces balance. For benchmarks and tests.

#include <haptics/shared/paper_wall.hpp>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace haptics::shared {

/// Model and memory of one tool in its socket.
struct ToolInSocket {
    Model model;
    std::unique_ptr<Data> data;
    HandInput hand;
    StepOutput output;
    /// s; short enough for semi_implicit with 64 contacts of the paper's wall on 0.3 kg.
    double time_step{2e-4};
};

/// One haptic step.
inline void step(ToolInSocket& socket) {
    haptics::step(socket.model, *socket.data, socket.hand, socket.time_step, socket.output);
}

/// `contacts` from 0 to k_max_patches, with friction 0.6 and 0.5. With 0 the tool is free and nothing is
/// near. The plan is that of the scene. `held`: a hand holds it in the middle by 1000 N/m.
inline ToolInSocket tool_in_socket(int contacts, Integrator integrator, bool held = false) {
    constexpr double k_ring = 0.06;
    constexpr double k_disc = 0.001;
    constexpr double k_overlap = 5e-5;
    ToolInSocket socket;
    socket.model.settings.integrator = integrator;
    socket.model.tool.mass = 0.3;
    socket.model.tool.inertia = 0.3 * k_ring * k_ring;
    add_body(socket.model.tool.shape, 0, BodyKind::tool, neutral_surface(), Pose::Zero());
    Surface surface = paper_surface();
    surface.static_friction = 0.6;
    surface.dynamic_friction = 0.5;
    auto neighborhood = std::make_unique<Neighborhood>();
    neighborhood->sequence = 1;
    for (int i = 0; i < contacts; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / contacts;
        const Vec2 out(std::cos(angle), std::sin(angle));
        add_piece(socket.model.tool.shape, make_disc(k_ring * out, k_disc));
        const double depth = 0.004;
        add_body(neighborhood->bodies, static_cast<std::uint64_t>(100 + i), BodyKind::fixed, surface,
                 Pose(0.0, 0.0, angle));
        add_piece(neighborhood->bodies,
                  make_box(Vec2(k_ring + k_disc - k_overlap + 0.5 * depth, 0.0), Vec2(depth, 0.002)));
    }
    if (contacts == 0)
        add_piece(socket.model.tool.shape, make_disc(Vec2::Zero(), k_disc));
    if (held) {
        socket.hand.held = true;
        socket.hand.stiffness = Vec3(1000.0, 1000.0, 1.0);
        socket.hand.damping = Vec3(10.0, 10.0, 0.01);
    }
    socket.data = std::make_unique<Data>();
    reset(socket.model, *socket.data, Pose::Zero());
    neighborhood->plan = choose_plan(socket.model, *neighborhood);
    take_neighborhood(*neighborhood, *socket.data);
    // until the first touch, which may count as a collision, is over
    for (int i = 0; i < 200; ++i)
        step(socket);
    if (socket.output.contacts != contacts || socket.output.fell_back)
        throw std::logic_error("the tool in its socket has not the contacts that were asked for");
    return socket;
}

} // namespace haptics::shared
