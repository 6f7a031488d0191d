/// Composite-rigid-body and Newton-Euler methods, specialised to the plane, in scene axes.
///
/// A rigid body (or a composite of bodies) seen from its origin o has mass m, first moment h = m (c - o) and
/// inertia J about o. An acceleration (alpha, a) of o takes the torque J alpha + h x a about o and the force
/// m a + alpha h'. Composite: everything beyond a joint moves as one, so column s of D is that wrench for the
/// joint's own motion, carried inwards to each joint between s and the ground and projected on its motion.
/// Newton-Euler: accelerations outwards (a_s = a_p + alpha_p d' - w_p^2 d + joint terms), wrenches inwards,
/// with the ground accelerating by -g in the place of gravity.

#include <haptics/core/dynamics/mass_matrix.hpp>

namespace haptics {
namespace {

/// Wrench about an origin, or an acceleration of it.
struct Planar {
    double angular{0.0};
    double x{0.0};
    double y{0.0};
};

/// Mass, first moment and inertia about an origin.
struct Composite {
    double mass{0.0};
    double hx{0.0};
    double hy{0.0};
    double inertia{0.0};
};

Vec2 center_arm(const LinkageModel& model, const LinkageData& data, int slot) {
    const Vec2& center = model.body[slot].center;
    const double c = data.cosine[slot];
    const double s = data.sine[slot];
    return {c * center.x() - s * center.y(), s * center.x() + c * center.y()};
}

Planar wrench_for(const Composite& part, const Planar& motion) {
    return {part.inertia * motion.angular + part.hx * motion.y - part.hy * motion.x,
            part.mass * motion.x - motion.angular * part.hy, part.mass * motion.y + motion.angular * part.hx};
}

/// Writes wrench^T motion for every freedom of the joint at `slot` through write(freedom, value).
template <class Write>
void project(const LinkageModel& model, const LinkageData& data, int slot, const Planar& wrench,
             const Write& write) {
    const BodyModel& body = model.body[slot];
    switch (body.joint) {
    case BodyJoint::revolute:
        write(body.freedom, wrench.angular);
        break;
    case BodyJoint::prismatic:
        write(body.freedom, wrench.x * data.axis_x[slot] + wrench.y * data.axis_y[slot]);
        break;
    case BodyJoint::floating:
        write(0, wrench.x);
        write(1, wrench.y);
        write(2, wrench.angular);
        break;
    }
}

} // namespace

void mass_matrix(const LinkageModel& model, const LinkageData& data, LinkageMatrix& mass) {
    mass.setZero(model.freedoms, model.freedoms);
    Composite part[k_body_slots];
    for (int slot = 1; slot <= model.body_count; ++slot) {
        const BodyModel& body = model.body[slot];
        const Vec2 arm = center_arm(model, data, slot);
        part[slot] = {body.mass, body.mass * arm.x(), body.mass * arm.y(),
                      body.inertia + body.mass * body.center.squaredNorm()};
    }
    for (int slot = model.body_count; slot > 0; --slot) {
        const BodyModel& body = model.body[slot];
        const Composite& own = part[slot];
        // columns of this joint
        const int columns = body.joint == BodyJoint::floating ? 3 : 1;
        for (int column = 0; column < columns; ++column) {
            Planar motion;
            if (body.joint == BodyJoint::revolute) {
                motion.angular = 1.0;
            } else if (body.joint == BodyJoint::prismatic) {
                motion = {0.0, data.axis_x[slot], data.axis_y[slot]};
            } else {
                motion = {column == 2 ? 1.0 : 0.0, column == 0 ? 1.0 : 0.0, column == 1 ? 1.0 : 0.0};
            }
            Planar wrench = wrench_for(own, motion);
            const int index = body.freedom + column;
            for (int at = slot; at > 0; at = model.body[at].parent) {
                project(model, data, at, wrench, [&](int freedom, double value) {
                    mass(freedom, index) = value;
                    mass(index, freedom) = value;
                });
                wrench.angular += data.arm_x[at] * wrench.y - data.arm_y[at] * wrench.x;
            }
        }
        // carry the composite to the parent's origin
        Composite& parent = part[body.parent];
        const double dx = data.arm_x[slot];
        const double dy = data.arm_y[slot];
        parent.mass += own.mass;
        parent.hx += own.hx + own.mass * dx;
        parent.hy += own.hy + own.mass * dy;
        parent.inertia += own.inertia + 2.0 * (own.hx * dx + own.hy * dy) + own.mass * (dx * dx + dy * dy);
    }
}

namespace {

void newton_euler(const LinkageModel& model, const LinkageData& data, const Vec2& gravity,
                  const LinkageVector& acceleration, LinkageVector& force) {
    const double keep = model.coriolis ? 1.0 : 0.0;
    Planar motion[k_body_slots];
    Planar wrench[k_body_slots];
    motion[0] = {0.0, -gravity.x(), -gravity.y()};
    for (int slot = 1; slot <= model.body_count; ++slot) {
        const BodyModel& body = model.body[slot];
        Planar& own = motion[slot];
        own = motion[body.parent];
        if (body.joint == BodyJoint::floating) {
            own.x += acceleration[0];
            own.y += acceleration[1];
            own.angular += acceleration[2];
        } else {
            const double rate = data.rate[body.parent];
            const double square = keep * rate * rate;
            const double dx = data.arm_x[slot];
            const double dy = data.arm_y[slot];
            own.x += -own.angular * dy - square * dx;
            own.y += own.angular * dx - square * dy;
            if (body.joint == BodyJoint::revolute) {
                own.angular += acceleration[body.freedom];
            } else {
                const double along = acceleration[body.freedom];
                const double across = keep * 2.0 * rate * data.velocity[body.freedom];
                own.x += along * data.axis_x[slot] - across * data.axis_y[slot];
                own.y += along * data.axis_y[slot] + across * data.axis_x[slot];
            }
        }
        const Vec2 arm = center_arm(model, data, slot);
        const Composite part{body.mass, body.mass * arm.x(), body.mass * arm.y(),
                             body.inertia + body.mass * body.center.squaredNorm()};
        wrench[slot] = wrench_for(part, own);
        const double square = keep * data.rate[slot] * data.rate[slot];
        wrench[slot].x -= square * part.hx;
        wrench[slot].y -= square * part.hy;
    }
    force.resize(model.freedoms);
    for (int slot = model.body_count; slot > 0; --slot) {
        const Planar own = wrench[slot];
        project(model, data, slot, own, [&](int freedom, double value) { force[freedom] = value; });
        Planar& parent = wrench[model.body[slot].parent];
        parent.x += own.x;
        parent.y += own.y;
        parent.angular += own.angular + data.arm_x[slot] * own.y - data.arm_y[slot] * own.x;
    }
}

} // namespace

void inverse_dynamics(const LinkageModel& model, const LinkageData& data, const LinkageVector& acceleration,
                      LinkageVector& force) {
    newton_euler(model, data, model.gravity, acceleration, force);
}

void bias_forces(const LinkageModel& model, const LinkageData& data, const Vec2& gravity,
                 LinkageVector& bias) {
    LinkageVector none;
    none.setZero(model.freedoms);
    newton_euler(model, data, gravity, none, bias);
}

void bias_forces(const LinkageModel& model, const LinkageData& data, LinkageVector& bias) {
    bias_forces(model, data, model.gravity, bias);
}

} // namespace haptics
