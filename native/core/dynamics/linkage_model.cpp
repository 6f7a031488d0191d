/// Compiling a LinkageSpec.
///
/// Links joined by fixed joints move as one body: masses add, centers average by mass, inertias add by the
/// parallel-axis theorem. A body's frame is that of its first link; a floating body's frame sits at its
/// center of mass, so that its block of the mass matrix is diagonal.

#include <haptics/core/dynamics/linkage_model.hpp>
#include <haptics/core/dynamics/sincos.hpp>
#include <haptics/core/dynamics/split_chain.hpp>

#include <cmath>

#include "dynamics/short_chain.hpp"

namespace haptics {
namespace {

Vec2 turned(double cosine, double sine, const Vec2& v) {
    return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y()};
}

/// Frames of the links in their bodies, and the bodies with their joints; masses are filled later.
void place_links(const LinkageSpec& spec, LinkageModel& model) {
    for (int number = 0; number < model.link_count; ++number) {
        const LinkSpec& source = spec.links[static_cast<std::size_t>(number)];
        LinkModel& link = model.link[number];
        link.mass = source.mass;
        link.inertia = source.inertia;
        link.center = source.center;

        const bool is_base = model.floating && number == 0;
        // joint frame in the parent's body
        LinkModel parent;
        if (source.parent >= 0) {
            parent = model.link[source.parent];
        }
        const Pose frame = is_base ? Pose::Zero().eval() : source.joint.frame;
        const Vec2 origin = parent.origin + turned(parent.cosine, parent.sine, frame.head<2>());
        const double angle = parent.angle + frame.z();
        if (!is_base && source.joint.kind == JointKind::fixed) {
            link.slot = parent.slot;
            link.origin = origin;
            link.angle = angle;
            fast_sincos(angle, link.sine, link.cosine);
            continue;
        }
        const int slot = ++model.body_count;
        link.slot = slot;
        BodyModel& body = model.body[slot];
        body.parent = parent.slot;
        body.freedom = model.freedoms;
        body.origin = origin;
        fast_sincos(angle, body.axis.y(), body.axis.x());
        model.turn_parent[slot] = parent.slot;
        model.turn_offset[slot] = angle;
        if (is_base) {
            body.joint = BodyJoint::floating;
            model.turn_freedom[slot] = 2;
            model.turn_gain[slot] = 1.0;
            model.freedoms += 3;
            continue;
        }
        const bool turns = source.joint.kind == JointKind::revolute;
        body.joint = turns ? BodyJoint::revolute : BodyJoint::prismatic;
        model.turn_freedom[slot] = model.freedoms;
        model.turn_gain[slot] = turns ? 1.0 : 0.0;
        model.passive[model.freedoms] = source.joint;
        model.has_passive = model.has_passive || source.joint.damping > 0.0 || source.joint.friction > 0.0 ||
                            source.joint.spring_stiffness > 0.0 || std::isfinite(source.joint.lower_limit) ||
                            std::isfinite(source.joint.upper_limit);
        ++model.freedoms;
    }
}

void gather_masses(LinkageModel& model) {
    for (int number = 0; number < model.link_count; ++number) {
        const LinkModel& link = model.link[number];
        BodyModel& body = model.body[link.slot];
        body.mass += link.mass;
        body.center += link.mass * (link.origin + turned(link.cosine, link.sine, link.center));
    }
    for (int slot = 1; slot <= model.body_count; ++slot) {
        model.body[slot].center /= model.body[slot].mass;
    }
    for (int number = 0; number < model.link_count; ++number) {
        const LinkModel& link = model.link[number];
        BodyModel& body = model.body[link.slot];
        const Vec2 off = link.origin + turned(link.cosine, link.sine, link.center) - body.center;
        body.inertia += link.inertia + link.mass * off.squaredNorm();
    }
    model.body[0] = BodyModel{};
    for (int slot = 1; slot <= model.body_count; ++slot) {
        model.inverse_mass[slot] = 1.0 / model.body[slot].mass;
        model.inverse_inertia[slot] = 1.0 / model.body[slot].inertia;
    }
}

/// Moves the frame of a floating body to its center of mass.
void center_floating_base(LinkageModel& model) {
    const Vec2 shift = model.body[1].center;
    model.body[1].center.setZero();
    for (int number = 0; number < model.link_count; ++number) {
        if (model.link[number].slot == 1) {
            model.link[number].origin -= shift;
        }
    }
    for (int slot = 2; slot <= model.body_count; ++slot) {
        if (model.body[slot].parent == 1) {
            model.body[slot].origin -= shift;
        }
    }
}

/// Constants of closed_chain.hpp and split_chain.hpp when the bodies form one revolute chain.
void describe_chain(LinkageModel& model) {
    const int count = model.body_count;
    for (int slot = 1; slot <= count; ++slot) {
        const BodyModel& body = model.body[slot];
        const bool first_floats = slot == 1 && body.joint == BodyJoint::floating;
        if (body.parent != slot - 1 || (body.joint != BodyJoint::revolute && !first_floats)) {
            return;
        }
    }
    model.is_chain = true;
    double mass_beyond = 0.0;
    for (int slot = count; slot >= 1; --slot) {
        const BodyModel& body = model.body[slot];
        const Vec2 link = slot < count ? model.body[slot + 1].origin : Vec2::Zero().eval();
        const Vec2 moment = body.mass * body.center + mass_beyond * link;
        model.chain.link_x[slot] = link.x();
        model.chain.link_y[slot] = link.y();
        model.chain.moment_x[slot] = moment.x();
        model.chain.moment_y[slot] = moment.y();
        model.chain.diagonal[slot] =
            body.inertia + body.mass * body.center.squaredNorm() + mass_beyond * link.squaredNorm();
        mass_beyond += body.mass;
    }
    describe_short_chain(model);
}

DynamicsKernel choose_kernel(const LinkageModel& model) {
    if (model.floating && model.body_count == 1) {
        return DynamicsKernel::rigid_body;
    }
    if (model.is_chain && !model.floating && model.body_count <= 4) {
        return DynamicsKernel::closed_chain;
    }
    if (model.is_chain && model.body_count >= k_split_chain_minimum) {
        return DynamicsKernel::split_chain;
    }
    return DynamicsKernel::articulated;
}

} // namespace

std::vector<LinkageFault> build_model(const LinkageSpec& spec, LinkageModel& model) {
    std::vector<LinkageFault> faults = validate(spec);
    if (!faults.empty()) {
        return faults;
    }
    model = LinkageModel{};
    model.floating = spec.base == BaseKind::floating;
    model.coriolis = spec.coriolis;
    model.gravity = spec.gravity;
    model.has_gravity = !spec.gravity.isZero(0.0);
    model.link_count = static_cast<int>(spec.links.size());
    place_links(spec, model);
    gather_masses(model);
    if (model.floating) {
        center_floating_base(model);
    }
    describe_chain(model);
    model.kernel = choose_kernel(model);
    if (model.kernel == DynamicsKernel::split_chain) {
        describe_split_chain(model);
    }
    return faults;
}

} // namespace haptics
