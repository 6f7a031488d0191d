/// Long revolute chains by joint forces instead of joint motions, eliminated from four places at once.
///
/// Let X_j be the force that joint j hands to its next body, r_a and r_b the arms from a body's center of
/// mass to the joints where it is entered and left, p = r_a', q = r_b' (turned by 90 degrees), t the torque
/// on the body, all seen in free fall. Newton and Euler give the accelerations of both ends, linear in the
/// two forces; equal accelerations at every joint make a block-tridiagonal system,
///     E_{j-1}^T X_{j-1} + (P_{j-1} + N_j) X_j + E_j X_{j+1} = far_{j-1} + near_j,
///     N = 1/m + p p^T/I,   P = 1/m + q q^T/I,   E = -(1/m + p q^T/I),   near = -(p t/I - w^2 r_a),   far = q
///     t/I - w^2 r_b,
/// symmetric and positive definite. It reads the same backwards, with -X for X. So four lanes eliminate it
/// towards two meeting joints: up from the near end, down and up from a separator joint in the middle, down
/// from the far end. The two lanes that start at the separator carry their coupling W with it along. What
/// remains has three unknowns. Then the four lanes substitute back, and I phi'' = t + p.X_j - q.X_{j+1}. One
/// step, with C and c what the eliminated side adds to the joint's diagonal and right side:
///     S = C + N, r = c + near, C' = P - E^T S^-1 E, c' = far - E^T S^-1 r, W' = -E^T S^-1 W,
/// S^-1 = adj(S)/det(S), so that the division runs beside the products.

#include <haptics/core/dynamics/multiversion.hpp>
#include <haptics/core/dynamics/sincos.hpp>
#include <haptics/core/dynamics/split_chain.hpp>

namespace haptics {
namespace {

/// One number in each lane, as it lies in memory.
struct LaneRow {
    double value[4];
};

/// What a step leaves for the substitution.
struct StepMemory {
    LaneRow gxx, gxy, gyx, gyy; // S^-1 E
    LaneRow hxx, hxy, hyx, hyy; // S^-1 W
    LaneRow yx, yy;             // S^-1 r
    LaneRow px, py, qx, qy, turn;
};

HAPTICS_ALWAYS_INLINE void load(Lanes& lanes, const double* memory) {
    std::memcpy(&lanes, memory, sizeof(lanes));
}
HAPTICS_ALWAYS_INLINE void store(LaneRow& row, const Lanes& lanes) {
    std::memcpy(row.value, &lanes, sizeof(lanes));
}

/// A body in each lane, in scene axes.
struct BodyLanes {
    Lanes px, py, qx, qy;         // arms turned by 90 degrees
    Lanes nxx, nxy, nyy;          // N
    Lanes far_xx, far_xy, far_yy; // P
    Lanes exx, exy, eyx, eyy;     // E
    Lanes near_x, near_y, far_x, far_y;
    Lanes turn; // t / I
};

HAPTICS_ALWAYS_INLINE void load_body(const SplitStep& step, const LinkageData& data, const double* torque,
                                     double keep, BodyLanes& body) {
    const int b0 = step.slot[0];
    const int b1 = step.slot[1];
    const int b2 = step.slot[2];
    const int b3 = step.slot[3];
    const Lanes c = {data.cosine[b0], data.cosine[b1], data.cosine[b2], data.cosine[b3]};
    const Lanes s = {data.sine[b0], data.sine[b1], data.sine[b2], data.sine[b3]};
    const Lanes w = {data.rate[b0], data.rate[b1], data.rate[b2], data.rate[b3]};
    const Lanes t = {torque[b0], torque[b1], torque[b2], torque[b3]};
    Lanes ax;
    Lanes ay;
    Lanes bx;
    Lanes by;
    Lanes mass;
    Lanes inertia;
    load(ax, step.entry_x);
    load(ay, step.entry_y);
    load(bx, step.exit_x);
    load(by, step.exit_y);
    load(mass, step.inverse_mass);
    load(inertia, step.inverse_inertia);
    body.py = c * ax - s * ay;
    body.px = -(s * ax + c * ay);
    body.qy = c * bx - s * by;
    body.qx = -(s * bx + c * by);
    body.turn = t * inertia;
    const Lanes square = w * w * keep;
    body.near_x = square * body.py - body.px * body.turn;
    body.near_y = -(square * body.px + body.py * body.turn);
    body.far_x = body.qx * body.turn - square * body.qy;
    body.far_y = body.qy * body.turn + square * body.qx;
    const Lanes ipx = inertia * body.px;
    const Lanes ipy = inertia * body.py;
    const Lanes iqx = inertia * body.qx;
    const Lanes iqy = inertia * body.qy;
    body.nxx = mass + ipx * body.px;
    body.nxy = ipx * body.py;
    body.nyy = mass + ipy * body.py;
    body.far_xx = mass + iqx * body.qx;
    body.far_xy = iqx * body.qy;
    body.far_yy = mass + iqy * body.qy;
    body.exx = -(mass + ipx * body.qx);
    body.exy = -(ipx * body.qy);
    body.eyx = -(ipy * body.qx);
    body.eyy = -(mass + ipy * body.qy);
}

/// A 2 x 2 symmetric matrix and a vector, for what remains at the end.
struct Block {
    Mat2 matrix;
    Vec2 right;
};

/// Solves the three blocks: left - separator - right, coupled by `left_w` and `right_w` (rows of the meeting
/// points).
inline void solve_remainder(const Block& left, const Mat2& left_w, const Block& middle, const Block& right,
                            const Mat2& right_w, Vec2& x_left, Vec2& x_middle, Vec2& x_right) {
    const auto inverse = [](const Mat2& m) {
        const double scale = 1.0 / (m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1));
        Mat2 result;
        result << m(1, 1) * scale, -m(0, 1) * scale, -m(0, 1) * scale, m(0, 0) * scale;
        return result;
    };
    const Mat2 left_inverse = inverse(left.matrix);
    const Mat2 right_inverse = inverse(right.matrix);
    const Mat2 left_h = left_inverse * left_w;
    const Mat2 right_h = right_inverse * right_w;
    const Vec2 left_y = left_inverse * left.right;
    const Vec2 right_y = right_inverse * right.right;
    const Mat2 matrix = middle.matrix - left_w.transpose() * left_h - right_w.transpose() * right_h;
    x_middle = inverse(matrix) * (middle.right - left_w.transpose() * left_y - right_w.transpose() * right_y);
    x_left = left_y - left_h * x_middle;
    x_right = right_y - right_h * x_middle;
}

HAPTICS_ALWAYS_INLINE void run(const LinkageModel& model, const LinkageData& data, const double* force,
                               double* acceleration) {
    const SplitModel& split = model.split;
    const int count = model.body_count;
    const int offset = model.floating ? 2 : 0;
    const double keep = model.coriolis ? 1.0 : 0.0;

    // torque on each body
    double torque[k_body_slots];
    torque[0] = 0.0;
    for (int i = 1; i < count; ++i) {
        torque[i] = force[offset + i - 1] - force[offset + i];
    }
    torque[count] = force[offset + count - 1];

    // start bodies
    StepMemory memory[k_split_steps];
    BodyLanes body;
    load_body(split.step[0], data, torque, keep, body);
    store(memory[0].px, body.px);
    store(memory[0].py, body.py);
    store(memory[0].qx, body.qx);
    store(memory[0].qy, body.qy);
    store(memory[0].turn, body.turn);
    Lanes cxx = body.far_xx;
    Lanes cxy = body.far_xy;
    Lanes cyy = body.far_yy;
    Lanes cx = body.far_x;
    Lanes cy = body.far_y;
    const double base_x = model.floating ? force[0] * model.inverse_mass[1] : -model.gravity.x();
    const double base_y = model.floating ? force[1] * model.inverse_mass[1] : -model.gravity.y();
    cx += Lanes{base_x, 0.0, 0.0, 0.0};
    cy += Lanes{base_y, 0.0, 0.0, 0.0};
    const Lanes sign = {0.0, -1.0, 1.0, 0.0};
    Lanes wxx = sign * body.exx;
    Lanes wxy = sign * body.eyx;
    Lanes wyx = sign * body.exy;
    Lanes wyy = sign * body.eyy;
    Block middle;
    middle.matrix << body.nxx[1] + body.nxx[2], body.nxy[1] + body.nxy[2], body.nxy[1] + body.nxy[2],
        body.nyy[1] + body.nyy[2];
    middle.right << body.near_x[2] - body.near_x[1], body.near_y[2] - body.near_y[1];

    // elimination
    Lanes qxx = {0.0, 0.0, 0.0, 0.0};
    Lanes qxy = qxx;
    Lanes qyy = qxx;
    Lanes qx = qxx;
    Lanes qy = qxx;
    for (int i = 1; i <= split.steps; ++i) {
        StepMemory& own = memory[i];
        load_body(split.step[i], data, torque, keep, body);
        const Lanes sxx = cxx + body.nxx;
        const Lanes sxy = cxy + body.nxy;
        const Lanes syy = cyy + body.nyy;
        const Lanes rx = cx + body.near_x;
        const Lanes ry = cy + body.near_y;
        Lanes inverse = 1.0 / (sxx * syy - sxy * sxy);
        const Lanes uxx = syy * body.exx - sxy * body.eyx;
        const Lanes uxy = syy * body.exy - sxy * body.eyy;
        const Lanes uyx = sxx * body.eyx - sxy * body.exx;
        const Lanes uyy = sxx * body.eyy - sxy * body.exy;
        const Lanes zx = syy * rx - sxy * ry;
        const Lanes zy = sxx * ry - sxy * rx;
        const Lanes next_cxx = body.far_xx - inverse * (body.exx * uxx + body.eyx * uyx);
        const Lanes next_cxy = body.far_xy - inverse * (body.exx * uxy + body.eyx * uyy);
        const Lanes next_cyy = body.far_yy - inverse * (body.exy * uxy + body.eyy * uyy);
        const Lanes next_cx = body.far_x - inverse * (body.exx * zx + body.eyx * zy);
        const Lanes next_cy = body.far_y - inverse * (body.exy * zx + body.eyy * zy);
        store(own.gxx, inverse * uxx);
        store(own.gxy, inverse * uxy);
        store(own.gyx, inverse * uyx);
        store(own.gyy, inverse * uyy);
        store(own.yx, inverse * zx);
        store(own.yy, inverse * zy);
        store(own.px, body.px);
        store(own.py, body.py);
        store(own.qx, body.qx);
        store(own.qy, body.qy);
        store(own.turn, body.turn);
        // the separator's share; lanes that idle in the last step add nothing
        Lanes active;
        load(active, split.step[i].active);
        const Lanes hxx = inverse * (syy * wxx - sxy * wyx);
        const Lanes hxy = inverse * (syy * wxy - sxy * wyy);
        const Lanes hyx = inverse * (sxx * wyx - sxy * wxx);
        const Lanes hyy = inverse * (sxx * wyy - sxy * wxy);
        store(own.hxx, hxx);
        store(own.hxy, hxy);
        store(own.hyx, hyx);
        store(own.hyy, hyy);
        qxx += active * (wxx * hxx + wyx * hyx);
        qxy += active * (wxx * hxy + wyx * hyy);
        qyy += active * (wxy * hxy + wyy * hyy);
        qx += active * (hxx * rx + hyx * ry);
        qy += active * (hxy * rx + hyy * ry);
        if (i == split.steps && split.idle) {
            // lanes with one step less keep what they have
            const Lanes rest = 1.0 - active;
            cxx = active * next_cxx + rest * cxx;
            cxy = active * next_cxy + rest * cxy;
            cyy = active * next_cyy + rest * cyy;
            cx = active * next_cx + rest * cx;
            cy = active * next_cy + rest * cy;
            wxx = rest * wxx - active * (body.exx * hxx + body.eyx * hyx);
            wxy = rest * wxy - active * (body.exx * hxy + body.eyx * hyy);
            wyx = rest * wyx - active * (body.exy * hxx + body.eyy * hyx);
            wyy = rest * wyy - active * (body.exy * hxy + body.eyy * hyy);
        } else {
            cxx = next_cxx;
            cxy = next_cxy;
            cyy = next_cyy;
            cx = next_cx;
            cy = next_cy;
            wxx = -(body.exx * hxx + body.eyx * hyx);
            wxy = -(body.exx * hxy + body.eyx * hyy);
            wyx = -(body.exy * hxx + body.eyy * hyx);
            wyy = -(body.exy * hxy + body.eyy * hyy);
        }
    }

    // two meeting points and the separator: lanes 1 and 3 come with the opposite sign
    Block left;
    Block right;
    Mat2 left_w;
    Mat2 right_w;
    left.matrix << cxx[0] + cxx[1], cxy[0] + cxy[1], cxy[0] + cxy[1], cyy[0] + cyy[1];
    left.right << cx[0] - cx[1], cy[0] - cy[1];
    left_w << -wxx[1], -wxy[1], -wyx[1], -wyy[1];
    right.matrix << cxx[2] + cxx[3], cxy[2] + cxy[3], cxy[2] + cxy[3], cyy[2] + cyy[3];
    right.right << cx[2] - cx[3], cy[2] - cy[3];
    right_w << wxx[2], wxy[2], wyx[2], wyy[2];
    middle.matrix(0, 0) -= qxx[1] + qxx[2];
    middle.matrix(0, 1) -= qxy[1] + qxy[2];
    middle.matrix(1, 0) = middle.matrix(0, 1);
    middle.matrix(1, 1) -= qyy[1] + qyy[2];
    middle.right -= Vec2(qx[1] + qx[2], qy[1] + qy[2]);
    Vec2 x_left;
    Vec2 x_middle;
    Vec2 x_right;
    solve_remainder(left, left_w, middle, right, right_w, x_left, x_middle, x_right);

    // substitution, and the angular acceleration of each body
    double phi[k_body_slots];
    phi[0] = 0.0;
    Lanes next_x = {x_left.x(), -x_left.x(), x_right.x(), -x_right.x()};
    Lanes next_y = {x_left.y(), -x_left.y(), x_right.y(), -x_right.y()};
    for (int i = split.steps; i >= 0; --i) {
        const StepMemory& own = memory[i];
        const SplitStep& step = split.step[i];
        Lanes x;
        Lanes y;
        Lanes a;
        Lanes b;
        if (i == 0) {
            // the start bodies are entered by the separator's force, or by none
            x = sign * x_middle.x();
            y = sign * x_middle.y();
        } else {
            Lanes hxx;
            Lanes hxy;
            Lanes hyx;
            Lanes hyy;
            load(hxx, own.hxx.value);
            load(hxy, own.hxy.value);
            load(hyx, own.hyx.value);
            load(hyy, own.hyy.value);
            load(x, own.yx.value);
            load(y, own.yy.value);
            x -= hxx * x_middle.x() + hxy * x_middle.y();
            y -= hyx * x_middle.x() + hyy * x_middle.y();
            load(a, own.gxx.value);
            load(b, own.gxy.value);
            x -= a * next_x + b * next_y;
            load(a, own.gyx.value);
            load(b, own.gyy.value);
            y -= a * next_x + b * next_y;
        }
        Lanes turn;
        Lanes inertia;
        load(turn, own.turn.value);
        load(inertia, step.inverse_inertia);
        load(a, own.px.value);
        load(b, own.py.value);
        Lanes moment = a * x + b * y;
        load(a, own.qx.value);
        load(b, own.qy.value);
        moment -= a * next_x + b * next_y;
        turn += inertia * moment;
        if (i == split.steps && split.idle) {
            Lanes active;
            load(active, step.active);
            const Lanes rest = 1.0 - active;
            x = active * x + rest * next_x;
            y = active * y + rest * next_y;
        }
        if (i == 0 && model.floating) {
            acceleration[0] = base_x - next_x[0] * model.inverse_mass[1] + model.gravity.x();
            acceleration[1] = base_y - next_y[0] * model.inverse_mass[1] + model.gravity.y();
        }
        next_x = x;
        next_y = y;
        // idle lanes and the ground point at the last, unused slot
        phi[step.target[0]] = turn[0];
        phi[step.target[1]] = turn[1];
        phi[step.target[2]] = turn[2];
        phi[step.target[3]] = turn[3];
    }
    for (int i = 1; i <= count; ++i) {
        acceleration[offset + i - 1] = phi[i] - phi[i - 1];
    }
}

HAPTICS_BASELINE void run_baseline(const LinkageModel& model, const LinkageData& data, const double* force,
                                   double* acceleration) {
    run(model, data, force, acceleration);
}

#if HAPTICS_MULTIVERSION
HAPTICS_AVX2 void run_avx2(const LinkageModel& model, const LinkageData& data, const double* force,
                           double* acceleration) {
    run(model, data, force, acceleration);
}
#endif

} // namespace

void split_chain_acceleration(const LinkageModel& model, const LinkageData& data, const LinkageVector& force,
                              LinkageVector& acceleration) {
    acceleration.resize(model.freedoms);
#if HAPTICS_MULTIVERSION
    if (k_has_avx2) {
        run_avx2(model, data, force.data(), acceleration.data());
        return;
    }
#endif
    run_baseline(model, data, force.data(), acceleration.data());
}

} // namespace haptics
