/// Articulated-body method (Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 7), specialised to the
/// plane, in scene axes.
///
/// A body with everything beyond it, seen from its own origin, answers an acceleration (alpha, a) of that
/// origin with the wrench
///     torque = j alpha + h.a + n,   force = M a + h alpha + f,     h = m (c - o)' and M = m 1 for a lone
///     body,
/// and (n, f) = (0, -m w^2 (c - o)) its bias. A joint with motion S (revolute: (1, 0); prismatic: (0, axis))
/// leaves, with U = I S, 1/d = 1/(S.U + added), t = force - S.bias,
///     I' = I - U U^T/d,  bias' = bias + I' c + U t/d,   c = -w_p^2 d (+ 2 w_p q' axis'),
/// where c is what the origin's acceleration gets from velocities. For a revolute joint with nothing added I'
/// keeps M' = M - h h^T/j alone. Seen from the parent's origin at -d: j += 2 h.d' + d'.M d', h += M d', n +=
/// d x f. Outwards: q'' = (t - U.(alpha, a + c))/d. Gravity is an acceleration -g of the ground.

#include <haptics/core/dynamics/articulated.hpp>

namespace haptics {
namespace {

/// Inertias and bias forces of the lone bodies.
void load_bodies(const LinkageModel& model, const LinkageData& data, bool with_bias,
                 ArticulatedFactor& factor) {
    for (int slot = 1; slot <= model.body_count; ++slot) {
        const BodyModel& body = model.body[slot];
        ArticulatedBody& own = factor.body[slot];
        const double c = data.cosine[slot];
        const double s = data.sine[slot];
        const double mx = body.mass * (c * body.center.x() - s * body.center.y());
        const double my = body.mass * (s * body.center.x() + c * body.center.y());
        own.j = body.inertia + body.mass * body.center.squaredNorm();
        own.hx = -my;
        own.hy = mx;
        own.mxx = body.mass;
        own.mxy = 0.0;
        own.myy = body.mass;
        const double square = with_bias ? data.rate[slot] * data.rate[slot] : 0.0;
        own.torque = 0.0;
        own.fx = -square * mx;
        own.fy = -square * my;
    }
}

/// Adds an articulated inertia and bias force, seen from the child's origin, to the parent.
inline void carry(ArticulatedBody& parent, double dx, double dy, double j, double hx, double hy, double mxx,
                  double mxy, double myy, double torque, double fx, double fy) {
    // d' = (-dy, dx), M d'
    const double gx = mxy * dx - mxx * dy;
    const double gy = myy * dx - mxy * dy;
    parent.j += j + 2.0 * (hy * dx - hx * dy) + (gy * dx - gx * dy);
    parent.hx += hx + gx;
    parent.hy += hy + gy;
    parent.mxx += mxx;
    parent.mxy += mxy;
    parent.myy += myy;
    parent.torque += torque + (dx * fy - dy * fx);
    parent.fx += fx;
    parent.fy += fy;
}

/// Inverse of the base's articulated inertia, by elimination of the translation.
Mat3 invert_base(const ArticulatedBody& base, const LinkageVector* added) {
    Mat3 inertia;
    inertia << base.mxx, base.mxy, base.hx, base.mxy, base.myy, base.hy, base.hx, base.hy, base.j;
    if (added != nullptr) {
        inertia.diagonal() += added->head<3>();
    }
    const double determinant = inertia(0, 0) * inertia(1, 1) - inertia(0, 1) * inertia(0, 1);
    Mat2 linear;
    linear << inertia(1, 1), -inertia(0, 1), -inertia(0, 1), inertia(0, 0);
    linear /= determinant;
    const Vec2 h(base.hx, base.hy);
    const Vec2 lever = linear * h;
    const double angular = 1.0 / (inertia(2, 2) - h.dot(lever));
    Mat3 inverse;
    inverse.topLeftCorner<2, 2>() = linear + angular * lever * lever.transpose();
    inverse.topRightCorner<2, 1>() = -angular * lever;
    inverse.bottomLeftCorner<1, 2>() = -angular * lever.transpose();
    inverse(2, 2) = angular;
    return inverse;
}

/// The inward pass. `force` null factorizes only.
void sweep_inwards(const LinkageModel& model, const LinkageData& data, const LinkageVector* force,
                   const LinkageVector* added, ArticulatedFactor& factor) {
    const double keep = force != nullptr && model.coriolis ? 1.0 : 0.0;
    for (int slot = model.body_count; slot > 0; --slot) {
        const BodyModel& body = model.body[slot];
        ArticulatedBody& own = factor.body[slot];
        if (body.joint == BodyJoint::floating) {
            factor.base_inverse = invert_base(own, added);
            continue;
        }
        const double dx = data.arm_x[slot];
        const double dy = data.arm_y[slot];
        const double rate = data.rate[body.parent];
        const double square = keep * rate * rate;
        double cx = -square * dx;
        double cy = -square * dy;
        const double extra = added != nullptr ? (*added)[body.freedom] : 0.0;
        double free_force = force != nullptr ? (*force)[body.freedom] : 0.0;
        ArticulatedBody& parent = factor.body[body.parent];
        if (body.joint == BodyJoint::revolute) {
            own.u = own.j;
            own.ux = own.hx;
            own.uy = own.hy;
            own.inverse = 1.0 / (own.j + extra);
            free_force -= own.torque;
        } else {
            const double ax = data.axis_x[slot];
            const double ay = data.axis_y[slot];
            own.u = own.hx * ax + own.hy * ay;
            own.ux = own.mxx * ax + own.mxy * ay;
            own.uy = own.mxy * ax + own.myy * ay;
            own.inverse = 1.0 / (own.ux * ax + own.uy * ay + extra);
            free_force -= own.fx * ax + own.fy * ay;
            const double twice = keep * 2.0 * rate * data.velocity[body.freedom];
            cx -= twice * ay;
            cy += twice * ax;
        }
        own.free_force = free_force;
        const double ratio = free_force * own.inverse;
        const double wx = own.ux * own.inverse;
        const double wy = own.uy * own.inverse;
        double j = 0.0;
        double hx = 0.0;
        double hy = 0.0;
        if (body.joint != BodyJoint::revolute || extra != 0.0) {
            j = own.j - own.u * own.inverse * own.u;
            hx = own.hx - own.u * wx;
            hy = own.hy - own.u * wy;
        }
        const double mxx = own.mxx - own.ux * wx;
        const double mxy = own.mxy - own.ux * wy;
        const double myy = own.myy - own.uy * wy;
        const double torque = own.torque + (hx * cx + hy * cy) + own.u * ratio;
        const double fx = own.fx + (mxx * cx + mxy * cy) + own.ux * ratio;
        const double fy = own.fy + (mxy * cx + myy * cy) + own.uy * ratio;
        if (body.parent > 0) {
            carry(parent, dx, dy, j, hx, hy, mxx, mxy, myy, torque, fx, fy);
        }
    }
}

/// Acceleration of a body's origin.
struct Motion {
    double angular;
    double x;
    double y;
};

} // namespace

void factorize(const LinkageModel& model, const LinkageData& data, const LinkageVector* added,
               ArticulatedFactor& factor) {
    load_bodies(model, data, false, factor);
    sweep_inwards(model, data, nullptr, added, factor);
}

void articulated_acceleration(const LinkageModel& model, const LinkageData& data, const LinkageVector& force,
                              const LinkageVector* added, ArticulatedFactor& factor,
                              LinkageVector& acceleration) {
    load_bodies(model, data, model.coriolis, factor);
    sweep_inwards(model, data, &force, added, factor);
    const double keep = model.coriolis ? 1.0 : 0.0;
    acceleration.resize(model.freedoms);
    Motion motion[k_body_slots];
    motion[0] = {0.0, -model.gravity.x(), -model.gravity.y()};
    for (int slot = 1; slot <= model.body_count; ++slot) {
        const BodyModel& body = model.body[slot];
        const ArticulatedBody& own = factor.body[slot];
        if (body.joint == BodyJoint::floating) {
            Vec3 right(force[0] - own.fx, force[1] - own.fy, force[2] - own.torque);
            if (added != nullptr) {
                // the added diagonal acts on the true acceleration, not on the one relative to free fall
                right.head<2>() -= added->head<2>().cwiseProduct(model.gravity);
            }
            const Vec3 base = factor.base_inverse * right;
            motion[slot] = {base.z(), base.x(), base.y()};
            acceleration[0] = base.x() + model.gravity.x();
            acceleration[1] = base.y() + model.gravity.y();
            acceleration[2] = base.z();
            continue;
        }
        const Motion& parent = motion[body.parent];
        const double dx = data.arm_x[slot];
        const double dy = data.arm_y[slot];
        const double rate = data.rate[body.parent];
        const double square = keep * rate * rate;
        Motion own_motion{parent.angular, parent.x - parent.angular * dy - square * dx,
                          parent.y + parent.angular * dx - square * dy};
        if (body.joint == BodyJoint::prismatic) {
            const double twice = keep * 2.0 * rate * data.velocity[body.freedom];
            own_motion.x -= twice * data.axis_y[slot];
            own_motion.y += twice * data.axis_x[slot];
        }
        const double q =
            (own.free_force - (own.u * own_motion.angular + own.ux * own_motion.x + own.uy * own_motion.y)) *
            own.inverse;
        acceleration[body.freedom] = q;
        if (body.joint == BodyJoint::revolute) {
            own_motion.angular += q;
        } else {
            own_motion.x += q * data.axis_x[slot];
            own_motion.y += q * data.axis_y[slot];
        }
        motion[slot] = own_motion;
    }
}

void solve(const LinkageModel& model, const LinkageData& data, const ArticulatedFactor& factor,
           const LinkageVector& right_side, LinkageVector& solution) {
    // bias wrenches inwards
    Motion bias[k_body_slots];
    double free_force[k_body_slots];
    for (int slot = 0; slot <= model.body_count; ++slot) {
        bias[slot] = {0.0, 0.0, 0.0};
    }
    for (int slot = model.body_count; slot > 0; --slot) {
        const BodyModel& body = model.body[slot];
        const ArticulatedBody& own = factor.body[slot];
        if (body.joint == BodyJoint::floating) {
            continue;
        }
        const Motion& at = bias[slot];
        const double projected = body.joint == BodyJoint::revolute
                                     ? at.angular
                                     : at.x * data.axis_x[slot] + at.y * data.axis_y[slot];
        free_force[slot] = right_side[body.freedom] - projected;
        const double ratio = free_force[slot] * own.inverse;
        const double fx = at.x + own.ux * ratio;
        const double fy = at.y + own.uy * ratio;
        Motion& parent = bias[body.parent];
        parent.x += fx;
        parent.y += fy;
        parent.angular += at.angular + own.u * ratio + (data.arm_x[slot] * fy - data.arm_y[slot] * fx);
    }
    // accelerations outwards
    solution.resize(model.freedoms);
    Motion motion[k_body_slots];
    motion[0] = {0.0, 0.0, 0.0};
    for (int slot = 1; slot <= model.body_count; ++slot) {
        const BodyModel& body = model.body[slot];
        const ArticulatedBody& own = factor.body[slot];
        if (body.joint == BodyJoint::floating) {
            const Vec3 base =
                factor.base_inverse * Vec3(right_side[0] - bias[slot].x, right_side[1] - bias[slot].y,
                                           right_side[2] - bias[slot].angular);
            motion[slot] = {base.z(), base.x(), base.y()};
            solution.head<3>() = base;
            continue;
        }
        const Motion& parent = motion[body.parent];
        Motion own_motion{parent.angular, parent.x - parent.angular * data.arm_y[slot],
                          parent.y + parent.angular * data.arm_x[slot]};
        const double q = (free_force[slot] -
                          (own.u * own_motion.angular + own.ux * own_motion.x + own.uy * own_motion.y)) *
                         own.inverse;
        solution[body.freedom] = q;
        if (body.joint == BodyJoint::revolute) {
            own_motion.angular += q;
        } else {
            own_motion.x += q * data.axis_x[slot];
            own_motion.y += q * data.axis_y[slot];
        }
        motion[slot] = own_motion;
    }
}

} // namespace haptics
