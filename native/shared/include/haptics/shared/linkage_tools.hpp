#pragma once
/// Linkages as tools: rods with shapes, held by a simulated hand through a simulated device.

#include <haptics/core/control/session.hpp>
#include <haptics/devices/simulated/simulated_pantograph.hpp>
#include <haptics/shared/linkages.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <cmath>
#include <memory>

namespace haptics::shared {

/// The linkage as a tool; every link is a bar as long as a uniform rod of its inertia, `thickness` m thick.
inline Model linkage_tool(const LinkageSpec& spec, double thickness = 0.01) {
    Model model;
    model.tool.articulated = true;
    LinkageSpec free = spec;
    free.gravity.setZero();
    const auto faults = build_model(free, model.tool.linkage);
    if (!faults.empty())
        throw faults.front();
    for (std::size_t i = 0; i < spec.links.size(); ++i) {
        const LinkSpec& link = spec.links[i];
        add_body(model.tool.shape, i, BodyKind::tool, neutral_surface(), Pose::Zero());
        const double length = std::sqrt(12.0 * link.inertia / link.mass);
        add_piece(model.tool.shape, make_box(Vec2::Zero(), Vec2(length, thickness)));
    }
    return model;
}

/// A world without anything to touch, with or without gravity.
inline std::unique_ptr<Neighborhood> empty_world(const Vec2& gravity = Vec2::Zero()) {
    auto n = std::make_unique<Neighborhood>();
    n->sequence = 1;
    n->gravity = gravity;
    return n;
}

/// A tool held through a device, in one piece.
struct HeldTool {
    /// `hand` holds the handle; `start` are the tool's coordinates.
    HeldTool(const Model& model, const LinkageVector& start, const SimulatedHandOptions& hand,
             SessionSettings settings = {}, double device_mass = 0.3, double encoder = 0.0) {
        SimulatedPantographOptions d;
        d.mass = device_mass;
        d.inertia = 3e-4;
        d.viscous_friction = 1.0;
        d.encoder_model = encoder > 0.0 ? EncoderModel::handle : EncoderModel::exact;
        d.encoder_resolution = Vec3(encoder, encoder, 1e-4);
        d.measures_force = true;
        d.limit_motors = false;
        d.bounded = false;
        d.hand = hand;
        device = std::make_unique<SimulatedPantograph>(d);
        settings.reading_error = Vec3(0.5 * encoder, 0.5 * encoder, encoder > 0.0 ? 0.5e-4 : 0.0);
        SafetyLimits limits;
        limits.max_force = 20.0;
        limits.max_torque = 1.0;
        OutputGate gate(limits);
        gate.set_homed(true);
        session = std::make_unique<Session>(settings, model, gate, *device, start);
    }
    std::unique_ptr<SimulatedPantograph> device;
    std::unique_ptr<Session> session;
};

} // namespace haptics::shared
