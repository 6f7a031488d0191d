// A rigid tool among what it cannot move, over a whole step without collisions.
//
// The equation is that of integrate.cpp with D = diag(m, m, I) and rows [n_x, n_y, r x n]: three unknowns,
// whatever the number of contacts. So the contacts of the step are read once into a few numbers each, the
// equation is summed up and solved, and the results go straight back to the patches: no mass matrix, no rows
// in memory, no islands. The operations on the motion are those of the general path and in the same order, so
// it is the same to the last bit, and one step may take this path and the next the other.
//
// The general path is left to what is rare: a point that closes within the step, matter that fades, sets that
// do not settle. Nothing is written before it is known that none of these happens.

#include <algorithm>
#include <cmath>

#include "contact_rules.hpp"
#include "explicit_step.hpp"
#include "internal.hpp"
#include "outcome.hpp"
#include "primal_solver.hpp"
#include "rigid_grip.hpp"
#include "small_solve.hpp"

namespace haptics::local {
namespace {

// The numbers of one point that a step needs. Not set before they are written: there is room for many.
struct Point {
    double turn; // of its row; x and y are those of the patch
    double gap;
    double stiffness;
    double damping;
    double drive;
    double rate;
    double force;
    bool active;
};

// A patch with its points and its friction.
struct Contact {
    double nx;
    double ny;
    int points;
    bool rough;
    bool was_sliding;
    FrictionMode mode;
    std::array<Point, 2> point;
    double slip_turn; // of the tangent's row [-n_y, n_x, r x t]
    double stiffness;
    double damping;
    double static_friction;
    double dynamic_friction;
    double drive;
    double spring;
    double force;

    [[nodiscard]] double rate(const Point& p, const Plain3& v) const {
        return Plain3{nx, ny, p.turn}.dot(v) - p.drive;
    }
    [[nodiscard]] double slip_rate(const Plain3& v) const {
        return Plain3{-ny, nx, slip_turn}.dot(v) - drive;
    }
    [[nodiscard]] double pressing() const {
        return points > 1 ? point[0].force + point[1].force : point[0].force;
    }

    // friction that follows from the force of a stuck spring
    void rub(double trial) {
        const double presses = pressing();
        if (presses <= 0.0) {
            mode = FrictionMode::off;
            force = 0.0;
            return;
        }
        const double bound = (slips(mode) || was_sliding ? dynamic_friction : static_friction) * presses;
        if (std::abs(trial) <= bound) {
            mode = FrictionMode::stick;
            force = trial;
            return;
        }
        mode = trial > 0.0 ? FrictionMode::slip_forward : FrictionMode::slip_backward;
        force = slip_sign(mode) * dynamic_friction * presses;
    }
};

class RigidContacts {
  public:
    RigidContacts(const Model& model, const Data& data, double dt)
        : model_(model)
        , data_(data)
        , dt_(dt)
        , awaits_hits_(data.plan.runs(Stage::collisions) && model.settings.max_events > 0 &&
                       model.settings.contact_mode != ContactMode::penalty) {}

    // reads the contacts; false when one of them is not for this path
    bool read() {
        const bool rough = data_.plan.runs(Stage::friction);
        const bool walls_move = data_.plan.runs(Stage::moving_walls);
        const double center_x = data_.pose.x();
        const double center_y = data_.pose.y();
        const Plain3 v = plain(data_.velocity);
        count_ = data_.patches.count;
        for (int i = 0; i < count_; ++i) {
            const Patch& p = data_.patches.patch[static_cast<std::size_t>(i)];
            if (p.presence < 1.0 || p.body_a != 0)
                return false;
            const Body* other =
                walls_move ? &data_.neighbors.body[static_cast<std::size_t>(p.body_b - 1)] : nullptr;
            const bool continuing = p.memory.state != ContactState::none;
            Contact& c = contact_[static_cast<std::size_t>(i)];
            c.nx = p.normal.x();
            c.ny = p.normal.y();
            c.points = p.point_count;
            double middle_x = 0.0;
            double middle_y = 0.0;
            for (int k = 0; k < p.point_count; ++k) {
                const PatchPoint& from = p.point[static_cast<std::size_t>(k)];
                Point& to = c.point[static_cast<std::size_t>(k)];
                const double x = from.position.x();
                const double y = from.position.y();
                to.turn = (x - center_x) * c.ny - (y - center_y) * c.nx;
                to.drive = other == nullptr ? 0.0 : drive(*other, from.position, p.normal);
                to.gap = from.gap;
                to.stiffness = p.surface.stiffness * from.weight;
                to.damping = p.surface.damping * from.weight;
                to.rate = c.rate(to, v);
                to.force = 0.0;
                // what presses now keeps pressing
                to.active = to.gap < 0.0;
                any_open_ = any_open_ || !to.active;
                if (awaits_hits_ && !(to.active && continuing) && closes(to, continuing))
                    return false;
                middle_x += from.weight * x;
                middle_y += from.weight * y;
            }
            c.stiffness = p.surface.stiffness;
            c.damping = p.surface.damping;
            c.static_friction = std::max(p.surface.static_friction, p.surface.dynamic_friction);
            c.dynamic_friction = p.surface.dynamic_friction;
            c.spring = p.memory.slip_spring;
            c.was_sliding = p.memory.state == ContactState::sliding;
            c.rough = rough && c.static_friction > 0.0;
            // and what may stick, sticks
            c.mode = c.rough ? FrictionMode::stick : FrictionMode::off;
            c.force = 0.0;
            c.drive = 0.0;
            c.slip_turn = (middle_x - center_x) * c.nx + (middle_y - center_y) * c.ny;
            if (c.rough && other != nullptr)
                c.drive = drive(*other, {middle_x, middle_y}, perpendicular(p.normal));
        }
        return true;
    }

    // the velocity at the end of the step; false when it is not for this path
    bool solve(const RigidCoupling* coupling, const UsedCoupling& used, Plain3& v) {
        const ToolModel& tool = model_.tool;
        const Plain3 mass{tool.mass, tool.mass, tool.inertia};
        Arrow base{mass.x, mass.y, mass.z};
        Plain3 right = mass * plain(data_.velocity) + dt_ * weight();
        if (coupling != nullptr)
            coupling->add(used, base, right);
        const bool semi_implicit = model_.settings.integrator == Integrator::semi_implicit;
        gave_way_ = semi_implicit && !model_.settings.strictly_semi_implicit && !is_stable();
        if (semi_implicit && !gave_way_) {
            start_forces(right);
            v = base.solve(right);
            return true;
        }
        start_sets();
        for (int left = k_max_iterations; left > 0; --left) {
            solve_sets(base, right, v);
            if (update_sets(v))
                return true;
        }
        return false;
    }

    // the forces were those of the end of the step though others were asked for
    [[nodiscard]] bool gave_way() const { return gave_way_; }

    // something that was apart closes with the motion that was found
    [[nodiscard]] bool meets(const Plain3& v) const {
        if (!awaits_hits_ || !any_open_)
            return false;
        for (int i = 0; i < count_; ++i) {
            const Contact& c = contact_[static_cast<std::size_t>(i)];
            for (int k = 0; k < c.points; ++k) {
                const Point& p = c.point[static_cast<std::size_t>(k)];
                if (p.gap > 0.0 && p.gap + dt_ * c.rate(p, v) <= 0.0)
                    return true;
            }
        }
        return false;
    }

    // What the contacts did in the step.
    struct Sum {
        Plain3 force; // with the torque about the center of mass
        double work;  // of walls that move
        double energy;
    };

    // gaps, friction springs and states at the end of the step, into the patches
    Sum tell(const Plain3& v, Data& data, StepOutput& output) const {
        double energy = 0.0;
        double x = 0.0;
        double y = 0.0;
        double turn = 0.0;
        double power = 0.0;
        Outcomes outcomes(data, output);
        for (int i = 0; i < count_; ++i) {
            const Contact& c = contact_[static_cast<std::size_t>(i)];
            Patch& p = data.patches.patch[static_cast<std::size_t>(i)];
            Outcome now;
            bool touches = false;
            for (int k = 0; k < c.points; ++k) {
                const Point& q = c.point[static_cast<std::size_t>(k)];
                const double gap = q.gap + dt_ * c.rate(q, v);
                p.point[static_cast<std::size_t>(k)].gap = gap;
                touches = touches || gap <= 0.0;
                output.max_penetration = std::max(output.max_penetration, -gap);
                energy += gap < 0.0 ? 0.5 * q.stiffness * gap * gap : 0.0;
                x += q.force * c.nx;
                y += q.force * c.ny;
                turn += q.force * q.turn;
                power += q.force * q.drive;
            }
            x -= c.force * c.ny;
            y += c.force * c.nx;
            turn += c.force * c.slip_turn;
            power += c.force * c.drive;
            now.normal_force = c.pressing();
            now.tangent_force = c.force;
            now.slip_spring = spring_after(c, v);
            energy += 0.5 * c.stiffness * now.slip_spring * now.slip_spring;
            if (touches)
                now.state = c.mode == FrictionMode::stick ? ContactState::sticking : ContactState::sliding;
            outcomes.tell(p, now);
        }
        outcomes.end();
        return {{x, y, turn}, dt_ * power, energy};
    }

    [[nodiscard]] Plain3 weight() const {
        const double mass = model_.tool.mass;
        return {mass * data_.gravity.x(), mass * data_.gravity.y(), 0.0};
    }

  private:
    static double drive(const Body& other, const Vec2& point, const Vec2& n) {
        return n.dot(velocity_at(other.velocity, point - other.pose.head<2>()));
    }

    // a hit that the velocity at the start foresees
    [[nodiscard]] bool closes(const Point& p, bool continuing) const {
        const double closing = -p.rate;
        return closing > model_.settings.collision_speed && (p.gap > 0.0 || !continuing) &&
               std::max(p.gap, 0.0) / closing <= dt_;
    }
    // what is apart has no damper
    static double damping_of(const Point& p) { return p.gap > 0.0 ? 0.0 : p.damping; }

    // the friction anchor moves only while sliding
    [[nodiscard]] double spring_after(const Contact& c, const Plain3& v) const {
        if (c.mode == FrictionMode::stick)
            return c.spring + dt_ * c.slip_rate(v);
        return c.mode == FrictionMode::off || c.stiffness <= 0.0 ? 0.0 : -c.force / c.stiffness;
    }

    // A step with the forces of its start is (explicit_step.hpp).
    [[nodiscard]] bool is_stable() const {
        const double along = 1.0 / model_.tool.mass;
        const double about = 1.0 / model_.tool.inertia;
        // of D^-1 S, with its three different entries off the diagonal squared
        double xx = 0.0;
        double yy = 0.0;
        double turns = 0.0;
        double xy = 0.0;
        double x_turn = 0.0;
        double y_turn = 0.0;
        const auto add = [&](double weight, double x, double y, double turn) {
            const double w = weight * along;
            xx += w * (x * x);
            yy += w * (y * y);
            turns += weight * about * (turn * turn);
            xy += w * (x * y);
            x_turn += weight * (x * turn);
            y_turn += weight * (y * turn);
        };
        for (int i = 0; i < count_; ++i) {
            const Contact& c = contact_[static_cast<std::size_t>(i)];
            for (int k = 0; k < c.points; ++k) {
                const Point& p = c.point[static_cast<std::size_t>(k)];
                if (p.gap < 0.0)
                    add(explicit_weight(p.stiffness, p.damping, dt_), c.nx, c.ny, p.turn);
            }
            if (c.rough)
                add(explicit_weight(c.stiffness, c.damping, dt_), -c.ny, c.nx, c.slip_turn);
        }
        if (xx + yy + turns <= k_explicit_limit)
            return true;
        const double off = xy * xy + along * about * (x_turn * x_turn + y_turn * y_turn);
        return xx * xx + yy * yy + turns * turns + 2.0 * off <= k_explicit_limit * k_explicit_limit;
    }

    // semi-implicit: forces of the start of the step
    void start_forces(Plain3& right) {
        const Plain3 v = plain(data_.velocity);
        // the points of all contacts first, as the general path has it
        for (int i = 0; i < count_; ++i) {
            Contact& c = contact_[static_cast<std::size_t>(i)];
            for (int k = 0; k < c.points; ++k) {
                Point& p = c.point[static_cast<std::size_t>(k)];
                p.force = p.gap < 0.0 ? std::max(0.0, -p.stiffness * p.gap - p.damping * p.rate) : 0.0;
                const double push = dt_ * p.force;
                right.x += push * c.nx;
                right.y += push * c.ny;
                right.z += push * p.turn;
            }
        }
        for (int i = 0; i < count_; ++i) {
            Contact& c = contact_[static_cast<std::size_t>(i)];
            c.mode = FrictionMode::off;
            if (!c.rough)
                continue;
            c.rub(-c.stiffness * c.spring - c.damping * c.slip_rate(v));
            const double push = dt_ * c.force;
            right.x -= push * c.ny;
            right.y += push * c.nx;
            right.z += push * c.slip_turn;
        }
    }

    // a second solution of the step starts from the first guess again, as the general path does
    void start_sets() {
        slides_ = false;
        if (!solved_) {
            solved_ = true;
            return;
        }
        for (int i = 0; i < count_; ++i) {
            Contact& c = contact_[static_cast<std::size_t>(i)];
            for (int k = 0; k < c.points; ++k)
                c.point[static_cast<std::size_t>(k)].active = c.point[static_cast<std::size_t>(k)].gap < 0.0;
            c.mode = c.rough ? FrictionMode::stick : FrictionMode::off;
        }
    }

    void solve_sets(const Arrow& base, const Plain3& right, Plain3& v) {
        Mat3 work = Vec3(base.a, base.b, base.c).asDiagonal();
        work(2, 0) = work(0, 2) = base.p;
        work(2, 1) = work(1, 2) = base.q;
        Vec3 x = right.vector();
        const bool symmetric = !slides_;
        // work += (stiff along) row', v += push along
        const auto add = [&](double stiff, double push, const Plain3& along, const Plain3& row) {
            const double of_x = stiff * along.x;
            const double of_y = stiff * along.y;
            const double of_turn = stiff * along.z;
            work(0, 0) += of_x * row.x;
            work(1, 0) += of_y * row.x;
            work(2, 0) += of_turn * row.x;
            work(1, 1) += of_y * row.y;
            work(2, 1) += of_turn * row.y;
            work(2, 2) += of_turn * row.z;
            if (!symmetric) {
                work(0, 1) += of_x * row.y;
                work(0, 2) += of_x * row.z;
                work(1, 2) += of_y * row.z;
            }
            x.x() += push * along.x;
            x.y() += push * along.y;
            x.z() += push * along.z;
        };
        for (int i = 0; i < count_; ++i) {
            const Contact& c = contact_[static_cast<std::size_t>(i)];
            const bool slides = slips(c.mode) && c.dynamic_friction > 0.0;
            const double pull = slides ? slip_sign(c.mode) * c.dynamic_friction : 0.0;
            for (int k = 0; k < c.points; ++k) {
                const Point& p = c.point[static_cast<std::size_t>(k)];
                if (!p.active)
                    continue;
                const double stiff = dt_ * (dt_ * p.stiffness + damping_of(p));
                const double push = stiff * p.drive - dt_ * p.stiffness * p.gap;
                const Plain3 row{c.nx, c.ny, p.turn};
                add(stiff, push, {c.nx - pull * c.ny, c.ny + pull * c.nx, p.turn + pull * c.slip_turn}, row);
            }
        }
        for (int i = 0; i < count_; ++i) {
            const Contact& c = contact_[static_cast<std::size_t>(i)];
            if (c.mode != FrictionMode::stick)
                continue;
            const double stiff = dt_ * (dt_ * c.stiffness + c.damping);
            const Plain3 row{-c.ny, c.nx, c.slip_turn};
            add(stiff, stiff * c.drive - dt_ * c.stiffness * c.spring, row, row);
        }
        if (symmetric)
            solve_definite(work, x);
        else
            solve_pivoted(work, x);
        v = plain(x);
    }

    // true when what was assumed holds with the velocity that follows
    bool update_sets(const Plain3& v) {
        bool same = true;
        slides_ = false;
        for (int i = 0; i < count_; ++i) {
            Contact& c = contact_[static_cast<std::size_t>(i)];
            for (int k = 0; k < c.points; ++k) {
                Point& p = c.point[static_cast<std::size_t>(k)];
                if (awaits_hits_ && p.gap > 0.0)
                    continue; // what is apart and may be hit has no spring in this step
                p.force =
                    std::max(0.0, -p.stiffness * p.gap - (dt_ * p.stiffness + damping_of(p)) * c.rate(p, v));
                same = same && p.active == (p.force > 0.0);
                p.active = p.force > 0.0;
            }
            if (!c.rough)
                continue;
            const FrictionMode before = c.mode;
            c.rub(-c.stiffness * c.spring - (dt_ * c.stiffness + c.damping) * c.slip_rate(v));
            same = same && c.mode == before;
            slides_ = slides_ || (slips(c.mode) && c.dynamic_friction > 0.0);
        }
        return same;
    }

    const Model& model_;
    const Data& data_;
    double dt_;
    bool awaits_hits_;
    int count_{0};
    // a point does not press at the start of the step; a contact slides, so that the equation has no symmetry
    bool any_open_{false};
    bool slides_{false};
    bool solved_{false};
    bool gave_way_{false};
    std::array<Contact, k_max_patches> contact_;
};

} // namespace

bool step_in_contact(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output) {
    const ToolModel& tool = model.tool;
    RigidContacts contacts(model, data, dt);
    if (!contacts.read())
        return false;
    const RigidGrip grip = rigid_grip(data);
    Plain3 v{0.0, 0.0, 0.0};
    const Plain3 none{0.0, 0.0, 0.0};
    RigidCoupling::Forces forces;
    if (hand.held) {
        const Plain3 at{data.pose.x() + grip.x, data.pose.y() + grip.y, data.pose.z()};
        const RigidCoupling coupling(grip, at, hand.target, hand, dt);
        const auto end = [&](const UsedCoupling& used, Plain3& end_velocity) {
            return contacts.solve(&coupling, used, end_velocity);
        };
        if (!coupling.solve(end, v, forces))
            return false;
    } else if (!contacts.solve(nullptr, {0.0, none}, v)) {
        return false;
    }
    if (contacts.meets(v))
        return false;

    forces.tell(output);
    output.fell_back = output.fell_back || contacts.gave_way();
    ContactSystem& s = data.system;
    s.points = 0;
    s.patches = 0;
    for (int i = 0; i < data.movable_count; ++i)
        data.movable[static_cast<std::size_t>(i)].row = -1;
    const Plain3 weight = contacts.weight();
    const double spin = data.velocity.z();
    output.grip_mobility = grip.mobility(tool.mass, tool.inertia);
    output.grip_bias = {-spin * spin * grip.x, -spin * spin * grip.y, 0.0};

    data.velocity = v.vector();
    data.pose += dt * data.velocity;
    place_tool(model, data);
    move_neighbors(data, dt);
    const auto [sum, wall_work, energy] = contacts.tell(v, data, output);
    output.stored_energy = energy + rigid_energy(tool, v);
    output.source_work = wall_work + dt * weight.dot(v);
    output.contact = {sum.x, sum.y, sum.z - (grip.x * sum.y - grip.y * sum.x)};
    output.environment =
        output.contact + Wrench(weight.x, weight.y, -(grip.x * weight.y - grip.y * weight.x));
    const Plain3 total = sum + weight;
    output.grip_acceleration =
        grip.velocity({total.x / tool.mass, total.y / tool.mass, total.z / tool.inertia}).vector();
    return true;
}

} // namespace haptics::local
